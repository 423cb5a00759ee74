//! Fog as OpenGL defines it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::spec::Color;

/// Fog that replaces colours with its own as they are farther away: exactly one of `linear`, `exp` and `exp2`; see
/// [`crate::scene::Fog`].
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FogSpec {
    /// Thickens evenly between two distances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub linear: Option<LinearFogSpec>,
    /// Leaves `exp(−density z)` of a colour at a distance z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exp: Option<ExpFogSpec>,
    /// Leaves `exp(−(density z)²)` of a colour at a distance z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exp2: Option<ExpFogSpec>,
    /// Its colour; that of the background by default, black where it is transparent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
}

/// Fog that thickens evenly.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearFogSpec {
    /// Distance from the eye at which it begins, mm; from the camera's plane where rays are parallel.
    pub start_mm: f64,
    /// Distance at which nothing but fog is left, mm; beyond `start_mm`.
    pub end_mm: f64,
}

/// Fog of one density.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpFogSpec {
    /// Density, 1/mm, at least 0.
    #[schemars(range(min = 0))]
    pub density_per_mm: f64,
}
