//! The camera as written: a view of the patient, or a position and a target.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// From where. Either a named `view` with angles, framed by `fit`, or `position_mm` and `target_mm`.
///
/// **Angles.** The named view is turned as one rigid frame, in this order: `elevation` moves the camera towards the top
/// of the view's picture (the patient's head in the four level views); `azimuth` turns it about the axis from feet to
/// head, counter-clockwise as seen from above the head, so that from `anterior` a positive azimuth moves the camera
/// towards the patient's **left**; `roll` turns the picture clockwise.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraSpec {
    /// Side of the patient that the camera is on; `anterior` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<ViewName>,
    /// Degrees about the axis from feet to head; from the front, positive goes to the patient's left.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub azimuth: Option<f64>,
    /// Degrees towards the top of the view's picture, the head in level views.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevation: Option<f64>,
    /// Degrees by which the picture is turned clockwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll: Option<f64>,
    /// Magnifies the fitted picture about its centre; 1 by default, above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zoom: Option<f64>,
    /// How rays spread; `perspective` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub projection: Option<ProjectionName>,
    /// Vertical field of view of a perspective camera, degrees, above 0 and below 180; 30 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov_degrees: Option<f64>,
    /// What a named view frames: `volume`, the default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fit: Option<Fit>,
    /// Position, LPS mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_mm: Option<[f64; 3]>,
    /// Point in the middle of the picture, LPS mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_mm: Option<[f64; 3]>,
    /// Direction that is up in the picture, LPS; `[0, 0, 1]`, towards the head, by default. Goes with `position_mm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up: Option<[f64; 3]>,
    /// Height of a parallel picture in the patient, mm; fitted by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_mm: Option<f64>,
}

/// Side of the patient that the camera is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ViewName {
    /// The front; the patient's left is on the viewer's right, the head is up.
    Anterior,
    /// The back; the head is up.
    Posterior,
    /// The patient's left; the head is up.
    Left,
    /// The patient's right; the head is up.
    Right,
    /// Above the head; the front is up.
    Superior,
    /// Below the feet; the front is up, as in axial slices.
    Inferior,
}

/// How rays spread from the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProjectionName {
    /// Through one point.
    Perspective,
    /// Parallel to each other.
    Parallel,
}

/// What a named view frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fit {
    /// All eight corners of the volume, with a small margin.
    Volume,
}
