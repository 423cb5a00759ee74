//! What a header says beyond the volume is kept.

use pellucid::io::nrrd::{self, ByteSkip, Center, Elements, Kind};
use pellucid::volume::{Quantity, Samples};

use super::{Folder, SMALL, values};

#[test]
fn all_fields_are_kept() {
    let folder = Folder::new();
    let header = "NRRD0005\r\n\
        # a comment\r\n\
        Content: a head\r\n\
        number: 24\r\n\
        type: uint8\r\n\
        dimension: 4\r\n\
        sizes: 4 1 2 3\r\n\
        space: RAS\r\n\
        space directions: none (1,0,0) (0,2,0) (0,0,3)\r\n\
        space origin: (7, 8, 9)\r\n\
        space units: \"mm\" \"mm\" \"mm\"\r\n\
        measurement frame: (1,0,0) (0,1,0) (0,0,1)\r\n\
        kinds: RGBA-color domain domain domain\r\n\
        thicknesses: nan nan nan 2.5\r\n\
        centerings: ??? cell cell node\r\n\
        labels: \"\" \"x\" \"y\" \"z \\\"up\\\"\"\r\n\
        sample units: HU\r\n\
        min: 0\r\n\
        old max: 3071\r\n\
        encoding: raw\r\n\
        byte skip: 0\r\n\
        Segment0_ID:=1\r\n\
        Segment0_Name:=left: kidney\\nand \\\\ more\r\n\
        \r";
    let array = nrrd::read_array(&folder.nrrd("a.nrrd", header, &[7; 24])).unwrap();
    let header = &array.header;
    assert_eq!((header.version, header.comments.as_slice()), (5, ["a comment".to_owned()].as_slice()));
    assert_eq!(header.content.as_deref(), Some("a head"));
    assert_eq!(header.shape(), "4 (RGBA-color) x 1 x 2 x 3");
    assert_eq!((header.color_axis(), header.axes[0].kind), (Some(0), Some(Kind::Rgba)));
    assert_eq!(header.axes[3].direction, Some(vec![0.0, 0.0, 3.0]));
    assert_eq!((header.axes[3].thickness, header.axes[3].center), (Some(2.5), Some(Center::Node)));
    assert_eq!(header.axes[3].label.as_deref(), Some("z \"up\""));
    assert_eq!(header.space_origin, Some(vec![7.0, 8.0, 9.0]));
    assert_eq!(header.measurement_frame.as_ref().map(Vec::len), Some(3));
    assert_eq!((header.value_range, header.old_range), ([Some(0.0), None], [None, Some(3071.0)]));
    assert_eq!((header.sample_units.as_deref(), header.byte_skip), (Some("HU"), ByteSkip::Bytes(0)));
    assert_eq!(header.value_of("Segment0_Name"), Some("left: kidney\nand \\ more"));
    assert_eq!(header.value_of("Segment1_Name"), None);
    assert_eq!(array.elements, Elements::U8(vec![7; 24]));
    assert_eq!(array.warnings, Vec::<String>::new());
}

#[test]
fn fields_in_any_order_and_twice_alike() {
    let folder = Folder::new();
    let header =
        "NRRD0001\nencoding: raw\nspacings: 1 1 1\nsizes: 3 2 2\nTYPE: uchar\nvendor: x\ntype: uchar\nDimension: 3\n";
    let scan = nrrd::read(&folder.nrrd("a.nrrd", header, &[1; 12])).unwrap();
    assert_eq!(
        scan.warnings[..2],
        [
            "line 6: the field `vendor` is not known and was not used",
            "lines 5 and 7: the field `type` is given twice, alike"
        ]
        .map(str::to_owned)[..],
        "all: {:?}",
        scan.warnings
    );
}

#[test]
fn quantity_and_storage_follow_the_type() {
    let folder = Folder::new();
    for (name, bytes, quantity) in [
        ("int8", 1, Quantity::Arbitrary),
        ("uint8", 1, Quantity::Arbitrary),
        ("int16", 2, Quantity::Hu),
        ("uint16", 2, Quantity::Arbitrary),
        ("int32", 4, Quantity::Hu),
        ("uint32", 4, Quantity::Arbitrary),
        ("int64", 8, Quantity::Hu),
        ("uint64", 8, Quantity::Arbitrary),
        ("float", 4, Quantity::Hu),
        ("double", 8, Quantity::Hu),
    ] {
        let header = format!("{SMALL}type: {name}\nendian: little\nencoding: raw\n");
        let scan = nrrd::read(&folder.nrrd("a.nrrd", &header, &vec![0; 12 * bytes])).unwrap();
        assert_eq!(scan.volume.quantity(), quantity, "{name}");
        assert!(matches!(scan.volume.samples(), Samples::I16(_)), "{name}: zeros fit 16 bits");
        assert_eq!(values(&scan), [0.0; 12], "{name}");
        assert_eq!(scan.warnings, Vec::<String>::new(), "{name}");
    }
}

#[test]
fn voxels_that_are_no_numbers_are_replaced_and_counted() {
    let folder = Folder::new();
    let header = format!("{SMALL}type: float\nencoding: ascii\n");
    let scan = nrrd::read(&folder.nrrd("a.nrrd", &header, b"nan -999.5 2 3 4 inf 6 -inf 8 9 10 11")).unwrap();
    assert_eq!(values(&scan), [-999.5, -999.5, 2.0, 3.0, 4.0, -999.5, 6.0, -999.5, 8.0, 9.0, 10.0, 11.0]);
    assert_eq!(
        scan.warnings,
        ["3 of 12 voxels are NaN or infinite: the smallest value, -999.5, was put in their place".to_owned()]
    );
}

#[test]
fn facts_say_what_was_read() {
    let folder = Folder::new();
    folder.file("a.raw", &[0; 12]);
    let header = format!("{SMALL}type: uchar\nencoding: raw\ndata file: a.raw\ncontent: somebody's name\n");
    let scan = nrrd::read(&folder.nrrd("a.nhdr", &header, b"")).unwrap();
    let facts: Vec<_> = scan.facts.iter().map(|(label, text)| format!("{label}: {text}")).collect();
    assert_eq!(
        facts,
        [
            "format: NRRD 4, data in one other file",
            "encoding: raw",
            "type: uint8",
            "dimensions: 3 x 2 x 2",
            "spacing: 1 x 1 x 1 mm",
            "space: left-posterior-superior"
        ]
    );
}
