//! What is wrong with a file is said: where, what was found, what was expected.

use pellucid::Fault;
use pellucid::io::nrrd;

use super::{Folder, SMALL};

/// The small volume without the fields of these names, with other lines.
fn small(without: &[&str], lines: &str) -> String {
    let kept = |line: &&str| !without.iter().any(|name| line.starts_with(&format!("{name}:")));
    let all = format!("{SMALL}type: uint8\nencoding: raw\n");
    all.lines().filter(kept).map(|line| format!("{line}\n")).collect::<String>() + lines
}

#[test]
fn a_header_that_cannot_be_read() {
    let folder = Folder::new();
    for (header, expected) in [
        (
            "P5 3 2\n".to_owned(),
            "a.nrrd: this is not a NRRD file: found \"P5 3 2\" in the first line, expected NRRD0001 to NRRD0005",
        ),
        (
            "NRRD0006\n".to_owned(),
            "a.nrrd: this version of NRRD is not known: found \"NRRD0006\" in the first line, expected NRRD0001 to \
             NRRD0005",
        ),
        (small(&["type"], ""), "a.nrrd: a required field is missing (type)"),
        (small(&["sizes"], ""), "a.nrrd: a required field is missing (sizes)"),
        (small(&["dimension"], ""), "a.nrrd: a required field is missing (dimension)"),
        (small(&["encoding"], ""), "a.nrrd: a required field is missing (encoding)"),
        (small(&["type"], "type: short\n"), "a.nrrd: a required field is missing (endian)"),
        (
            small(&[], "spacing: 1 1 1\n"),
            "a.nrrd:9:1: a field is not known: found `spacing`\n  remedy: write `spacings`, or `spacing:=…` for a key of \
             your own",
        ),
        (
            small(&[], "hello\n"),
            "a.nrrd:9:1: a line of the header is neither a field nor a key/value pair: found \"hello\", expected \
             `field: description`, `key:=value`, or a blank line before the data",
        ),
        (
            small(&[], "space: RAS\n"),
            "a.nrrd:9:8: a field is given twice (space): found `RAS` after `left-posterior-superior` in line 4\n  \
             remedy: remove the wrong one",
        ),
        (
            small(&["type"], "type: char\n"),
            "a.nrrd:8:7: a field cannot be read (type): found `char`, expected `signed char` or `unsigned char`\n  \
             remedy: say which: the sign of a plain `char` differs between machines",
        ),
        (
            small(&["type"], "type: quad\n"),
            "a.nrrd:8:7: a field cannot be read (type): found `quad`, expected a type such as `short`, `uint8` or `float`",
        ),
        (
            small(&["type"], "type: block\nblock size: 12\n"),
            "a.nrrd:8:7: elements that are blocks of bytes cannot be rendered (type)",
        ),
        (
            small(&["encoding"], "encoding: zrl\n"),
            "a.nrrd:8:11: the encoding is not known (encoding): found `zrl`, expected raw, gzip, bzip2, ascii or hex",
        ),
        (
            small(&["dimension"], "dimension: 17\n"),
            "a.nrrd:8:12: a field cannot be read (dimension): found `17`, expected a number from 1 to 16",
        ),
        (
            small(&["sizes"], "sizes: 3 2\n"),
            "a.nrrd:8:8: a field cannot be read (sizes): found 2 in `3 2`, expected 3, one for each axis",
        ),
        (
            small(&["sizes"], "sizes: 3 0 2\n"),
            "a.nrrd:8:8: a field cannot be read (sizes): found `3 0 2`, expected 3 whole numbers above 0",
        ),
        (
            small(&["sizes"], "sizes: 4294967296 4294967296 1\n"),
            "a.nrrd: the array is larger than any memory (sizes): found 4294967296 x 4294967296 x 1 of uint8",
        ),
        (
            small(&["space"], "space: LPI\n"),
            "a.nrrd:8:8: a field cannot be read (space): found `LPI`, expected left-posterior-superior or another space \
             of the format's definition",
        ),
        (
            small(&["space"], ""),
            "a.nrrd:4:19: a vector is given in a space that is not (space directions): expected `space` or \
             `space dimension` in the same header",
        ),
        (
            small(&[], "space dimension: 4\n"),
            "a.nrrd:9:18: a field cannot be read (space dimension): found `4`, expected 3 for left-posterior-superior",
        ),
        (
            small(&["space origin"], "space origin: (0,0)\n"),
            "a.nrrd:8:15: a field cannot be read (space origin): found `(0,0)`, expected vectors of 3 finite numbers, \
             such as `(1,0,0)`, or `none`",
        ),
        (
            small(&[], "kinds: domain domain RGB-color\n"),
            "a.nrrd:9:8: a field cannot be read (kinds): found `RGB-color` for an axis of 2, expected an axis of 3",
        ),
        (
            small(&[], "kinds: domain domain slice\n"),
            "a.nrrd:9:8: a field cannot be read (kinds): found `slice`, expected kinds such as `domain`, `list` or \
             `RGBA-color`",
        ),
        (
            small(&["encoding"], "encoding: gzip\nbyte skip: -1\n"),
            "a.nrrd:9:12: a field cannot be read (byte skip): found -1 with encoding gzip, expected a number of bytes: \
             only in raw files do the elements have a known size",
        ),
        (
            small(&[], "data file: a%d 1 5 -1\n"),
            "a.nrrd:9:12: a field cannot be read (data file): found `a%d 1 5 -1`, expected a step that leads from first \
             to last",
        ),
        (
            small(&[], "data file: a%d 1 2 0\n"),
            "a.nrrd:9:12: a field cannot be read (data file): found `a%d 1 2 0`, expected a step other than 0",
        ),
        (
            small(&[], "data file: a%d 1 5 1\n"),
            "a.nrrd: the number of data files does not fit the sizes (data file): found 5 files of 2 axes, expected 2 \
             for sizes [3, 2, 2]",
        ),
        (
            small(&[], "data file: LIST 3\na\nb\nc\n"),
            "a.nrrd: the number of data files does not fit the sizes (data file): found 3 files, expected a number that \
             divides 2 samples",
        ),
    ] {
        let path = folder.nrrd("a.nrrd", &header, &[0; 12]);
        assert_eq!(folder.error(&path), expected, "from\n{header}");
    }
}

#[test]
fn data_that_does_not_fit_its_header() {
    let folder = Folder::new();
    let cut = "\n  remedy: copy or export the file again; it is likely to be cut off";
    let where_from =
        "\n  remedy: correct `sizes` and `type`, or say with `line skip` and `byte skip` where the elements begin";
    for (fields, data, expected) in [
        (
            "type: uint8\nencoding: raw\n",
            [0; 11].to_vec(),
            format!(
                "a.nrrd: the data ends too early: found 11 bytes of elements, expected 12 for 3 x 2 x 2 of uint8{cut}"
            ),
        ),
        (
            "type: short\nendian: little\nencoding: raw\n",
            [0; 25].to_vec(),
            format!(
                "a.nrrd: there is more data than elements: found 25 bytes, expected 24 bytes for 3 x 2 x 2 of int16\
                 {where_from}"
            ),
        ),
        (
            "type: uint8\nencoding: raw\nbyte skip: 3\n",
            [0; 12].to_vec(),
            format!(
                "a.nrrd: the data ends too early: found 9 bytes of elements, expected 12 for 3 x 2 x 2 of uint8{cut}"
            ),
        ),
        (
            "type: uint8\nencoding: raw\nline skip: 3\n",
            b"a\nb\n".to_vec(),
            "a.nrrd: the data file ends within the lines to skip (line skip): found 2 lines, expected 3".to_owned(),
        ),
        (
            "type: uint8\nencoding: hex\n",
            b"000102030405060708090a".to_vec(),
            format!(
                "a.nrrd: the data ends too early: found 11 bytes of elements, expected 12 for 3 x 2 x 2 of uint8{cut}"
            ),
        ),
        (
            "type: uint8\nencoding: hex\n",
            b"000102030405060708090a0b0c".to_vec(),
            format!(
                "a.nrrd: there is more data than elements: found more than 12 bytes, expected 12 bytes for 3 x 2 x 2 of \
                 uint8{where_from}"
            ),
        ),
        (
            "type: uint8\nencoding: hex\n",
            b"00zz".to_vec(),
            "a.nrrd: the hex data is damaged or cut off: found at least 0 bytes of elements, expected 12 bytes for \
             3 x 2 x 2\n  cause: 'z' is no hexadecimal digit\n  remedy: copy or export the file again"
                .to_owned(),
        ),
        (
            "type: uint8\nencoding: ascii\n",
            b"1 2 3".to_vec(),
            "a.nrrd: the data ends too early: found 3 numbers, expected 12 for 3 x 2 x 2".to_owned(),
        ),
        (
            "type: uint8\nencoding: ascii\n",
            b"1 2 3 4 5 6 7 8 9 10 11 12 13".to_vec(),
            "a.nrrd: there are more numbers than elements: found `13` after the last, expected 12 numbers for 3 x 2 x 2 \
             of uint8"
                .to_owned(),
        ),
        (
            "type: uint8\nencoding: ascii\n",
            b"1 2 256".to_vec(),
            "a.nrrd: a number cannot be read (number 3): found `256`, expected uint8".to_owned(),
        ),
        (
            "type: uint8\nencoding: ascii\n",
            b"1 2 \xff".to_vec(),
            "a.nrrd: the ascii data is damaged or cut off: expected 12 bytes for 3 x 2 x 2\n  \
             cause: this is no text of numbers\n  remedy: copy or export the file again"
                .to_owned(),
        ),
    ] {
        let path = folder.nrrd("a.nrrd", &format!("{SMALL}{fields}"), &data);
        assert_eq!(folder.error(&path), expected, "from\n{fields}");
    }
}

#[test]
fn compressed_data_that_is_cut_off_or_damaged() {
    let folder = Folder::new();
    let whole = folder.path("whole.nrrd");
    let header = "NRRD0004\ndimension: 3\nsizes: 64 64 64\nspacings: 1 1 1\ntype: uint8\nencoding: ";
    for encoding in ["gzip", "bzip2"] {
        let noise: Vec<u8> =
            (0..64_u64 * 64 * 64).map(|i| (i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 56) as u8).collect();
        let raw = folder.nrrd("raw.nrrd", &format!("{header}raw\n"), &noise);
        let volume = nrrd::read(&raw).unwrap().volume;
        nrrd::write(&whole, &volume, nrrd::Encoding::from_name(encoding).unwrap(), &[]).unwrap();
        let bytes = std::fs::read(&whole).unwrap();

        let cut = folder.file("cut.nrrd", &bytes[..bytes.len() - 1000]);
        let error = nrrd::read(&cut).unwrap_err();
        assert_eq!(error.fault(), Fault::Input, "{encoding}: {error}");
        assert!(error.to_string().contains("expected 262144"), "{encoding}, cut: {error}");

        let mut damaged = bytes.clone();
        let middle = bytes.len() / 2;
        damaged[middle..middle + 8].fill(0x55);
        let error = nrrd::read(&folder.file("damaged.nrrd", &damaged)).unwrap_err();
        assert!(error.what().contains("damaged"), "{encoding}, damaged: {error}");

        let more = folder.file("more.nrrd", &[&bytes[..], b"more"].concat());
        let error = nrrd::read(&more).unwrap_err();
        assert_eq!(error.fault(), Fault::Input, "{encoding}, with more: {error}");
    }
}

#[test]
fn a_small_file_cannot_claim_much_memory() {
    let folder = Folder::new();
    let sizes = "NRRD0004\ndimension: 3\nsizes: 1000000 1000000 1000\nspacings: 1 1 1\ntype: float\nendian: little\n";
    for (encoding, data) in [("raw", &[0_u8; 64][..]), ("gzip", &[0x1f, 0x8b]), ("hex", b"00"), ("ascii", b"1 2 3")] {
        let path = folder.nrrd("a.nrrd", &format!("{sizes}encoding: {encoding}\n"), data);
        let error = nrrd::read(&path).unwrap_err();
        assert_eq!(error.what(), "the data ends too early", "{encoding}: {error}");
    }
    let path = folder.nrrd("a.nrrd", &format!("{sizes}encoding: bzip2\n"), b"BZh9");
    assert_eq!(nrrd::read(&path).unwrap_err().fault(), Fault::Input, "bzip2 has no bound that is known beforehand");
}

#[test]
fn a_missing_file_is_named() {
    let folder = Folder::new();
    let error = folder.error(&folder.path("none.nrrd"));
    assert!(error.starts_with("none.nrrd: the file cannot be read\n  cause: No such file"), "{error}");
    folder.file("a.1", &[0; 6]);
    let header = format!("{SMALL}type: uint8\nencoding: raw\ndata file: a.%d 1 2 1\n");
    let error = folder.error(&folder.nrrd("a.nhdr", &header, b""));
    assert!(error.starts_with("a.2: the data file cannot be read\n  cause: No such file"), "{error}");
}
