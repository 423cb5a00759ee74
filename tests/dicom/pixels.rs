//! Values: bits, sign, rescale, padding, units.

use dicom_core::VR;
use dicom_dictionary_std::tags;
use pellucid::Fault;
use pellucid::volume::{Quantity, Rescale, Samples};

use super::slices::{COLUMNS, ROWS, SliceFile, assert_values, folder_of, stored};

#[test]
fn stored_integers_are_kept_under_one_rescale() {
    let scan = folder_of(SliceFile::stack(3)).read().unwrap();
    assert_eq!(scan.volume.rescale(), Rescale { slope: 1.0, intercept: -24.0 });
    assert_eq!(scan.volume.quantity(), Quantity::Hu);
    assert!(matches!(scan.volume.samples(), Samples::I16(values) if values[0] == -300), "stored values as they are");
    assert!(scan.warnings.is_empty(), "found {:?}", scan.warnings);
}

#[test]
fn unsigned_values_of_12_and_16_bits_are_read_in_full() {
    for (bits, cells) in [(12, [0_u16, 1, 2047, 2048, 4095]), (16, [0, 1, 32767, 32768, 65535])] {
        let slice = SliceFile::axial(0).bits(16, bits, false).rescale("1", "-1024").words(5, 1, cells.into());
        let scan = folder_of(vec![slice]).read().unwrap();
        assert_values(&scan, |i, _, _| f64::from(cells[i]) - 1024.0);
        assert!(matches!(scan.volume.samples(), Samples::I16(_)), "16 bits suffice");
    }
}

#[test]
fn eight_bit_values_are_read_signed_and_unsigned() {
    let cells = vec![0_u8, 1, 127, 128, 255];
    for signed in [false, true] {
        let slice = SliceFile::axial(0).bits(8, 8, signed).rescale("2", "0").bytes(5, 1, cells.clone());
        let scan = folder_of(vec![slice]).read().unwrap();
        let value = |cell: u8| if signed { f64::from(cell.cast_signed()) } else { f64::from(cell) };
        assert_values(&scan, |i, _, _| 2.0 * value(cells[i]));
    }
}

#[test]
fn bits_outside_the_stored_ones_are_no_part_of_the_value() {
    // 12 signed bits from bit 2 on, with an old overlay above and rubbish below.
    let cells = vec![0b1000_0000_0000_0111, 0b0011_1111_1111_1101, 0b0010_0000_0000_0000];
    let slice = SliceFile::axial(0).bits(16, 12, true).number(tags::HIGH_BIT, 13).rescale("1", "0").words(3, 1, cells);
    assert_values(&folder_of(vec![slice]).read().unwrap(), |i, _, _| [1.0, -1.0, -2048.0][i]);
}

#[test]
fn whole_rescales_that_differ_by_slice_give_hu_in_16_bits() {
    let pairs = [("1", "-1024"), ("2", "-1000"), ("3", "5")];
    let slices = (0..3).map(|k| SliceFile::axial(k).rescale(pairs[k].0, pairs[k].1)).collect();
    let scan = folder_of(slices).read().unwrap();
    assert_values(&scan, |i, j, k| [1.0, 2.0, 3.0][k] * f64::from(stored(i, j, k)) + [-1024.0, -1000.0, 5.0][k]);
    assert!(matches!(scan.volume.samples(), Samples::I16(_)), "whole values fit 16 bits");
    assert_eq!(scan.volume.rescale(), Rescale::IDENTITY);
}

#[test]
fn broken_rescales_that_differ_by_slice_give_values_in_f32() {
    let slopes = ["0.5", "0.25", "1"];
    let slices = (0..3).map(|k| SliceFile::axial(k).rescale(slopes[k], "0.125")).collect();
    let scan = folder_of(slices).read().unwrap();
    assert!(matches!(scan.volume.samples(), Samples::F32(_)), "halves need f32");
    assert_values(&scan, |i, j, k| [0.5, 0.25, 1.0][k] * f64::from(stored(i, j, k)) + 0.125);
}

#[test]
fn padding_is_replaced_by_the_smallest_other_value() {
    let padded = |k: usize, intercept: &str| {
        let mut cells: Vec<u16> = (0..ROWS * COLUMNS).map(|n| (n as i16 + 50).cast_unsigned()).collect();
        cells[0] = (-2000_i16).cast_unsigned();
        cells[1] = (-1990_i16).cast_unsigned();
        SliceFile::axial(k)
            .words(COLUMNS, ROWS, cells)
            .rescale("1", intercept)
            // As a reader of implicit VR gives it: unsigned.
            .number(tags::PIXEL_PADDING_VALUE, 63536)
            .number(tags::PIXEL_PADDING_RANGE_LIMIT, (-1980_i16).cast_unsigned())
    };
    let one_rescale = folder_of(vec![padded(0, "-10"), padded(1, "-10")]).read().unwrap();
    let lowest = 52.0 - 10.0;
    assert_values(&one_rescale, |i, j, _| if j == 0 && i < 2 { lowest } else { (5 * j + i) as f64 + 40.0 });
    let warning = "4 pixels of 2 slices are padding: replaced by the smallest value of the others, 42";
    assert!(one_rescale.warnings.iter().any(|w| w == warning), "found {:?}", one_rescale.warnings);

    for intercept in ["-20", "-20.5"] {
        let scan = folder_of(vec![padded(0, "-10"), padded(1, intercept)]).read().unwrap();
        let second: f64 = intercept.parse().unwrap();
        assert_values(&scan, |i, j, k| {
            let shift = if k == 0 { -10.0 } else { second };
            if j == 0 && i < 2 { 52.0 + second } else { (5 * j + i) as f64 + 50.0 + shift }
        });
    }
}

#[test]
fn units_are_hu_only_where_the_files_say_so() {
    let cases = [
        ("CT", None, true, Quantity::Hu, None),
        ("CT", Some("HU"), true, Quantity::Hu, None),
        ("CT", Some("US"), true, Quantity::Arbitrary, Some("Rescale Type is US")),
        ("CT", None, false, Quantity::Arbitrary, Some("Rescale Slope and Intercept are missing")),
        ("MR", None, true, Quantity::Arbitrary, Some("modality MR: values are not taken as HU")),
        ("PT", Some("HU"), true, Quantity::Hu, Some("modality PT, with values in HU")),
    ];
    for (modality, unit, has_rescale, quantity, warning) in cases {
        let mut slice =
            SliceFile::axial(0).text(tags::MODALITY, VR::CS, modality).text(tags::SLICE_THICKNESS, VR::DS, "1");
        if let Some(unit) = unit {
            slice = slice.text(tags::RESCALE_TYPE, VR::LO, unit);
        }
        if !has_rescale {
            slice = slice.without(tags::RESCALE_SLOPE).without(tags::RESCALE_INTERCEPT);
        }
        let scan = folder_of(vec![slice]).read().unwrap();
        assert_eq!(scan.volume.quantity(), quantity, "{modality} {unit:?}");
        let unit_warnings = &scan.warnings[..scan.warnings.len() - 1]; // The last is about the single slice.
        match warning {
            None => assert!(unit_warnings.is_empty(), "found {unit_warnings:?}"),
            Some(text) => {
                assert!(unit_warnings.iter().any(|w| w.contains(text)), "found {unit_warnings:?}, expected {text}")
            }
        }
    }
}

#[test]
fn pixels_that_are_not_read_are_refused_with_the_reason() {
    let slice = || SliceFile::axial(0);
    let cases = [
        (
            slice().number(tags::SAMPLES_PER_PIXEL, 3).text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "RGB"),
            Fault::Unsupported,
            "colour images (RGB)",
        ),
        (
            slice().text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "PALETTE COLOR"),
            Fault::Unsupported,
            "'PALETTE COLOR' is not read",
        ),
        (slice().bits(32, 32, true), Fault::Unsupported, "32 bits allocated"),
        (slice().bits(16, 12, true).number(tags::HIGH_BIT, 5), Fault::Unsupported, "12 bits stored with high bit 5"),
        (slice().sequence(tags::MODALITY_LUT_SEQUENCE, Vec::new()), Fault::Unsupported, "Modality LUT"),
        (slice().rescale("0", "0"), Fault::Input, "RescaleSlope (0028,1053) is 0"),
        (slice().rescale("1", "x"), Fault::Input, "RescaleIntercept (0028,1052) is 'x'"),
        (slice().without(tags::RESCALE_SLOPE), Fault::Input, "RescaleSlope (0028,1053) is missing"),
        (
            slice().words(5, 4, vec![0; 19]),
            Fault::Input,
            "found 38 bytes, expected 40 for 1 frames of 5 x 4 pixels of 16 bits",
        ),
        (slice().without(tags::PIXEL_DATA), Fault::Input, "there is no uncompressed Pixel Data"),
        (slice().words(60000, 60000, vec![0; 20]), Fault::Input, "expected more than 7200000000 bytes"),
        (
            slice().number(tags::PIXEL_PADDING_VALUE, 7).words(2, 1, vec![7, 7]),
            Fault::Input,
            "every pixel of the series is padding",
        ),
    ];
    for (slice, fault, part) in cases {
        let (found, message) = folder_of(vec![slice]).refusal();
        assert_eq!(found, fault, "{message}");
        assert!(message.contains(part), "expected '{part}' in: {message}");
    }
}

#[test]
fn a_file_cut_short_is_named() {
    let folder = folder_of(SliceFile::stack(3));
    let path = folder.path().join("s01.dcm");
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 7]).unwrap();
    let (fault, message) = folder.refusal();
    assert_eq!(fault, Fault::Input, "{message}");
    assert!(
        message.contains("s01.dcm") && message.contains(&format!("a file of {} bytes", bytes.len() - 7)),
        "{message}"
    );
}
