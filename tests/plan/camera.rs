//! Where the camera is, which way is up, and that all of the volume is in the picture.

use glam::{DAffine3, DMat3, DVec3};
use pellucid::plan::{Plan, VolumeInfo};
use pellucid::scene::{Camera, Projection};
use pellucid::volume::Grid;

use super::{plan, spec, volume};

const LEFT: DVec3 = DVec3::X;
const BACK: DVec3 = DVec3::Y;
const HEAD: DVec3 = DVec3::Z;

fn near(found: DVec3, expected: DVec3, what: &str) {
    assert!((found - expected).length() < 1e-9, "{what}: found {found}, expected {expected}");
}

fn camera(written: &str) -> Camera {
    plan(&format!("camera: {written}\n")).scene.camera
}

#[test]
fn views_are_those_of_the_clinic() {
    // View, direction of sight, what is on the viewer's right, what is up.
    let views = [
        ("anterior", BACK, LEFT, HEAD),
        ("posterior", -BACK, -LEFT, HEAD),
        ("left", -LEFT, BACK, HEAD),
        ("right", LEFT, -BACK, HEAD),
        ("superior", -HEAD, -LEFT, -BACK),
        ("inferior", HEAD, LEFT, -BACK),
    ];
    for (view, forward, right, up) in views {
        let camera = camera(&format!("{{ view: {view} }}"));
        near(camera.forward(), forward, &format!("{view}, forward"));
        near(camera.right(), right, &format!("{view}, right"));
        near(camera.up(), up, &format!("{view}, up"));
    }
    near(camera("{}").forward(), BACK, "the default is anterior");
}

#[test]
fn angles_turn_as_documented() {
    near(camera("{ azimuth: 90 }").forward(), -LEFT, "from the front, azimuth goes to the patient's left");
    near(camera("{ view: posterior, azimuth: 90 }").forward(), LEFT, "from the back, to the patient's right");
    near(camera("{ view: left, azimuth: -90 }").forward(), BACK, "and back");
    let above = camera("{ elevation: 90 }");
    near(above.forward(), -HEAD, "elevation goes to the head");
    near(above.up(), BACK, "and takes the frame along, also over the pole");
    let rolled = camera("{ roll: 90 }");
    near(rolled.forward(), BACK, "roll does not move the camera");
    near(rolled.right(), HEAD, "what was up is on the right: clockwise");
    let both = camera("{ elevation: 30, azimuth: 90 }");
    let (sin, cos) = 30f64.to_radians().sin_cos();
    near(both.forward(), -(cos * LEFT + sin * HEAD), "first elevation, then azimuth about the patient's axis");
}

/// Largest distance of a corner of the volume from the centre of the picture, in halves of the picture's size.
fn extent(camera: &Camera, grid: &Grid) -> f64 {
    let [width, height] = camera.size().map(|n| n as f64);
    let corner_extent = |corner: DVec3| {
        let c = corner - camera.position_mm();
        let depth = c.dot(camera.forward());
        assert!(depth > 0.0, "a corner {corner} lies behind the camera");
        let half_height = match camera.projection() {
            Projection::Perspective { fov_degrees } => depth * (0.5 * fov_degrees).to_radians().tan(),
            Projection::Parallel { height_mm } => 0.5 * height_mm,
        };
        let (x, y) = (c.dot(camera.right()).abs(), c.dot(camera.up()).abs());
        (y / half_height).max(x / (half_height * width / height))
    };
    grid.corners_mm().into_iter().map(corner_extent).fold(0.0, f64::max)
}

fn framed(written: &str, grid: Grid) -> f64 {
    let text = format!("camera: {written}\nimage: {{ size: [300, 200] }}\n");
    let plan = Plan::new(&spec(&text), &VolumeInfo { grid, ..volume() }, None).unwrap();
    extent(&plan.scene.camera, &grid)
}

#[test]
fn a_fitted_picture_shows_every_corner_and_little_more() {
    let shear = DMat3::from_cols(DVec3::new(0.5, 0.1, 0.0), DVec3::new(0.0, -0.6, 0.2), DVec3::new(0.1, 0.5, -3.0));
    let grids = [
        volume().grid,
        Grid::axis_aligned([1, 500, 20], DVec3::ONE).unwrap(),
        Grid::axis_aligned([1, 1, 1], DVec3::splat(0.1)).unwrap(),
        Grid::new([64, 64, 30], DAffine3::from_mat3_translation(shear, DVec3::new(-200.0, 90.0, 1e4))).unwrap(),
    ];
    for grid in grids {
        for view in ["anterior", "left", "superior"] {
            for angles in ["", ", azimuth: 33, elevation: 20, roll: 10"] {
                for projection in ["projection: parallel", "fov_degrees: 10", "fov_degrees: 30", "fov_degrees: 120"] {
                    let written = format!("{{ view: {view}{angles}, fit: volume, {projection} }}");
                    let extent = framed(&written, grid);
                    let expected = 1.0 / 1.05;
                    assert!(
                        extent <= 1.0 && (extent - expected).abs() < 0.05,
                        "{:?} {written}: a corner at {extent} of the half picture, expected {expected}",
                        grid.dims()
                    );
                }
            }
        }
    }
}

#[test]
fn zoom_magnifies_and_can_lose_corners() {
    for projection in ["perspective", "parallel"] {
        let fitted = framed(&format!("{{ projection: {projection} }}"), volume().grid);
        let zoomed = framed(&format!("{{ projection: {projection}, zoom: 2 }}"), volume().grid);
        assert!((zoomed - 2.0 * fitted).abs() < 1e-9, "{projection}: found {zoomed}, expected twice {fitted}");
        assert!(zoomed > 1.0, "the comparison above can fail");
    }
}

#[test]
fn a_placed_camera_is_where_it_is_put() {
    let camera = camera("{ position_mm: [10, -400, 20], target_mm: [10, 0, 20], fov_degrees: 25, roll: 90 }");
    near(camera.position_mm(), DVec3::new(10.0, -400.0, 20.0), "position");
    near(camera.forward(), BACK, "forward");
    near(camera.right(), HEAD, "rolled");
    assert_eq!(camera.projection(), Projection::Perspective { fov_degrees: 25.0 });
    assert_eq!(camera.size(), [1024, 1024]);
    let above = super::spec("camera: { position_mm: [0, 0, 400], target_mm: [0, 0, 0] }\n");
    let error = Plan::new(&above, &volume(), None).unwrap_err().to_string();
    assert!(error.contains("up is along its line of sight") && error.contains("[0, -1, 0]"), "found {error}");
}

#[test]
fn a_parallel_camera_may_have_its_own_height() {
    let camera = camera("{ projection: parallel, height_mm: 123 }");
    assert_eq!(camera.projection(), Projection::Parallel { height_mm: 123.0 });
}
