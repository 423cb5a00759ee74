//! Levoy's depth cue.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Dims the lit terms of shading with distance, by `1/(constant + per_mm d)`; see [`crate::scene::DepthCue`].
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DepthCueSpec {
    /// Levoy's k₁; 1 by default, which leaves light at the camera as it is. Above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub constant: Option<f64>,
    /// Levoy's k₂, per mm from the picture plane, at least 0.
    #[schemars(range(min = 0))]
    pub per_mm: f64,
}
