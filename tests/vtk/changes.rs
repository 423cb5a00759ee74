//! A scene that is wrong by one percent is not within the limits.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pellucid::image::metrics::compare_as_seen;
use pellucid::integrate;
use pellucid::pipeline::{self, Options};
use pellucid::volume::{Grid, Volume};

use super::{UNLIT, against_vtk, reference, spec};

/// The march of a scene whose camera stays while its volume is moved.
fn with_grid(name: &str, change: impl Fn(DAffine3, DVec3) -> DAffine3) -> Option<String> {
    let spec = spec(name, &[]).expect("a scene of its own");
    let scan = pipeline::load(&spec, &pipeline::Options::default()).expect("readable");
    let plan = pipeline::plan(&spec, &scan, &Options::default()).expect("a plan");
    let volume = scan.volume;
    let grid = Grid::new(volume.grid().dims(), change(volume.grid().index_to_lps_mm(), volume.grid().center_mm()));
    let moved = Volume::new(grid.expect("a grid"), volume.samples().clone(), volume.rescale(), volume.quantity());
    let image =
        integrate::render(&moved.expect("a volume"), &plan.scene, &plan.method, &|_| ()).expect("renders").image;
    UNLIT.objection(&compare_as_seen(&reference(name), &image, 1.0).expect("one size"))
}

#[test]
fn unchanged_it_passes() {
    assert_eq!(with_grid("balls-rotated", |affine, _| affine), None);
}

#[test]
fn a_spacing_longer_by_one_percent_is_caught() {
    for axis in 0..3 {
        let mut scale = DVec3::ONE;
        scale[axis] = 1.01;
        let caught = with_grid("balls-rotated", |affine, _| affine * DAffine3::from_scale(scale));
        assert!(caught.is_some(), "axis {axis}: one percent longer passed");
    }
}

#[test]
fn an_orientation_turned_by_one_percent_is_caught() {
    // One percent of a right angle.
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let turn = DMat3::from_quat(DQuat::from_axis_angle(axis, 0.9_f64.to_radians()));
        let caught = with_grid("balls-rotated", |affine, center| {
            let about =
                DAffine3::from_translation(center) * DAffine3::from_mat3(turn) * DAffine3::from_translation(-center);
            about * affine
        });
        assert!(caught.is_some(), "turned about {axis} by 0.9 degrees it passed");
    }
}

#[test]
fn a_camera_changed_by_one_percent_is_caught() {
    for change in [
        "camera.zoom=1.01",
        "camera.azimuth=30.9",
        "camera.elevation=20.9",
        "camera.roll=0.9",
        "camera.fov_degrees=30.3",
    ] {
        let comparison = against_vtk("head", &[change]).expect("a phantom");
        assert!(UNLIT.objection(&comparison).is_some(), "{change} passed");
    }
}

#[test]
fn a_step_or_an_opacity_changed_by_one_percent_is_caught() {
    let opacity = "transfer_function.0.opacity_scale=1.01";
    for (name, change) in [("head-coarse", "integrate.march.step_voxels=2.02"), ("head", opacity)] {
        let comparison = against_vtk(name, &[change]).expect("a phantom");
        let rms = 255.0 * comparison.rms_all;
        assert!(rms > 0.05, "{name}, {change}: RMS {rms:.4}/255, where 0.005 is what agreement comes to");
    }
}
