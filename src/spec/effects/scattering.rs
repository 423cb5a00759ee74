//! Single scattering.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::LightSpec;

/// Light scattered once, by the phase function of Henyey and Greenstein; see [`crate::scene::Scattering`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScatteringSpec {
    /// Share of the extinction that scatters; the rest absorbs. 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub albedo: f64,
    /// Mean cosine of the angle by which light turns, between -1 (back) and 1 (on); 0 by default, evenly to all sides.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -1, max = 1))]
    pub anisotropy: Option<f64>,
    /// Directional lights; those of shading by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub lights: Option<Vec<LightSpec>>,
}
