//! Order, lattice, and the series that make none.

use dicom_core::VR;
use dicom_dictionary_std::tags;
use glam::DVec3;
use pellucid::Fault;

use super::slices::{COLUMNS, ROWS, SliceFile, assert_values, folder_of, stored};

fn hu(i: usize, j: usize, k: usize) -> f64 {
    f64::from(stored(i, j, k)) - 24.0
}

#[test]
fn slices_are_ordered_by_position_whatever_names_and_instance_numbers_say() {
    let mut slices: Vec<SliceFile> =
        (0..4).map(|k| SliceFile::axial(k).text(tags::INSTANCE_NUMBER, VR::IS, &format!("{}", 7 * k % 3))).collect();
    slices.reverse();
    slices.swap(0, 2);
    let scan = folder_of(slices).read().unwrap();
    assert_eq!(scan.volume.grid().dims(), [COLUMNS, ROWS, 4]);
    assert_values(&scan, hu);
}

#[test]
fn pixel_spacing_is_first_between_rows_then_between_columns() {
    let scan = folder_of(SliceFile::stack(3)).read().unwrap();
    let at = |i, j, k| scan.volume.grid().index_to_lps_mm().transform_point3(DVec3::new(i, j, k));
    assert_eq!(at(0.0, 0.0, 0.0), DVec3::new(-10.0, 20.0, 0.0), "the first voxel");
    assert!((at(1.0, 0.0, 0.0) - DVec3::new(-9.5, 20.0, 0.0)).length() < 1e-12, "one column on: {}", at(1.0, 0.0, 0.0));
    assert!((at(0.0, 1.0, 0.0) - DVec3::new(-10.0, 20.8, 0.0)).length() < 1e-12, "one row on: {}", at(0.0, 1.0, 0.0));
    assert!(
        (at(0.0, 0.0, 2.0) - DVec3::new(-10.0, 20.0, 4.0)).length() < 1e-12,
        "two slices on: {}",
        at(0.0, 0.0, 2.0)
    );
}

#[test]
fn a_prone_scan_with_its_normal_to_the_feet_keeps_left_and_right() {
    // Rows run to the patient's left, columns to the front: the normal points to the feet, so the order is by falling z.
    let slices = (0..4).map(|k| SliceFile::axial(k).text(tags::IMAGE_ORIENTATION_PATIENT, VR::DS, "1\\0\\0\\0\\-1\\0"));
    let scan = folder_of(slices.collect()).read().unwrap();
    assert_values(&scan, |i, j, k| hu(i, j, 3 - k));
    let affine = scan.volume.grid().index_to_lps_mm();
    assert!(affine.matrix3.determinant() > 0.0, "k follows row x column, so the lattice is right-handed");
    let bright = affine.transform_point3(DVec3::new(4.0, 3.0, 0.0));
    let expected = DVec3::new(-8.0, 20.0 - 2.4, 6.0);
    assert!((bright - expected).length() < 1e-12, "found {bright}, expected {expected}, left is +x");
}

#[test]
fn gantry_tilt_becomes_shear() {
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    let orientation = format!("1\\0\\0\\0\\{cos:.12}\\{sin:.12}");
    // A tilted gantry moves along the table: the step is along z, not along the normal.
    let slices = (0..5).map(|k| SliceFile::axial(k).text(tags::IMAGE_ORIENTATION_PATIENT, VR::DS, &orientation));
    let scan = folder_of(slices.collect()).read().unwrap();
    let step = scan.volume.grid().index_to_lps_mm().matrix3.z_axis;
    assert!((step - DVec3::new(0.0, 0.0, 2.0)).length() < 1e-12, "found a step of {step} mm");
    let tilt = scan.facts.iter().find(|(label, _)| label == "gantry tilt").expect("the tilt is among the facts");
    assert!(tilt.1.starts_with("20.000 degrees"), "found {}", tilt.1);
    assert_values(&scan, hu);
}

#[test]
fn a_single_slice_is_as_thick_as_it_says_with_a_warning() {
    let scan = folder_of(vec![SliceFile::axial(0).text(tags::SLICE_THICKNESS, VR::DS, "3.5")]).read().unwrap();
    assert_eq!(scan.volume.grid().spacing_mm().z, 3.5);
    assert!(scan.warnings.iter().any(|w| w.contains("Slice Thickness, 3.5 mm")), "found {:?}", scan.warnings);
    let scan = folder_of(vec![SliceFile::axial(0)]).read().unwrap();
    assert_eq!(scan.volume.grid().spacing_mm().z, 1.0);
    assert!(scan.warnings.iter().any(|w| w.contains("taken to be 1 mm")), "found {:?}", scan.warnings);
}

#[test]
fn rounded_positions_are_within_tolerance_and_the_deviation_is_reported() {
    let off = [0.0, 0.004, -0.003, 0.005, 0.0];
    let slices = (0..5).map(|k| SliceFile::axial(k).at_mm([-10.0, 20.0, 2.0 * k as f64 + off[k]]));
    let scan = folder_of(slices.collect()).read().unwrap();
    let text = &scan.facts.iter().find(|(label, _)| label == "uneven spacing").unwrap().1;
    assert!(text.starts_with("up to 0.005000 mm of 0.0200 mm"), "found {text}");
}

#[test]
fn gaps_are_refused_with_their_places() {
    let slices = [0, 1, 2, 5, 6, 8].map(SliceFile::axial).into();
    let (fault, message) = folder_of(slices).refusal();
    assert_eq!(fault, Fault::Geometry);
    for part in
        ["slices are missing: 3 in 2 gaps", "between 4.000 mm (s02.dcm) and 10.000 mm (s03.dcm)", "12.000 mm (s04.dcm)"]
    {
        assert!(message.contains(part), "expected '{part}' in: {message}");
    }
}

#[test]
fn two_slices_at_one_position_are_refused_with_their_names() {
    let mut slices = SliceFile::stack(4);
    slices.push(SliceFile::axial(2));
    let (fault, message) = folder_of(slices).refusal();
    assert_eq!(fault, Fault::Geometry);
    for part in ["several slices lie at one position, 1 times", "s02.dcm and s04.dcm at 4.000 mm"] {
        assert!(message.contains(part), "expected '{part}' in: {message}");
    }
    // Two phases of the same slices: every position twice, told apart by the acquisition.
    let phase = |k: usize, n: &str| SliceFile::axial(k).text(tags::ACQUISITION_NUMBER, VR::IS, n);
    let slices = (0..6).map(|n| phase(n / 2, if n % 2 == 0 { "1" } else { "2" })).collect();
    let (_, message) = folder_of(slices).refusal();
    assert!(message.contains("one position, 3 times") && message.contains("numbers are [1, 2]"), "found: {message}");
}

#[test]
fn uneven_steps_are_refused() {
    let z = [0.0, 2.0, 4.0, 6.5, 8.5, 10.5];
    let slices = (0..6).map(|k| SliceFile::axial(k).at_mm([-10.0, 20.0, z[k]])).collect();
    let (fault, message) = folder_of(slices).refusal();
    assert_eq!(fault, Fault::Geometry);
    let part = "not evenly spaced (between 4.000 mm (s02.dcm) and 6.500 mm (s03.dcm))";
    assert!(message.contains(part) && message.contains("up to 0.5000 mm"), "found: {message}");
}

#[test]
fn a_slice_shifted_in_its_plane_is_refused() {
    let shift = |k: usize| if k == 3 { 0.7 } else { 0.0 };
    let slices = (0..6).map(|k| SliceFile::axial(k).at_mm([-10.0 + shift(k), 20.0, 2.0 * k as f64])).collect();
    let (fault, message) = folder_of(slices).refusal();
    assert_eq!(fault, Fault::Geometry);
    for part in ["do not lie on one lattice (s03.dcm at 6.000 mm)", "0.7000 mm of it in the plane"] {
        assert!(message.contains(part), "expected '{part}' in: {message}");
    }
}

#[test]
fn slices_without_a_place_are_refused_by_name_and_never_left_out() {
    let cases = [
        (tags::IMAGE_POSITION_PATIENT, "ImagePositionPatient (0020,0032) is missing"),
        (tags::IMAGE_ORIENTATION_PATIENT, "ImageOrientationPatient (0020,0037) is missing"),
        (tags::PIXEL_SPACING, "PixelSpacing (0028,0030) is missing"),
    ];
    for (tag, part) in cases {
        // The last slice: to leave it out would leave no gap.
        let mut slices = SliceFile::stack(3);
        slices.push(SliceFile::axial(3).without(tag));
        let (fault, message) = folder_of(slices).refusal();
        assert_eq!(fault, Fault::Geometry, "{message}");
        assert!(message.contains(part) && message.contains("1 such slices of 4: s03.dcm"), "found: {message}");
    }
}

#[test]
fn damaged_orientations_and_positions_are_refused_with_what_they_hold() {
    let cases = [
        (tags::IMAGE_ORIENTATION_PATIENT, "1\\0\\0\\0.5\\1\\0", "not two unit vectors at a right angle"),
        (tags::IMAGE_ORIENTATION_PATIENT, "0\\0\\0\\0\\0\\0", "not two unit vectors at a right angle"),
        (tags::IMAGE_POSITION_PATIENT, "1\\2", "is '1\\2', not 3 finite numbers"),
        (tags::PIXEL_SPACING, "0\\0.5", "not two distances"),
    ];
    for (tag, value, part) in cases {
        let (fault, message) = folder_of(vec![SliceFile::axial(0).text(tag, VR::DS, value)]).refusal();
        assert_eq!(fault, Fault::Geometry, "{message}");
        assert!(message.contains(part), "expected '{part}' in: {message}");
    }
}
