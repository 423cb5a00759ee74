//! Pictures that are not of light.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::spec::Color;

/// One number of what lies along each ray, as a grey; see [`crate::scene::ValueModel`] for its definition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProjectSpec {
    /// Which number.
    pub show: ProjectionOf,
    /// Values shown black and white, HU, the lower first; the window of `normalise` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window_hu: Option<[f64; 2]>,
    /// Sums shown black and white, HU mm, the lower first; needed with `sum`, and for it only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window_hu_mm: Option<[f64; 2]>,
    /// Optical depths shown black and white, dimensionless, the lower first; needed with `optical-depth`, and for it only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window_optical_depth: Option<[f64; 2]>,
    /// The least value that counts as a local maximum, HU; needed with `local-maximum`, and for it only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threshold_hu: Option<f64>,
}

/// A number of what lies along a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProjectionOf {
    /// The largest: maximum intensity projection.
    Maximum,
    /// The smallest: minimum intensity projection.
    Minimum,
    /// The mean over the length in the volume.
    Mean,
    /// The integral over the length in the volume, HU mm.
    Sum,
    /// The first local maximum of at least `threshold_hu`, or the largest value if there is none.
    LocalMaximum,
    /// The optical depth of the transfer function, as a radiograph measures it.
    OpticalDepth,
}

/// What of the transfer function shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TransportName {
    /// Absorption alone: the light that the volume transmits of what is behind it.
    Absorption,
    /// Emission alone: light adds up, and nothing hides anything.
    Emission,
    /// Emission and absorption.
    Both,
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
