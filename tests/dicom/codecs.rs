//! Transfer syntaxes. The compressed frames in fixtures/ were made by other programs (fixtures/make.py) from known values.

use dicom_core::DataElement;
use dicom_core::VR;
use dicom_core::value::PrimitiveValue;
use dicom_dictionary_std::{tags, uids};
use dicom_object::InMemDicomObject;
use pellucid::Fault;
use pellucid::io::dicom::scan_folder;

use super::slices::{COLUMNS, ROWS, SliceFile, assert_values, folder_of, stored};

const WIDE: usize = 40;
const HIGH: usize = 32;

/// The values of the fixtures, as in make.py.
fn ramp(i: usize, j: usize, bits: u32, signed: bool) -> f64 {
    let value = ((i * 5003 + j * 12289) % (1 << bits)) as f64;
    if signed { value - f64::from(1 << (bits - 1)) } else { value }
}

fn fixture(name: &str) -> Vec<u8> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/dicom/fixtures").join(name);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn slice_of(name: &str, syntax: &'static str) -> SliceFile {
    SliceFile::axial(0).rescale("1", "0").compressed(syntax, WIDE, HIGH, fixture(name))
}

#[test]
fn uncompressed_syntaxes_give_the_same_values() {
    let syntaxes = [
        uids::IMPLICIT_VR_LITTLE_ENDIAN,
        uids::EXPLICIT_VR_LITTLE_ENDIAN,
        #[expect(deprecated, reason = "retired from the standard, not from archives")]
        uids::EXPLICIT_VR_BIG_ENDIAN,
        uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN,
    ];
    for syntax in syntaxes {
        let slices = SliceFile::stack(3).into_iter().map(|slice| slice.syntax(syntax)).collect();
        let scan = folder_of(slices).read().unwrap_or_else(|error| panic!("{syntax}: {error}"));
        assert_values(&scan, |i, j, k| f64::from(stored(i, j, k)) - 24.0);
        let eight =
            SliceFile::axial(0).bits(8, 8, false).rescale("1", "0").bytes(3, 3, (0..9).collect()).syntax(syntax);
        let scan = folder_of(vec![eight]).read().unwrap_or_else(|error| panic!("{syntax}, 8 bits: {error}"));
        assert_values(&scan, |i, j, _| (3 * j + i) as f64);
    }
}

#[test]
fn eight_bit_pixels_in_big_endian_words_keep_their_order() {
    // PS3.5 §8.1.1: the first pixel is the low byte of the word, whatever the order of bytes.
    #[expect(deprecated, reason = "retired from the standard, not from archives")]
    let syntax = uids::EXPLICIT_VR_BIG_ENDIAN;
    let words = vec![0x0201, 0x0403];
    let slice = SliceFile::axial(0).words(4, 1, words).bits(8, 8, false).rescale("1", "0").syntax(syntax);
    assert_values(&folder_of(vec![slice]).read().unwrap(), |i, _, _| (i + 1) as f64);
}

/// PS3.5 annex G by hand: the high bytes, then the low bytes, all as literal runs except for one repeat.
fn run_length_encoded(values: &[i16]) -> Vec<u8> {
    let segment = |bytes: Vec<u8>| {
        let mut coded = vec![(bytes.len() - 3) as u8];
        coded.extend(&bytes[..bytes.len() - 2]);
        // -1: the next byte twice.
        coded.extend([0xFF, bytes[bytes.len() - 1]]);
        if coded.len() % 2 == 1 {
            coded.push(0x80);
        }
        coded
    };
    let high = segment(values.iter().map(|v| v.to_be_bytes()[0]).collect());
    let low = segment(values.iter().map(|v| v.to_be_bytes()[1]).collect());
    let mut frame = vec![0; 64];
    for (n, word) in [2, 64, 64 + high.len() as u32].into_iter().enumerate() {
        frame[4 * n..4 * n + 4].copy_from_slice(&word.to_le_bytes());
    }
    [frame, high, low].concat()
}

#[test]
fn run_length_coding_gives_signed_values() {
    let mut values: Vec<i16> = (0..20).map(|n| 1000 * n - 12000).collect();
    values[19] = values[18];
    let coded = run_length_encoded(&values);
    let slice = SliceFile::axial(0).rescale("1", "0").compressed(uids::RLE_LOSSLESS, COLUMNS, ROWS, coded.clone());
    assert_values(&folder_of(vec![slice]).read().unwrap(), |i, j, _| f64::from(values[5 * j + i]));
    // Cut short, the data is an error, not a panic and not a picture.
    let slice = SliceFile::axial(0).compressed(uids::RLE_LOSSLESS, COLUMNS, ROWS, coded[..80].to_vec());
    let (fault, message) = folder_of(vec![slice]).refusal();
    assert_eq!(fault, Fault::Input, "{message}");
    assert!(message.contains("s00.dcm: the compressed pixels cannot be decoded"), "found: {message}");
}

#[test]
fn jpeg_2000_gives_signed_and_unsigned_values() {
    for (name, bits, signed) in [
        ("signed-16.j2k", 16, true),
        ("signed-13.j2k", 13, true),
        ("unsigned-13.j2k", 13, false),
        ("unsigned-16.j2k", 16, false),
    ] {
        let slice =
            slice_of(name, uids::JPEG2000_LOSSLESS).bits(16, bits, signed).text(tags::SLICE_THICKNESS, VR::DS, "1");
        let scan = folder_of(vec![slice]).read().unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_values(&scan, |i, j, _| ramp(i, j, bits.into(), signed));
        assert_eq!(scan.warnings.len(), 1, "only the single slice: {:?}", scan.warnings);
    }
}

/// The sign of a codestream and Pixel Representation disagree (pydicom#1149): the bits are right, their reading is not.
#[test]
fn jpeg_2000_of_another_sign_is_read_by_the_pixel_representation_with_a_warning() {
    let wrap = |value: f64, signed: bool| {
        let bits = (value as i32) & 0x1FFF;
        f64::from(if signed && bits >= 0x1000 { bits - 0x2000 } else { bits })
    };
    for (name, in_stream, in_header, bits_stored) in [
        ("unsigned-13.j2k", false, true, 13),
        ("signed-13.j2k", true, false, 13),
        ("unsigned-13.j2k", false, true, 16),
        ("signed-13.j2k", true, false, 16),
    ] {
        let slice = slice_of(name, uids::JPEG2000_LOSSLESS).bits(16, bits_stored, in_header);
        let scan = folder_of(vec![slice]).read().unwrap();
        assert_values(&scan, |i, j, _| wrap(ramp(i, j, 13, in_stream), in_header));
        let found = scan.warnings.iter().any(|w| w.contains("the JPEG 2000 data is") && w.contains("s00.dcm"));
        assert!(found, "{name}: found {:?}", scan.warnings);
    }
}

#[test]
fn lossless_jpeg_gives_the_bits_that_went_in() {
    let (sv1, process14) = (uids::JPEG_LOSSLESS_SV1, uids::JPEG_LOSSLESS);
    for (name, syntax, bits, signed) in [
        ("bits-16-predictor-1.ljpg", sv1, 16, true),
        ("bits-16-predictor-1.ljpg", process14, 16, true),
        ("bits-12-predictor-6.ljpg", process14, 12, false),
        ("bits-8-predictor-1.ljpg", sv1, 8, false),
    ] {
        let allocated = if bits == 8 { 8 } else { 16 };
        let slice = slice_of(name, syntax).bits(allocated, bits, signed);
        let scan = folder_of(vec![slice]).read().unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_values(&scan, |i, j, _| ramp(i, j, bits.into(), signed));
    }
    // 8-bit samples in 16-bit cells: the decoder fills half of the frame.
    let slice = slice_of("bits-8-predictor-1.ljpg", sv1).bits(16, 8, false);
    assert_values(&folder_of(vec![slice]).read().unwrap(), |i, j, _| ramp(i, j, 8, false));
}

#[test]
fn baseline_jpeg_is_read_to_its_own_loss_and_12_bits_are_refused() {
    let slice = slice_of("baseline-8.jpg", uids::JPEG_BASELINE8_BIT).bits(8, 8, false).text(
        tags::LOSSY_IMAGE_COMPRESSION,
        VR::CS,
        "01",
    );
    let scan = folder_of(vec![slice]).read().unwrap();
    for (i, j) in [(0, 0), (39, 0), (0, 31), (39, 31), (17, 9)] {
        let (found, expected) = (scan.volume.value([i, j, 0]), (20 + 3 * i + 2 * j) as f64);
        assert!((found - expected).abs() <= 2.0, "pixel ({i}, {j}): found {found}, expected {expected} within 2");
    }
    assert!(scan.warnings.iter().any(|w| w.contains("compressed with loss")), "found {:?}", scan.warnings);

    let slice = slice_of("extended-12.jpg", uids::JPEG_EXTENDED12_BIT).bits(16, 12, false);
    let (fault, message) = folder_of(vec![slice]).refusal();
    assert_eq!(fault, Fault::Unsupported, "{message}");
    assert!(message.contains("JPEG of 12 bits by cosine transform is not decoded"), "found: {message}");
}

#[test]
fn compressed_data_that_is_not_the_image_described_is_refused() {
    let stream = fixture("signed-16.j2k");
    let j2k =
        |rows, stream: &[u8]| SliceFile::axial(0).compressed(uids::JPEG2000_LOSSLESS, WIDE, rows, stream.to_vec());
    let cases = [
        (j2k(HIGH + 1, &stream), "found 40 x 32 pixels of 1 components"),
        (j2k(HIGH, &stream[..60]), "cannot be decoded"),
        (j2k(HIGH, b"rubbish!"), "cannot be decoded"),
        (SliceFile::axial(0).syntax(uids::JPEG2000_LOSSLESS), "there is no compressed Pixel Data"),
    ];
    for (slice, part) in cases {
        let (fault, message) = folder_of(vec![slice]).refusal();
        assert_eq!(fault, Fault::Input, "{message}");
        assert!(message.contains(part), "expected '{part}' in: {message}");
    }
}

/// Decoders that fill the rest of a frame with something would turn a broken copy into a picture.
#[test]
fn compressed_data_cut_short_is_refused_wherever_it_is_cut() {
    for (name, syntax) in [
        ("signed-16.j2k", uids::JPEG2000_LOSSLESS),
        ("bits-16-predictor-1.ljpg", uids::JPEG_LOSSLESS_SV1),
        ("bits-12-predictor-6.ljpg", uids::JPEG_LOSSLESS),
    ] {
        let stream = fixture(name);
        for percent in [5, 30, 60, 90, 97] {
            let cut = stream[..stream.len() * percent / 100].to_vec();
            let slice = SliceFile::axial(0).compressed(syntax, WIDE, HIGH, cut);
            let scan = folder_of(vec![slice]).read().map(|scan| scan.volume.grid().dims());
            assert!(scan.is_err(), "{name} cut to {percent} % was read as {scan:?}");
        }
    }
}

#[test]
fn syntaxes_without_a_decoder_are_named_before_anything_is_read() {
    let slices = (0..2).map(|k| SliceFile::axial(k).compressed(uids::JPEGLS_LOSSLESS, 5, 4, vec![0; 8])).collect();
    let folder = folder_of(slices);
    assert!(!scan_folder(folder.path()).unwrap().series[0].decodable, "JPEG-LS is not decoded");
    let (fault, message) = folder.refusal();
    assert_eq!(fault, Fault::Unsupported, "{message}");
    let part = "does not decode the transfer syntax: found JPEG-LS Lossless Image Compression (1.2.840.10008.1.2.4.80)";
    assert!(message.contains(part), "expected '{part}' in: {message}");
}

/// An enhanced CT image: all slices in one file, their positions in functional groups, in no order.
#[test]
fn frames_of_an_enhanced_image_are_slices() {
    let item = |elements: Vec<(dicom_core::Tag, &str)>| {
        let elements =
            elements.into_iter().map(|(tag, text)| DataElement::new(tag, VR::DS, PrimitiveValue::from(text)));
        InMemDicomObject::from_element_iter(elements)
    };
    let group = |groups: Vec<(dicom_core::Tag, InMemDicomObject)>| {
        let sequences = groups
            .into_iter()
            .map(|(tag, item)| DataElement::new(tag, VR::SQ, dicom_core::value::DataSetSequence::from(vec![item])));
        InMemDicomObject::from_element_iter(sequences)
    };
    let order = [2, 0, 1];
    let frames = order.map(|k| {
        group(vec![
            (tags::PLANE_POSITION_SEQUENCE, item(vec![(tags::IMAGE_POSITION_PATIENT, &format!("1\\2\\{}", 3 * k))])),
            (
                tags::PIXEL_VALUE_TRANSFORMATION_SEQUENCE,
                item(vec![(tags::RESCALE_SLOPE, "1"), (tags::RESCALE_INTERCEPT, &format!("{}", 10 * k))]),
            ),
        ])
    });
    let shared = group(vec![
        (tags::PLANE_ORIENTATION_SEQUENCE, item(vec![(tags::IMAGE_ORIENTATION_PATIENT, "1\\0\\0\\0\\1\\0")])),
        (tags::PIXEL_MEASURES_SEQUENCE, item(vec![(tags::PIXEL_SPACING, "0.8\\0.5")])),
    ]);
    let cells: Vec<u16> = order.iter().flat_map(|k| (0..6).map(move |n| (100 * k + n) as u16)).collect();
    let bare = [
        tags::IMAGE_POSITION_PATIENT,
        tags::IMAGE_ORIENTATION_PATIENT,
        tags::PIXEL_SPACING,
        tags::RESCALE_SLOPE,
        tags::RESCALE_INTERCEPT,
    ];
    let file = || {
        bare.into_iter()
            .fold(SliceFile::axial(0), SliceFile::without)
            .text(tags::NUMBER_OF_FRAMES, VR::IS, "3")
            .words(3, 2, cells.clone())
            .sequence(tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE, vec![shared.clone()])
    };
    let placed = file().sequence(tags::PER_FRAME_FUNCTIONAL_GROUPS_SEQUENCE, frames.into());
    let scan = folder_of(vec![placed]).read().unwrap();
    assert_eq!(scan.volume.grid().spacing_mm(), glam::DVec3::new(0.5, 0.8, 3.0));
    assert_values(&scan, |i, j, k| (110 * k + 3 * j + i) as f64);

    let (fault, message) = folder_of(vec![file()]).refusal();
    assert_eq!(fault, Fault::Geometry, "{message}");
    assert!(message.contains("3 frames without a position for each"), "found: {message}");
}
