//! What is written is read again.

use glam::{DAffine3, DMat3, DVec3};
use pellucid::Fault;
use pellucid::io::nrrd::{self, Encoding};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};
use proptest::prelude::*;

use super::Folder;

const ENCODINGS: [Encoding; 5] = [Encoding::Raw, Encoding::Gzip, Encoding::Bzip2, Encoding::Text, Encoding::Hex];

fn sheared_grid() -> Grid {
    let steps =
        DMat3::from_cols(DVec3::new(0.1, 0.3, 0.0), DVec3::new(-0.2, 0.5, 1.0 / 3.0), DVec3::new(0.0, 0.7, -5.0));
    Grid::new([4, 3, 2], DAffine3::from_mat3_translation(steps, DVec3::new(177.956_329_345_703_12, -1e-7, 1e6)))
        .unwrap()
}

fn volume(samples: Samples, rescale: Rescale, quantity: Quantity) -> Volume {
    Volume::new(sheared_grid(), samples, rescale, quantity).unwrap()
}

#[test]
fn values_grid_and_quantity_come_back() {
    let folder = Folder::new();
    let i16s = |from: i16, step: i16| Samples::I16((0..24).map(|i| from + i * step).collect());
    let halves = Samples::F32((0..24_u8).map(|i| f32::from(i) / 3.0 - 1000.0).collect());
    let shift = |intercept| Rescale { slope: 1.0, intercept };
    for (name, original, element_type) in [
        ("HU", volume(i16s(-1024, 100), Rescale::IDENTITY, Quantity::Hu), "int16"),
        ("HU + 1024", volume(i16s(0, 100), shift(-1024.0), Quantity::Hu), "int16"),
        ("bytes", volume(i16s(0, 11), Rescale::IDENTITY, Quantity::Arbitrary), "uint8"),
        ("uint16", volume(i16s(-32_768, 2_800), shift(32_768.0), Quantity::Arbitrary), "uint16"),
        ("wide HU", volume(i16s(0, 1_000), shift(30_000.0), Quantity::Hu), "int32"),
        ("half steps", volume(i16s(-5, 1), Rescale { slope: 0.5, intercept: 0.0 }, Quantity::Hu), "float"),
        ("floats", volume(halves, Rescale::IDENTITY, Quantity::Hu), "float"),
    ] {
        for encoding in ENCODINGS {
            let path = folder.path("a.nrrd");
            nrrd::write(&path, &original, encoding, &[]).unwrap();
            let scan = nrrd::read(&path).unwrap_or_else(|e| panic!("{name}, {encoding:?}: {e}"));
            let read = &scan.volume;
            assert_eq!(read.grid(), original.grid(), "{name}, {encoding:?}");
            assert_eq!(read.values_sha256(), original.values_sha256(), "{name}, {encoding:?}");
            assert_eq!(read.quantity(), original.quantity(), "{name}, {encoding:?}");
            assert_eq!(scan.warnings, Vec::<String>::new(), "{name}, {encoding:?}");
            assert_eq!(nrrd::read_header(&path).unwrap().0.element_type.name(), element_type, "{name}, {encoding:?}");
        }
    }
}

#[test]
fn values_that_need_double_precision_are_written_so() {
    let folder = Folder::new();
    let path = folder.path("a.nrrd");
    let original = volume(Samples::I16((0..24).collect()), Rescale { slope: 0.1, intercept: 1e6 }, Quantity::Hu);
    nrrd::write(&path, &original, Encoding::Raw, &[]).unwrap();
    let nrrd::Elements::F64(values) = nrrd::read_array(&path).unwrap().elements else {
        panic!("not written as double")
    };
    assert_eq!(values[23], original.value([3, 2, 1]));
}

#[test]
fn keys_and_values_come_back() {
    let folder = Folder::new();
    let path = folder.path("a.nrrd");
    let original = volume(Samples::I16(vec![0; 24]), Rescale::IDENTITY, Quantity::Hu);
    let pairs: Vec<(String, String)> = [
        ("Segment0_Name", "left kidney"),
        ("two lines", "one\ntwo"),
        ("back\\slash", "\\n is no line \\\\"),
        ("dicom: x", " a := b: c "),
        ("empty", ""),
        ("Größe", "5 µm"),
    ]
    .map(|(k, v)| (k.to_owned(), v.to_owned()))
    .to_vec();
    nrrd::write(&path, &original, Encoding::Gzip, &pairs).unwrap();
    assert_eq!(nrrd::read_header(&path).unwrap().0.key_values, pairs);
}

#[test]
fn keys_that_would_read_as_something_else_are_refused() {
    let folder = Folder::new();
    let path = folder.path("a.nrrd");
    let original = volume(Samples::I16(vec![0; 24]), Rescale::IDENTITY, Quantity::Hu);
    for (key, value, reason) in [
        ("", "x", "a key without a name"),
        ("#1", "x", "a key that reads as a comment"),
        ("a:=b", "x", "a key with the mark that ends it"),
        ("a:", "x", "a key with the mark that ends it"),
        ("space: b", "x", "a key that reads as a field"),
        ("a", "x\r", "a control character"),
    ] {
        let pair = (key.to_owned(), value.to_owned());
        let error = nrrd::write(&path, &original, Encoding::Raw, &[pair]).unwrap_err();
        assert_eq!(error.fault(), Fault::Output);
        assert!(error.to_string().ends_with(&format!("found {reason}")), "{key:?}: {error}");
        assert!(!path.exists(), "{key:?}: nothing is written");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_volume_comes_back(
        stored in prop::collection::vec(any::<i16>(), 24),
        intercept in -100_000_i32..100_000,
        steps in prop::array::uniform9(-2.0_f64..2.0),
        origin in prop::array::uniform3(-1e4_f64..1e4),
        encoding in prop::sample::select(ENCODINGS.to_vec()),
        pairs in prop::collection::vec(("[^#:\\p{Cc}][^:\\p{Cc}]*", "\\PC*"), 0..4),
    ) {
        let affine = DAffine3::from_mat3_translation(DMat3::from_cols_array(&steps), DVec3::from_array(origin));
        let grid = Grid::new([2, 3, 4], affine);
        prop_assume!(grid.is_ok());
        let rescale = Rescale { slope: 1.0, intercept: f64::from(intercept) };
        let original = Volume::new(grid.unwrap(), Samples::I16(stored), rescale, Quantity::Hu).unwrap();
        let folder = Folder::new();
        let path = folder.path("a.nrrd");
        nrrd::write(&path, &original, encoding, &pairs).unwrap();
        let scan = nrrd::read(&path).unwrap();
        prop_assert_eq!(scan.volume.grid(), original.grid());
        prop_assert_eq!(scan.volume.values_sha256(), original.values_sha256());
        prop_assert_eq!(nrrd::read_header(&path).unwrap().0.key_values, pairs);
    }
}
