//! DICOM series at uneven distances, and a NRRD, which has no place for them.

use glam::DVec3;
use pellucid::Fault;
use pellucid::io::dicom::{SeriesChoice, SeriesDescription, SliceSpacing, read, read_spaced, write_series};
use pellucid::io::{Scan, nrrd};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Slices, Volume};
use tempfile::TempDir;

fn volume(places_mm: &[f64]) -> Volume {
    let n = places_mm.len();
    let step_mm = (places_mm[n - 1] - places_mm[0]) / (n - 1) as f64;
    let grid = Grid::axis_aligned([4, 3, n], DVec3::new(0.5, 0.75, step_mm)).unwrap();
    let samples = (0..grid.voxel_count()).map(|i| (i * 31 % 977) as i16).collect();
    Volume::new(grid, Samples::I16(samples), Rescale { slope: 1.0, intercept: -1024.0 }, Quantity::Hu)
        .and_then(|volume| volume.with_slices(Slices::new(places_mm)?))
        .expect("a valid volume")
}

/// A series of slices at these places, read with changing steps allowed or not.
fn written_and_read(places_mm: &[f64], spacing: SliceSpacing) -> pellucid::Result<Scan> {
    let folder = TempDir::new().expect("a temporary folder");
    let series = folder.path().join("series");
    write_series(&series, &volume(places_mm), &SeriesDescription::default()).expect("a series");
    read_spaced(&series, &SeriesChoice::Largest, spacing, None)
}

fn assert_range_mm(volume: &Volume, expected: [f64; 2]) {
    let found = volume.slice_step_range_mm();
    let apart = (0..2).map(|i| (found[i] - expected[i]).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-9, "found slices {found:?} mm apart, expected {expected:?}");
}

const PLACES_MM: [f64; 7] = [0.0, 1.0, 2.5, 4.5, 7.0, 10.0, 11.25];

#[test]
fn a_series_comes_back_with_every_slice_at_its_place() {
    let expected = volume(&PLACES_MM);
    let scan = written_and_read(&PLACES_MM, SliceSpacing::Uneven).unwrap();
    let found = &scan.volume;
    assert_eq!(found.grid().dims(), expected.grid().dims());
    assert_eq!(found.values_sha256(), expected.values_sha256());
    for (k, z) in PLACES_MM.into_iter().enumerate() {
        let (at, place) = (found.voxel_mm([3, 2, k]), DVec3::new(1.5, 1.5, z));
        assert!((at - place).length() < 1e-9, "slice {k}: found {at}, expected {place}");
    }
    assert_range_mm(found, [1.0, 3.0]);
    let facts: Vec<_> = scan.facts.iter().filter(|(label, _)| label == "slice spacing").collect();
    assert_eq!(facts[0].1, "1.0000 to 3.0000 mm along the normal, uneven");
}

#[test]
fn without_the_key_it_is_refused_and_the_key_is_named() {
    let folder = TempDir::new().expect("a temporary folder");
    let series = folder.path().join("series");
    write_series(&series, &volume(&PLACES_MM), &SeriesDescription::default()).expect("a series");
    let error = read(&series, &SeriesChoice::Largest, None).map(|_| ()).expect_err("uneven slices");
    assert_eq!(error.fault(), Fault::Geometry, "found {error}");
    let remedy = error.remedy_text().unwrap_or_default();
    assert!(remedy.contains("volume: { slices: uneven }"), "the remedy should name the key, found: {remedy}");
}

#[test]
fn an_even_series_is_even_with_the_key_too() {
    let scan = written_and_read(&[0.0, 2.0, 4.0, 6.0], SliceSpacing::Uneven).unwrap();
    assert_eq!(scan.volume.slices(), None, "nothing is uneven here");
    assert_eq!(scan.volume.grid().spacing_mm().z, 2.0);
}

#[test]
fn a_change_of_step_is_no_gap_and_a_gap_is_one() {
    // 5 mm through the base of the skull and 10 mm above is how heads were scanned.
    let planned = [0.0, 5.0, 10.0, 15.0, 25.0, 35.0, 45.0];
    let scan = written_and_read(&planned, SliceSpacing::Uneven).unwrap();
    assert_range_mm(&scan.volume, [5.0, 10.0]);
    for (places_mm, missing) in [
        (&[0.0, 5.0, 10.0, 20.0, 25.0, 30.0][..], "slices are missing: 1 in 1 gaps"),
        (&[0.0, 1.0, 2.0, 5.0, 6.0, 7.0, 9.0], "slices are missing: 3 in 2 gaps"),
        (&[0.0, 1.0, 2.5, 4.0, 8.5, 10.0, 11.0], "slices are missing: 2 in 1 gaps"),
    ] {
        let error = written_and_read(places_mm, SliceSpacing::Uneven).map(|_| ()).expect_err("a gap");
        assert_eq!(error.fault(), Fault::Geometry, "{places_mm:?}: {error}");
        assert!(error.to_string().contains(missing), "{places_mm:?}: expected {missing:?} in {error}");
        assert!(error.element_name().is_some_and(|place| place.contains("between")), "{places_mm:?}: {error}");
    }
}

#[test]
fn copies_of_a_slice_are_refused_with_the_key_too() {
    let error = written_and_read(&[0.0, 1.0, 3.0, 3.001, 4.5], SliceSpacing::Uneven).map(|_| ()).expect_err("a copy");
    assert!(error.to_string().contains("several slices lie at one position"), "found {error}");
}

#[test]
fn a_nrrd_cannot_hold_them() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path().join("a.nrrd");
    let error = nrrd::write(&path, &volume(&PLACES_MM), nrrd::Encoding::Gzip, &[]).expect_err("no place for a table");
    assert_eq!(error.fault(), Fault::Unsupported, "found {error}");
    assert!(error.to_string().contains("1.0000 to 3.0000 mm apart"), "found {error}");
    assert!(!path.exists(), "nothing is written");
}
