//! No file makes the reader panic, loop or take memory it has not earned.

use pellucid::io::nrrd;
use proptest::prelude::*;

use super::Folder;

/// Lines that a header may have, right and wrong.
fn line() -> impl Strategy<Value = String> {
    let field = prop::sample::select(vec![
        "type: short",
        "type: uint8",
        "type: double",
        "encoding: raw",
        "encoding: gzip",
        "encoding: bzip2",
        "encoding: hex",
        "encoding: ascii",
        "endian: big",
        "dimension: 3",
        "sizes: 2 2 2",
        "sizes: 99999 99999 99999",
        "space: LPS",
        "space: 3D-left-handed-time",
        "space dimension: 3",
        "space directions: (1,0,0) (0,1,0) (0,0,1)",
        "space directions: none (1,0,0",
        "space origin: (0,0,0)",
        "spacings: 1 1 1",
        "kinds: domain domain domain",
        "byte skip: -1",
        "byte skip: 18446744073709551615",
        "line skip: 2",
        "data file: LIST 2",
        "data file: %d -9223372036854775808 9223372036854775807 1",
        "data file: %9d 1 2 1 3",
        "key:=value",
        "# comment",
    ])
    .prop_map(str::to_owned);
    let name = prop::sample::select(vec![
        "type",
        "encoding",
        "dimension",
        "sizes",
        "space",
        "space directions",
        "spacings",
        "kinds",
        "centers",
        "labels",
        "units",
        "min",
        "data file",
        "byte skip",
        "measurement frame",
        "space units",
        "axis mins",
    ]);
    prop_oneof![4 => field, 2 => (name, "\\PC{0,30}").prop_map(|(n, v)| format!("{n}: {v}")), 1 => "\\PC{0,40}"]
}

/// A valid header with one line replaced, so that most of it is reached.
fn nearly_valid() -> impl Strategy<Value = String> {
    let valid = ["dimension: 3", "sizes: 2 2 2", "type: short", "endian: little", "encoding: raw", "spacings: 1 1 1"];
    (0..valid.len(), line(), prop::option::of(line())).prop_map(move |(index, replacement, extra)| {
        let mut lines = valid.map(str::to_owned);
        lines[index] = replacement;
        lines.into_iter().chain(extra).map(|line| line + "\n").collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_header_is_read_or_refused(
        header in prop_oneof![
            nearly_valid(),
            prop::collection::vec(line(), 0..12).prop_map(|lines| lines.join("\n") + "\n"),
        ],
        data in prop::collection::vec(any::<u8>(), 0..64),
    ) {
        let folder = Folder::new();
        let path = folder.nrrd("a.nrrd", &format!("NRRD0004\n{header}"), &data);
        if let Err(error) = nrrd::read(&path) {
            prop_assert!(!error.what().is_empty());
        }
    }

    #[test]
    fn any_bytes_are_read_or_refused(start in 0..3_usize, bytes in prop::collection::vec(any::<u8>(), 0..256)) {
        let folder = Folder::new();
        let magic: &[u8] = [b"".as_slice(), b"NRRD0001\n", b"NRRD0005\nencoding: "][start];
        let path = folder.file("a.nrrd", &[magic, &bytes].concat());
        prop_assert!(nrrd::read(&path).is_err(), "no random bytes are a volume");
    }

    #[test]
    fn a_damaged_file_is_read_or_refused(at in 0..1000_usize, byte in any::<u8>(), encoding in 0..5_usize) {
        let folder = Folder::new();
        let whole = folder.path("whole.nrrd");
        let grid = pellucid::volume::Grid::axis_aligned([8, 8, 8], glam::DVec3::ONE).unwrap();
        let samples = pellucid::volume::Samples::I16((0..512).map(|i| i * 37).collect());
        let volume = pellucid::Volume::new(
            grid,
            samples,
            pellucid::volume::Rescale::IDENTITY,
            pellucid::volume::Quantity::Hu,
        ).unwrap();
        let encodings = [
            nrrd::Encoding::Raw,
            nrrd::Encoding::Gzip,
            nrrd::Encoding::Bzip2,
            nrrd::Encoding::Text,
            nrrd::Encoding::Hex,
        ];
        nrrd::write(&whole, &volume, encodings[encoding], &[]).unwrap();
        let mut bytes = std::fs::read(&whole).unwrap();
        let at = at % bytes.len();
        bytes[at] = byte;
        // Reading it is the test: it may be right, wrong or refused, but does not panic.
        let read = nrrd::read(&folder.file("damaged.nrrd", &bytes));
        prop_assert!(read.as_ref().map_or_else(|e| !e.what().is_empty(), |scan| !scan.volume.samples().is_empty()));
    }
}
