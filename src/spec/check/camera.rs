//! Checks on a camera: which keys go together.

use super::{Check, join};
use crate::error::Result;
use crate::spec::{CameraSpec, ProjectionName, ViewsSpec};

/// More than this many views are a mistake.
const MOST_VIEWS: usize = 10_000;

/// Checks views, of which `camera` is what they share.
pub(super) fn check_views(check: Check<'_>, camera: Option<&CameraSpec>, views: &ViewsSpec) -> Result<()> {
    let camera = camera.cloned().unwrap_or_default();
    let within = (1..=MOST_VIEWS).contains(&views.count());
    match views {
        ViewsSpec::Cameras(cameras) => {
            check.require("views.cameras", within, "1 to 10000 cameras")?;
            (0..cameras.len()).try_for_each(|view| {
                check_camera(check, &format!("views.cameras.{view}"), &views.camera(&camera, view))
            })
        }
        ViewsSpec::Turntable(_) => {
            check.require("views.turntable.pictures", within, "1 to 10000 pictures")?;
            let placed = camera.position_mm.is_some();
            check.unread("views.turntable", placed, "the camera is placed by position_mm and target_mm; give cameras")
        }
    }
}

/// Checks a camera written at `path`.
pub(super) fn check_camera(check: Check<'_>, path: &str, camera: &CameraSpec) -> Result<()> {
    let path = |key| join(path, key);
    let placed = camera.position_mm.is_some() || camera.target_mm.is_some();
    if placed {
        check.needed(&path("target_mm"), camera.target_mm.is_some(), "target_mm, which position_mm needs")?;
        check.needed(&path("position_mm"), camera.position_mm.is_some(), "position_mm, which target_mm needs")?;
        let why = "the camera is placed by position_mm and target_mm";
        let unread = [
            ("view", camera.view.is_some()),
            ("azimuth", camera.azimuth.is_some()),
            ("elevation", camera.elevation.is_some()),
            ("zoom", camera.zoom.is_some()),
            ("fit", camera.fit.is_some()),
        ];
        for (key, given) in unread {
            check.unread(&path(key), given, why)?;
        }
    } else {
        check.unread(&path("up"), camera.up.is_some(), "up goes with position_mm; a view has roll")?;
    }
    match camera.projection.unwrap_or(ProjectionName::Perspective) {
        ProjectionName::Perspective => {
            let why = "the height of a perspective picture follows from fov_degrees; it goes with projection: parallel";
            check.unread(&path("height_mm"), camera.height_mm.is_some(), why)?;
        }
        ProjectionName::Parallel => {
            let why = "parallel rays have no field of view";
            check.unread(&path("fov_degrees"), camera.fov_degrees.is_some(), why)?;
            let known = !placed || camera.height_mm.is_some();
            check.needed(&path("height_mm"), known, "height_mm, which a placed parallel camera needs")?;
            if camera.height_mm.is_some() {
                check.unread(&path("fit"), camera.fit.is_some(), "height_mm says how much the picture shows")?;
                check.unread(&path("zoom"), camera.zoom.is_some(), "height_mm says how much the picture shows")?;
            }
        }
    }
    check.above_zero(&path("zoom"), camera.zoom)?;
    check.above_zero(&path("height_mm"), camera.height_mm)?;
    let opening = camera.fov_degrees.is_none_or(|fov| fov > 0.0 && fov < 180.0);
    check.require(&path("fov_degrees"), opening, "an angle above 0 and below 180 degrees")?;
    let (position, target) = (camera.position_mm, camera.target_mm);
    check.require(&path("target_mm"), position.is_none() || position != target, "a point other than position_mm")?;
    let has_up = camera.up.is_none_or(|up| up.iter().any(|x| *x != 0.0));
    check.require(&path("up"), has_up, "a direction of any length but 0")
}
