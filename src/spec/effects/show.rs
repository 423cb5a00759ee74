//! Pictures that are not of light.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::spec::Color;

/// One number of the values along each ray, as a grey; see [`crate::scene::ValueModel`] for its definition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProjectSpec {
    /// Which number.
    pub show: ProjectionOf,
    /// Values shown black and white, HU, the lower first; the window of `normalise` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window_hu: Option<[f64; 2]>,
}

/// A number of the values along a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProjectionOf {
    /// The largest: maximum intensity projection.
    Maximum,
    /// The smallest: minimum intensity projection.
    Minimum,
    /// The mean over the length in the volume.
    Mean,
}

/// A level surface; see [`crate::scene::Surface`] for its definition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceSpec {
    /// The level, HU.
    pub hu: f64,
    /// Opacity of one crossing; 1 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub opacity: Option<f64>,
    /// Its colour; white by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
}
