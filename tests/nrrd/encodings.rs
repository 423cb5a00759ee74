//! Every encoding, number type and byte order; one file or many.

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;
use pellucid::io::nrrd::{self, Elements};

use super::{Folder, SMALL, values};

/// Raw bytes in one byte order, and decimal numbers, of one set of elements.
struct Sample {
    elements: Elements,
    names: &'static [&'static str],
    little: Vec<u8>,
    big: Vec<u8>,
    text: String,
}

/// Twelve elements of each type that use all its bytes; the ends of its range are among them.
fn samples() -> Vec<Sample> {
    macro_rules! sample {
        ($variant:ident $number:ty, $from:expr, $names:expr) => {{
            let mut all: Vec<$number> = (1..=10).map($from).collect();
            all.extend([<$number>::MIN, <$number>::MAX]);
            Sample {
                names: $names,
                little: all.iter().flat_map(|v| v.to_le_bytes()).collect(),
                big: all.iter().flat_map(|v| v.to_be_bytes()).collect(),
                text: all.iter().map(|v| v.to_string()).collect::<Vec<_>>().join(" "),
                elements: Elements::$variant(all),
            }
        }};
    }
    vec![
        sample!(I8 i8, |i: i8| i * 12 - 60, &["signed char", "int8", "int8_t"]),
        sample!(U8 u8, |i: u8| i * 25, &["uchar", "unsigned char", "uint8", "uint8_t", "UINT8"]),
        sample!(
            I16 i16,
            |i: i16| i * 3001 - 15_000,
            &["short", "short int", "signed short", "signed short int", "int16", "int16_t"]
        ),
        sample!(
            U16 u16,
            |i: u16| i * 6007,
            &["ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"]
        ),
        sample!(I32 i32, |i: i32| i * -20_123_457, &["int", "signed int", "int32", "int32_t"]),
        sample!(U32 u32, |i: u32| i * 401_234_567, &["uint", "unsigned int", "uint32", "uint32_t"]),
        sample!(
            I64 i64,
            |i: i64| i * -901_234_567_890_123_456,
            &["longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"]
        ),
        sample!(
            U64 u64,
            |i: u64| i * 1_701_234_567_890_123_456,
            &["ulonglong", "unsigned long long", "unsigned  long long int", "uint64", "uint64_t"]
        ),
        sample!(F32 f32, |i: i8| f32::from(i) / 7.0, &["float", "Float"]),
        sample!(F64 f64, |i: i8| f64::from(i) / -7e200, &["double"]),
    ]
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut file = GzEncoder::new(Vec::new(), Compression::default());
    file.write_all(bytes).and_then(|()| file.finish()).expect("gzip in memory")
}

fn bzip2(bytes: &[u8]) -> Vec<u8> {
    let mut file = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::default());
    file.write_all(bytes).and_then(|()| file.finish()).expect("bzip2 in memory")
}

fn hex(bytes: &[u8]) -> Vec<u8> {
    let digits = |(i, b): (usize, &u8)| format!("{b:02X}{}", if i % 7 == 6 { "\r\n" } else { "" });
    bytes.iter().enumerate().map(digits).collect::<String>().into_bytes()
}

#[test]
fn every_type_in_every_encoding_and_byte_order() {
    let folder = Folder::new();
    for sample in samples() {
        let name = sample.names[0];
        for (endian, raw) in [("little", &sample.little), ("big", &sample.big)] {
            for (encoding, data) in [
                ("raw", raw.clone()),
                ("gzip", gzip(raw)),
                ("gz", gzip(raw)),
                ("bzip2", bzip2(raw)),
                ("bz2", bzip2(raw)),
                ("hex", hex(raw)),
                ("ascii", sample.text.clone().into_bytes()),
                ("txt", sample.text.replace(' ', "\n").into_bytes()),
                ("text", sample.text.replace(' ', ", ").into_bytes()),
            ] {
                let header = format!("{SMALL}type: {name}\nendian: {endian}\nencoding: {encoding}\n");
                let path = folder.nrrd("a.nrrd", &header, &data);
                let found = nrrd::read_array(&path).unwrap_or_else(|e| panic!("{name} {encoding} {endian}: {e}"));
                assert_eq!(found.elements, sample.elements, "{name} {encoding} {endian}");
            }
        }
    }
}

#[test]
fn every_name_of_every_type() {
    let folder = Folder::new();
    for sample in samples() {
        for name in sample.names {
            let header = format!("{SMALL}type: {name}\nendian: little\nencoding: raw\n");
            let found = nrrd::read_array(&folder.nrrd("a.nrrd", &header, &sample.little)).unwrap();
            assert_eq!(found.elements, sample.elements, "{name}");
        }
    }
}

#[test]
fn one_byte_and_text_need_no_byte_order() {
    let folder = Folder::new();
    let bytes: Vec<u8> = (0..12).collect();
    let raw = folder.nrrd("raw.nrrd", &format!("{SMALL}type: uint8\nencoding: raw\n"), &bytes);
    assert_eq!(nrrd::read_array(&raw).unwrap().elements, Elements::U8(bytes));
    let text =
        folder.nrrd("text.nrrd", &format!("{SMALL}type: short\nencoding: ascii\n"), b"0 1 2 3 4 5 6 7 8 9 10 -11");
    assert_eq!(values(&nrrd::read(&text).unwrap())[11], -11.0);
}

#[test]
fn gzip_members_and_bzip2_streams_may_follow_each_other() {
    let folder = Folder::new();
    let bytes: Vec<u8> = (0..12).collect();
    for (encoding, data) in [
        ("gzip", [gzip(&bytes[..5]), gzip(&bytes[5..])].concat()),
        ("bzip2", [bzip2(&bytes[..5]), bzip2(&bytes[5..])].concat()),
    ] {
        let path = folder.nrrd("a.nrrd", &format!("{SMALL}type: uint8\nencoding: {encoding}\n"), &data);
        assert_eq!(nrrd::read_array(&path).unwrap().elements, Elements::U8(bytes.clone()), "{encoding}");
    }
}

#[test]
fn lines_and_bytes_are_skipped() {
    let folder = Folder::new();
    let bytes: Vec<u8> = (0..12).collect();
    let skipped = [b"ab\nc".as_slice(), &bytes].concat();
    let before = |data: Vec<u8>| [b"P5\n\n".as_slice(), &data].concat();
    for (name, fields, data) in [
        ("bytes", "encoding: raw\nbyte skip: 4\n", skipped.clone()),
        ("lines", "encoding: raw\nlineskip: 2\n", before(bytes.clone())),
        ("lines, then bytes", "encoding: raw\nline skip: 2\nbyte skip: 4\n", before(skipped.clone())),
        ("all but the data", "encoding: raw\nline skip: 1\nbyteskip: -1\n", before(skipped.clone())),
        ("gzip: lines before, bytes inside", "encoding: gzip\nline skip: 2\nbyte skip: 4\n", before(gzip(&skipped))),
        ("bzip2: bytes inside", "encoding: bz2\nbyte skip: 4\n", bzip2(&skipped)),
        ("hex: bytes of the file", "encoding: hex\nbyte skip: 3\n", [b"xyz".as_slice(), &hex(&bytes)].concat()),
    ] {
        let detached = format!("{SMALL}type: uint8\n{fields}data file: data/a.bin\n");
        folder.file("data/a.bin", &data);
        for path in [
            folder.nrrd("attached.nrrd", &format!("{SMALL}type: uint8\n{fields}"), &data),
            folder.nrrd("detached.nhdr", &detached, b""),
            // A detached header may end without its blank line.
            folder.file("open.nhdr", detached.as_bytes()),
        ] {
            let found = nrrd::read_array(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(found.elements, Elements::U8(bytes.clone()), "{name} from {}", path.display());
        }
    }
}

#[test]
fn data_may_be_spread_over_files() {
    let folder = Folder::new();
    // The slices of z, their rows, and the whole.
    for (name, from, to) in [
        ("slice7", 0, 6),
        ("slice5", 6, 12),
        ("row 001.raw", 0, 3),
        ("row 003.raw", 3, 6),
        ("row 005.raw", 6, 9),
        ("row 007.raw", 9, 12),
        ("both", 0, 12),
    ] {
        folder.file(name, &(from..to).collect::<Vec<u8>>());
    }
    for (data_file, files) in [
        ("both", 2),
        ("./both", 2),
        ("slice%d 7 5 -2", 3),
        ("slice%d 7 4 -2", 3),
        ("slice%d 7 5 -2 2", 3),
        ("row %03d.raw 1 7 2 1", 5),
        ("slice%d 7 5 -2 3", 3),
        ("LIST\nslice7\nslice5", 3),
        ("LIST 2\nslice7\nslice5", 3),
        ("LIST 1\nrow 001.raw\nrow 003.raw\nrow 005.raw\nrow 007.raw", 5),
        ("LIST 3\nboth", 2),
    ] {
        let path =
            folder.file("a.nhdr", format!("{SMALL}type: uchar\nencoding: raw\ndata file: {data_file}\n").as_bytes());
        let found = nrrd::read(&path).unwrap_or_else(|e| panic!("{data_file}: {e}"));
        assert_eq!(values(&found), (0..12).map(f64::from).collect::<Vec<_>>(), "{data_file}");
        assert_eq!(found.files.len(), files, "{data_file}: the header and its data");
        assert!(found.files.iter().all(|file| file.used && file.path.exists()), "{data_file}: {:?}", found.files);
    }
}

#[test]
fn skips_hold_for_each_of_many_files() {
    let folder = Folder::new();
    folder.file("a.1", b"one\n\x00\x01\x02\x03\x04\x05");
    folder.file("a.2", b"number two\n\x06\x07\x08\x09\x0a\x0b");
    let header = format!("{SMALL}type: uchar\nencoding: raw\nline skip: 1\ndata file: a.%d 1 2 1\n");
    let found = nrrd::read(&folder.file("a.nhdr", header.as_bytes())).unwrap();
    assert_eq!(values(&found), (0..12).map(f64::from).collect::<Vec<_>>());
}
