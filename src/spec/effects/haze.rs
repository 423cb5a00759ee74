//! Fog as a medium.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::spec::Color;

/// A homogeneous medium from the eye to a distance behind the volume; see [`crate::scene::Haze`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HazeSpec {
    /// Its extinction, 1/mm, at least 0.
    #[schemars(range(min = 0))]
    pub extinction_per_mm: f64,
    /// The colour of endless haze; that of the background by default, black where it is transparent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    /// Distance from the eye at which it ends, mm; from the camera's plane where rays are parallel. By default that of the
    /// volume's farthest corner, and no less than that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end_mm: Option<f64>,
}
