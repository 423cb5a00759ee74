//! Public scans, where they are at hand. The values are pydicom's and SimpleITK's (tests/readers/check_dicom.py).

use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};
use pellucid::io::Scan;
use pellucid::io::dicom::{SeriesChoice, read};
use sha2::{Digest as _, Sha256};

use crate::support::scan_path;

fn read_largest(path: &Path) -> Scan {
    read(path, &SeriesChoice::Largest, None).unwrap_or_else(|error| panic!("{error}"))
}

/// SHA-256 over all values, x fastest, as little-endian f32; what `pellucid info` prints as `values_sha256`.
fn values_sha256(scan: &Scan) -> String {
    let mut hash = Sha256::new();
    for index in 0..scan.volume.samples().len() {
        let value = scan.volume.rescale().value(scan.volume.samples().stored(index)) as f32;
        hash.update(value.to_le_bytes());
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// 20 slices, JPEG 2000, 12 of 16 bits, most of them without a SOP Instance UID.
#[test]
fn the_thorax_is_what_other_readers_read() {
    let Some(path) = scan_path("thorax-dicom") else { return };
    let scan = read_largest(&path);
    assert_eq!(scan.volume.grid().dims(), [512, 512, 20]);
    let affine = DAffine3::from_mat3_translation(
        DMat3::from_diagonal(DVec3::new(0.976_562_5, 0.976_562_5, 2.0)),
        DVec3::new(-249.511_718_75, -437.511_718_75, -804.5),
    );
    let found = scan.volume.grid().index_to_lps_mm();
    assert!(found.abs_diff_eq(affine, 1e-9), "found {found:?}, expected {affine:?}");
    assert_eq!(values_sha256(&scan), "44352f6ea210f6924bc4a4e1bdd315093aa20dfc9abcc840ffed009fb57b6ac4");
    assert!(scan.files.iter().all(|fate| fate.used), "found {:?}", scan.files);
}

/// 140 slices beside a DICOMDIR; the archive skull-phantom-dicom.tar.xz, unpacked.
#[test]
fn the_skull_phantom_is_what_other_readers_read() {
    let Some(path) = scan_path("skull-phantom-dicom") else { return };
    let scan = read_largest(&path);
    assert_eq!(scan.volume.grid().dims(), [512, 512, 140]);
    let affine = DAffine3::from_mat3_translation(
        DMat3::from_diagonal(DVec3::new(0.451_171_875, 0.451_171_875, 1.0)),
        DVec3::new(-115.5, -1.85, 694.21),
    );
    let found = scan.volume.grid().index_to_lps_mm();
    assert!(found.abs_diff_eq(affine, 1e-6), "found {found:?}, expected {affine:?}");
    assert_eq!(values_sha256(&scan), "fdcdfdc4464d61a594a04bff4e003e5ad607f957ac80203c73c9458b349a714e");
    let index: Vec<_> = scan.files.iter().filter(|fate| fate.reason.contains("a DICOMDIR")).collect();
    assert_eq!(index.len(), 1, "the DICOMDIR is named: {:?}", scan.files);
}
