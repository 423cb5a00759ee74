//! Cameras: views by the patient's axes, and framing.

use glam::{DQuat, DVec3};

use crate::error::Result;
use crate::scene::{Camera, Projection};
use crate::spec::{CameraSpec, ProjectionName, Spec, ViewName, ViewsSpec};
use crate::volume::Grid;

/// What a fitted picture leaves around the volume's corners, as a factor.
const MARGIN: f64 = 1.05;

/// Size of a picture, unless told.
const DEFAULT_SIZE: [u32; 2] = [1024, 1024];

/// Vertical field of view, degrees, unless told.
const DEFAULT_FOV_DEGREES: f64 = 30.0;

/// The camera of a view.
pub(super) fn resolve(spec: &Spec, grid: &Grid, view: usize) -> Result<Camera> {
    let shared = spec.pipeline.camera.clone().unwrap_or_default();
    let views = spec.pipeline.views.as_ref();
    let written = views.map_or_else(|| shared.clone(), |views| views.camera(&shared, view));
    let size = spec.pipeline.image.as_ref().and_then(|image| image.size).unwrap_or(DEFAULT_SIZE);
    let size = size.map(|n| n as usize);
    match (written.position_mm, written.target_mm) {
        (Some(position), Some(target)) => placed(spec, &written, position.into(), target.into(), size),
        _ => {
            let reach_mm = match views {
                // The patient turns, and comes no nearer.
                Some(turntable @ ViewsSpec::Turntable(_)) => (0..turntable.count())
                    .map(|view| reach_mm(&turntable.camera(&shared, view), grid, size))
                    .fold(0.0, f64::max),
                _ => reach_mm(&written, grid, size),
            };
            fitted(&written, reach_mm, grid, size)
        }
    }
}

/// A camera by position and target; the spec has seen to it that they differ.
fn placed(spec: &Spec, written: &CameraSpec, position: DVec3, target: DVec3, size: [usize; 2]) -> Result<Camera> {
    let towards_eye = (position - target).normalize();
    let up = DVec3::from_array(written.up.unwrap_or([0.0, 0.0, 1.0])).normalize_or_zero();
    if towards_eye.cross(up).length() < 1e-9 {
        return Err(spec
            .error("camera.up", "the camera's up is along its line of sight")
            .found(format!("up {up}, line of sight {}", -towards_eye))
            .remedy("give an up direction across the line of sight, such as [0, -1, 0], towards the front"));
    }
    let projection = match written.projection {
        Some(ProjectionName::Parallel) => Projection::Parallel { height_mm: written.height_mm.unwrap_or(0.0) },
        _ => Projection::Perspective { fov_degrees: written.fov_degrees.unwrap_or(DEFAULT_FOV_DEGREES) },
    };
    Camera::look_at(position, target, rolled(up, towards_eye, written.roll), projection, size)
}

/// What shows all of the volume: the distance of a perspective camera, or half the height of a parallel picture, mm.
fn reach_mm(written: &CameraSpec, grid: &Grid, size: [usize; 2]) -> f64 {
    let aspect = size[0] as f64 / size[1] as f64;
    // Half the height of a picture, in the plane of the corner, that just shows it.
    let half_height = |c: &DVec3| c.y.abs().max(c.x.abs() / aspect);
    let largest = |f: &dyn Fn(&DVec3) -> f64| seen_corners_mm(written, grid).iter().map(f).fold(0.0, f64::max);
    match written.projection.unwrap_or(ProjectionName::Perspective) {
        ProjectionName::Perspective => largest(&|c| c.z + MARGIN * half_height(c) / slope(written)),
        ProjectionName::Parallel => MARGIN * largest(&half_height),
    }
}

/// The volume's corners from its centre: to the right of the picture, upwards and towards the eye, mm.
fn seen_corners_mm(written: &CameraSpec, grid: &Grid) -> [DVec3; 8] {
    let (towards_eye, up) = turned(written);
    let (right, center) = ((-towards_eye).cross(up), grid.center_mm());
    grid.corners_mm().map(|corner| {
        let c = corner - center;
        DVec3::new(c.dot(right), c.dot(up), c.dot(towards_eye))
    })
}

/// Tangent of half the field of view.
fn slope(written: &CameraSpec) -> f64 {
    (0.5 * written.fov_degrees.unwrap_or(DEFAULT_FOV_DEGREES)).to_radians().tan()
}

/// A camera by view and angles, as far away as or with the height that `reach_mm` says.
fn fitted(written: &CameraSpec, reach_mm: f64, grid: &Grid, size: [usize; 2]) -> Result<Camera> {
    let (towards_eye, up) = turned(written);
    let center = grid.center_mm();
    let zoom = written.zoom.unwrap_or(1.0);
    let (distance, projection) = match written.projection.unwrap_or(ProjectionName::Perspective) {
        ProjectionName::Perspective => {
            // Magnified about the centre without moving the eye, so that the perspective stays the same.
            let fov_degrees = 2.0 * (slope(written) / zoom).atan().to_degrees();
            (reach_mm, Projection::Perspective { fov_degrees })
        }
        ProjectionName::Parallel => {
            let height_mm = written.height_mm.unwrap_or(2.0 * reach_mm / zoom);
            // Anywhere outside the volume.
            let farthest = seen_corners_mm(written, grid).iter().map(|c| c.length()).fold(0.0, f64::max);
            (2.0 * farthest, Projection::Parallel { height_mm })
        }
    };
    Camera::look_at(center + distance * towards_eye, center, up, projection, size)
}

/// Unit vectors towards the eye and upwards, by view and angles.
fn turned(written: &CameraSpec) -> (DVec3, DVec3) {
    // LPS: x to the patient's left, y to the back, z to the head.
    let (eye, up) = match written.view.unwrap_or(ViewName::Anterior) {
        ViewName::Anterior => (DVec3::NEG_Y, DVec3::Z),
        ViewName::Posterior => (DVec3::Y, DVec3::Z),
        ViewName::Left => (DVec3::X, DVec3::Z),
        ViewName::Right => (DVec3::NEG_X, DVec3::Z),
        ViewName::Superior => (DVec3::Z, DVec3::NEG_Y),
        ViewName::Inferior => (DVec3::NEG_Z, DVec3::NEG_Y),
    };
    let radians = |degrees: Option<f64>| degrees.unwrap_or(0.0).to_radians();
    let (sin, cos) = radians(written.elevation).sin_cos();
    let (eye, up) = (cos * eye + sin * up, cos * up - sin * eye);
    let azimuth = DQuat::from_rotation_z(radians(written.azimuth));
    let (eye, up) = (azimuth * eye, azimuth * up);
    (eye, rolled(up, eye, written.roll))
}

/// The picture turns clockwise when the camera turns the other way.
fn rolled(up: DVec3, towards_eye: DVec3, roll_degrees: Option<f64>) -> DVec3 {
    DQuat::from_axis_angle(towards_eye, roll_degrees.unwrap_or(0.0).to_radians()) * up
}
