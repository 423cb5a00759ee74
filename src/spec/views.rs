//! Several views as written.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::CameraSpec;

/// Pictures from several sides with one set-up: one file per view, named as the picture with `-1`, `-2` and so on before its
/// suffix.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ViewsSpec {
    /// From these cameras. What one leaves out is as in `camera`; one with `position_mm` takes nothing from there.
    Cameras(#[schemars(length(min = 1, max = 10_000))] Vec<CameraSpec>),
    /// All around the patient, from `camera` on.
    Turntable(TurntableSpec),
}

/// Equal turns about the axis from feet to head, at a distance from which each picture shows all of the volume.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TurntableSpec {
    /// How many pictures; 36 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 10_000))]
    pub pictures: Option<u32>,
    /// Degrees from the first picture to the one that would follow the last; 360 by default, and negative for the other way
    /// round. From the front, positive goes to the patient's left.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degrees: Option<f64>,
}

/// Pictures of a turntable, unless told.
const DEFAULT_PICTURES: u32 = 36;

impl ViewsSpec {
    /// How many there are.
    pub fn count(&self) -> usize {
        match self {
            ViewsSpec::Cameras(cameras) => cameras.len(),
            ViewsSpec::Turntable(turntable) => turntable.pictures.unwrap_or(DEFAULT_PICTURES) as usize,
        }
    }

    /// A view's camera, of which `camera` is what they share.
    pub fn camera(&self, camera: &CameraSpec, view: usize) -> CameraSpec {
        match self {
            ViewsSpec::Cameras(cameras) => cameras[view].over(camera),
            ViewsSpec::Turntable(turntable) => {
                let turned = turntable.degrees.unwrap_or(360.0) * view as f64 / self.count() as f64;
                CameraSpec { azimuth: Some(camera.azimuth.unwrap_or(0.0) + turned), ..camera.clone() }
            }
        }
    }
}

impl CameraSpec {
    /// This camera, with the keys of another where it has none.
    fn over(&self, shared: &CameraSpec) -> CameraSpec {
        if self.position_mm.is_some() {
            return self.clone();
        }
        CameraSpec {
            view: self.view.or(shared.view),
            azimuth: self.azimuth.or(shared.azimuth),
            elevation: self.elevation.or(shared.elevation),
            roll: self.roll.or(shared.roll),
            zoom: self.zoom.or(shared.zoom),
            projection: self.projection.or(shared.projection),
            fov_degrees: self.fov_degrees.or(shared.fov_degrees),
            fit: self.fit.or(shared.fit),
            position_mm: shared.position_mm,
            target_mm: self.target_mm.or(shared.target_mm),
            up: self.up.or(shared.up),
            height_mm: self.height_mm.or(shared.height_mm),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::ViewName;

    #[test]
    fn views_of_a_turntable_go_on_from_the_camera() {
        let camera = CameraSpec { azimuth: Some(10.0), elevation: Some(20.0), ..CameraSpec::default() };
        let turntable = ViewsSpec::Turntable(TurntableSpec { pictures: Some(4), degrees: None });
        let azimuths: Vec<_> = (0..turntable.count()).map(|v| turntable.camera(&camera, v).azimuth).collect();
        assert_eq!(azimuths, [10.0, 100.0, 190.0, 280.0].map(Some));
        assert_eq!(turntable.camera(&camera, 3).elevation, Some(20.0));
    }

    #[test]
    fn a_view_takes_from_the_camera_what_it_leaves_out_and_nothing_if_it_is_placed() {
        let shared = CameraSpec { view: Some(ViewName::Left), zoom: Some(2.0), ..CameraSpec::default() };
        let back = CameraSpec { view: Some(ViewName::Posterior), ..CameraSpec::default() };
        let placed = CameraSpec { position_mm: Some([0.0; 3]), ..CameraSpec::default() };
        let views = ViewsSpec::Cameras(vec![back, placed.clone()]);
        let found = views.camera(&shared, 0);
        assert_eq!((found.view, found.zoom), (Some(ViewName::Posterior), Some(2.0)));
        assert_eq!(views.camera(&shared, 1), placed);
    }
}
