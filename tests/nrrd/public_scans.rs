//! The public scans; voxel for voxel they are checked against other programs by `readers/check_nrrd.py`.

use glam::DVec3;
use pellucid::io::nrrd;
use pellucid::volume::{Quantity, Samples};

use crate::support::scan_path;

#[test]
fn body_in_hu() {
    let Some(path) = scan_path("abdomen/ct.nrrd") else { return };
    let scan = nrrd::read(&path).unwrap();
    let volume = &scan.volume;
    assert_eq!(volume.grid().dims(), [122, 101, 112]);
    assert_eq!(volume.value_range(), [-1207.0, 3382.0], "as its README says");
    assert_eq!(volume.quantity(), Quantity::Hu);
    let affine = volume.grid().index_to_lps_mm();
    assert_eq!(affine.matrix3.x_axis, DVec3::new(-3.0, 0.0, 0.0), "stored from left to right");
    assert_eq!(affine.matrix3.z_axis, DVec3::new(0.0, 0.0, 3.0));
    assert_eq!(scan.warnings, Vec::<String>::new());
}

#[test]
fn head_in_numbered_slices_without_directions() {
    let Some(path) = scan_path("head/quarter.nhdr") else { return };
    let scan = nrrd::read(&path).unwrap();
    let volume = &scan.volume;
    assert_eq!(volume.grid().dims(), [64, 64, 93]);
    assert!((volume.grid().spacing_mm() - DVec3::new(3.2, 3.2, 1.5)).length() < 1e-12);
    assert_eq!(scan.files.len(), 94, "the header and 93 slices");
    assert_eq!(
        scan.warnings.len(),
        2,
        "no directions, and a space that does not name the patient: {:?}",
        scan.warnings
    );

    // Slices were taken from the head down. The shoulders are wider than the face, and lie lower in LPS.
    let area = |k: usize| (0..64 * 64).filter(|&i| volume.value([i % 64, i / 64, k]) > 500.0).count();
    let height_mm = |k: usize| volume.grid().index_to_lps_mm().transform_point3(DVec3::new(0.0, 0.0, k as f64)).z;
    assert!(area(0) > 2000 && area(75) < 1300, "slice 0 is the head, slice 75 the neck: {} and {}", area(0), area(75));
    assert!(height_mm(0) > height_mm(75), "the head is above the neck: {} and {}", height_mm(0), height_mm(75));
}

#[test]
fn test_volumes_of_bytes() {
    for (name, dims) in [("tooth.nrrd", [103, 94, 161]), ("engine.nrrd", [256, 256, 128])] {
        let Some(path) = scan_path(name) else { return };
        let scan = nrrd::read(&path).unwrap();
        assert_eq!(scan.volume.grid().dims(), dims, "{name}");
        assert_eq!(scan.volume.quantity(), Quantity::Arbitrary, "{name}");
        assert!(matches!(scan.volume.samples(), Samples::I16(_)), "{name}: 16 bits in memory");
    }
}
