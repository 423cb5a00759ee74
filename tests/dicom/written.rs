//! Series written by pellucid: what goes in comes out.

use dicom_dictionary_std::{tags, uids};
use glam::{DAffine3, DMat3, DVec3};
use pellucid::io::dicom::{SeriesChoice, SeriesDescription, read, write_series};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};
use pellucid::{Fault, Result};

use super::slices::Scratch;

fn described(text: &str) -> SeriesDescription {
    SeriesDescription { description: text.to_owned(), seed: 1 }
}

/// A volume whose rows and columns are turned, and whose slices are tilted against their normal.
fn oblique(handedness: f64) -> Grid {
    let turn = DMat3::from_rotation_x(0.3) * DMat3::from_rotation_y(-0.2) * DMat3::from_rotation_z(1.1);
    let steps = DMat3::from_cols(
        turn.x_axis * 0.451_171_875,
        turn.y_axis * 0.7,
        turn.z_axis * (1.25 * handedness) + turn.y_axis * 0.31,
    );
    Grid::new([4, 3, 5], DAffine3::from_mat3_translation(steps, DVec3::new(-123.456, 78.9, -1000.125))).unwrap()
}

fn samples() -> Samples {
    Samples::I16((0..60).map(|n| (n * 1087 - 32000) as i16).collect())
}

fn round_trip(volume: &Volume) -> Result<Volume> {
    let scratch = Scratch::new();
    let dir = scratch.path().join("series");
    let count = write_series(&dir, volume, &described("Größe 1"))?;
    assert_eq!(count, volume.grid().dims()[2], "one file per slice");
    assert_eq!(std::fs::read_dir(scratch.path()).unwrap().count(), 1, "nothing but the folder is left");
    let scan = read(&dir, &SeriesChoice::Named("größe 1".to_owned()), None)?;
    assert!(scan.files.iter().all(|fate| fate.used), "found {:?}", scan.files);
    assert!(scan.volume.quantity() != Quantity::Hu || scan.warnings.is_empty(), "found {:?}", scan.warnings);
    Ok(scan.volume)
}

#[test]
fn values_and_affine_survive() {
    let cases = [
        (samples(), Rescale::IDENTITY, Quantity::Hu),
        // As unsigned 16-bit scans are kept.
        (samples(), Rescale { slope: 1.0, intercept: 31744.0 }, Quantity::Hu),
        (samples(), Rescale { slope: 0.1, intercept: -0.5 }, Quantity::Arbitrary),
    ];
    for (samples, rescale, quantity) in cases {
        let volume = Volume::new(oblique(1.0), samples, rescale, quantity).unwrap();
        let found = round_trip(&volume).unwrap();
        assert_eq!(found.samples(), volume.samples(), "stored values");
        assert_eq!((found.rescale(), found.quantity()), (rescale, quantity));
        let (a, b) = (found.grid().index_to_lps_mm(), volume.grid().index_to_lps_mm());
        assert!(a.abs_diff_eq(b, 1e-10), "found {a:?}, expected {b:?}");
    }
}

#[test]
fn whole_values_in_f32_survive_as_values() {
    let values = Samples::F32(vec![-1024.0, 3071.0, 0.0, 32767.0]);
    let grid = Grid::axis_aligned([2, 1, 2], DVec3::new(0.5, 0.6, 0.7)).unwrap();
    let volume = Volume::new(grid, values, Rescale::IDENTITY, Quantity::Hu).unwrap();
    let found = round_trip(&volume).unwrap();
    for n in 0..4 {
        let voxel = volume.grid().unflatten(n);
        assert_eq!(found.value(voxel), volume.value(voxel), "voxel {voxel:?}");
    }
}

#[test]
fn a_left_handed_lattice_comes_back_with_every_value_at_its_place() {
    let volume = Volume::new(oblique(-1.0), samples(), Rescale::IDENTITY, Quantity::Hu).unwrap();
    let found = round_trip(&volume).unwrap();
    let (a, b) = (found.grid().index_to_lps_mm(), volume.grid().index_to_lps_mm());
    for n in 0..60 {
        let [i, j, k] = volume.grid().unflatten(n);
        let there = [i, j, 4 - k];
        assert_eq!(found.value(there), volume.value([i, j, k]), "voxel ({i}, {j}, {k})");
        let place =
            |affine: DAffine3, [i, j, k]: [usize; 3]| affine.transform_point3(DVec3::new(i as f64, j as f64, k as f64));
        let distance = place(a, there).distance(place(b, [i, j, k]));
        assert!(distance < 1e-9, "voxel ({i}, {j}, {k}) is {distance} mm from its place");
    }
}

#[test]
fn files_are_the_same_each_time_and_unlike_for_another_seed() {
    let scratch = Scratch::new();
    let volume = Volume::new(oblique(1.0), samples(), Rescale::IDENTITY, Quantity::Hu).unwrap();
    let write = |name: &str, seed: u64| {
        let dir = scratch.path().join(name);
        write_series(&dir, &volume, &SeriesDescription { description: String::new(), seed }).unwrap();
        std::fs::read(dir.join("0003.dcm")).unwrap()
    };
    let first = write("a", 1);
    assert!(first == write("b", 1), "the same content gives the same bytes");
    assert!(first != write("c", 2), "another seed gives other identifiers");
}

#[test]
fn a_slice_has_every_attribute_that_a_ct_image_must_have() {
    let scratch = Scratch::new();
    let dir = scratch.path().join("series");
    let volume = Volume::new(oblique(1.0), samples(), Rescale::IDENTITY, Quantity::Hu).unwrap();
    write_series(&dir, &volume, &described("")).unwrap();
    let slice = dicom_object::open_file(dir.join("0001.dcm")).unwrap();
    assert_eq!(slice.meta().transfer_syntax(), uids::EXPLICIT_VR_LITTLE_ENDIAN);
    let class = slice.get(tags::SOP_CLASS_UID).unwrap().to_str().unwrap();
    assert_eq!(class.trim_end_matches('\0'), uids::CT_IMAGE_STORAGE);
    // Types 1 and 2 of the modules of PS3.3 table A.3-1 that are mandatory.
    let mandatory = [
        tags::PATIENT_NAME,
        tags::PATIENT_ID,
        tags::PATIENT_BIRTH_DATE,
        tags::PATIENT_SEX,
        tags::STUDY_INSTANCE_UID,
        tags::STUDY_DATE,
        tags::STUDY_TIME,
        tags::REFERRING_PHYSICIAN_NAME,
        tags::STUDY_ID,
        tags::ACCESSION_NUMBER,
        tags::MODALITY,
        tags::SERIES_INSTANCE_UID,
        tags::SERIES_NUMBER,
        tags::FRAME_OF_REFERENCE_UID,
        tags::POSITION_REFERENCE_INDICATOR,
        tags::MANUFACTURER,
        tags::INSTANCE_NUMBER,
        tags::PIXEL_SPACING,
        tags::IMAGE_ORIENTATION_PATIENT,
        tags::IMAGE_POSITION_PATIENT,
        tags::SLICE_THICKNESS,
        tags::SAMPLES_PER_PIXEL,
        tags::PHOTOMETRIC_INTERPRETATION,
        tags::ROWS,
        tags::COLUMNS,
        tags::BITS_ALLOCATED,
        tags::BITS_STORED,
        tags::HIGH_BIT,
        tags::PIXEL_REPRESENTATION,
        tags::PIXEL_DATA,
        tags::IMAGE_TYPE,
        tags::RESCALE_INTERCEPT,
        tags::RESCALE_SLOPE,
        tags::KVP,
        tags::ACQUISITION_NUMBER,
        tags::SOP_INSTANCE_UID,
        tags::PATIENT_POSITION,
    ];
    let missing: Vec<_> = mandatory.into_iter().filter(|tag| slice.get(*tag).is_none()).collect();
    assert!(missing.is_empty(), "missing: {missing:?}");
}

#[test]
fn what_a_ct_series_cannot_hold_is_refused_and_leaves_nothing_behind() {
    let plain = Grid::axis_aligned([4, 3, 5], DVec3::ONE).unwrap();
    let sheared = DMat3::from_cols(DVec3::X, DVec3::new(0.2, 1.0, 0.0), DVec3::Z);
    let sheared = Grid::new([4, 3, 5], DAffine3::from_mat3(sheared)).unwrap();
    let third = Rescale { slope: 1.0 / 3.0, intercept: 0.0 };
    let halves = Samples::F32((0..60).map(|n| n as f32 / 2.0).collect());
    let cases = [
        (sheared, samples(), Rescale::IDENTITY, "", "sheared in the plane of its slices: found 78.6901 degrees"),
        (plain, samples(), third, "", "the rescale slope cannot be written"),
        (plain, halves, Rescale::IDENTITY, "", "not all whole numbers of 16 bits (voxel (1, 0, 0)): found 0.5"),
        (plain, samples(), Rescale::IDENTITY, "a\\b", "the series description cannot be written"),
    ];
    for (grid, samples, rescale, text, part) in cases {
        let scratch = Scratch::new();
        let volume = Volume::new(grid, samples, rescale, Quantity::Hu).unwrap();
        let error = write_series(&scratch.path().join("series"), &volume, &described(text)).unwrap_err();
        assert_eq!(error.fault(), Fault::Unsupported, "{error}");
        assert!(error.to_string().contains(part), "expected '{part}' in: {error}");
        assert_eq!(std::fs::read_dir(scratch.path()).unwrap().count(), 0, "nothing is left behind");
    }
}

#[test]
fn a_folder_that_holds_something_is_left_alone() {
    let scratch = Scratch::new();
    let volume = Volume::new(oblique(1.0), samples(), Rescale::IDENTITY, Quantity::Hu).unwrap();
    std::fs::write(scratch.path().join("other.txt"), "kept").unwrap();
    let error = write_series(scratch.path(), &volume, &described("")).unwrap_err();
    assert_eq!(error.fault(), Fault::Output, "{error}");
    assert!(error.to_string().contains("exists and is not empty"), "found: {error}");
    let empty = scratch.path().join("empty");
    std::fs::create_dir(&empty).unwrap();
    assert_eq!(write_series(&empty, &volume, &described("")).unwrap(), 5, "an empty folder is filled");
}
