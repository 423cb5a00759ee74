//! Widgets as written: a shape over value and gradient magnitude, with optical properties.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// A widget: exactly one shape, and what it absorbs and emits. Positions are in HU and HU/mm.
///
/// What absorbs needs `color` and exactly one of `opacity_per_mm` and `extinction_per_mm`; `points` carries them, and its
/// emission, at its points instead. A widget may emit only.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Widget {
    /// 1 inside, 0 outside.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rectangle: Option<RectangleSpec>,
    /// Linear rise, plateau, linear fall, along each axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trapezoid: Option<TrapezoidSpec>,
    /// A wedge with its apex on the value axis, opening with the gradient magnitude.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub triangle: Option<TriangleSpec>,
    /// Levoy's isovalue contour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contour: Option<ContourSpec>,
    /// A smooth hill over an ellipse.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ellipse: Option<EllipseSpec>,
    /// A Gaussian along each axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gaussian: Option<GaussianSpec>,
    /// A curve over the value through points; extinction and extinction times colour are linear between them.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub points: Option<Vec<PointSpec>>,
    /// Factor by gradient magnitude, for `points` only: `[HU/mm, weight]` pairs, linear between them.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub gradient_weight: Option<Vec<[f64; 2]>>,
    /// Opacity of 1 mm where the shape is 1, from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub opacity_per_mm: Option<f64>,
    /// Extinction where the shape is 1, 1/mm, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub extinction_per_mm: Option<f64>,
    /// Colour of what absorbs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    /// Light of its own where the shape is 1, in addition to the light of what absorbs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emission_per_mm: Option<EmissionSpec>,
}

/// Light of a widget's own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EmissionSpec {
    /// Its colour.
    pub color: Color,
    /// Light added per mm, 1/mm, at least 0.
    #[schemars(range(min = 0))]
    pub strength: f64,
}

/// 1 inside, 0 outside.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RectangleSpec {
    /// Lowest and highest value, HU.
    pub hu: [f64; 2],
    /// Lowest and highest gradient magnitude, HU/mm; all by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradient_hu_per_mm: Option<[f64; 2]>,
}

/// Linear rise, plateau, linear fall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrapezoidSpec {
    /// Where it leaves 0, reaches 1, leaves 1 and reaches 0, HU, ascending; equal numbers make a step.
    pub hu: [f64; 4],
    /// The same along the gradient magnitude, HU/mm; 1 everywhere by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradient_hu_per_mm: Option<[f64; 4]>,
}

/// A wedge: 1 near the line `v = apex`, 0 from `|v - apex| = opening_mm · g`, for gradient magnitudes `g` in the range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TriangleSpec {
    /// Value of the apex, HU.
    pub apex_hu: f64,
    /// Half width in HU per HU/mm of gradient magnitude: the half thickness of a boundary, mm, above 0.
    pub opening_mm: f64,
    /// Share of the half width over which it falls from 1 to 0, above 0 and at most 1; 0.5 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edge: Option<f64>,
    /// Lowest (above 0) and highest gradient magnitude, HU/mm.
    pub gradient_hu_per_mm: [f64; 2],
    /// How far the rendered terms may be from this shape, of its height; 1/32 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_deviation: Option<f64>,
}

/// Levoy's isovalue contour: `1 - |v - hu| / (thickness_mm · g)` where that is above 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContourSpec {
    /// The isovalue, HU.
    pub hu: f64,
    /// Distance from the surface, mm, over which it falls from 1 to 0, above 0.
    pub thickness_mm: f64,
    /// Lowest (above 0) and highest gradient magnitude, HU/mm.
    pub gradient_hu_per_mm: [f64; 2],
    /// How far the rendered terms may be from this shape, of its height; 1/32 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_deviation: Option<f64>,
}

/// A smooth hill `(1 - ρ²)²`, `ρ² = ((v - hu)/hu_radius)² + ((g - gradient)/gradient_radius)²`, 0 outside the ellipse.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EllipseSpec {
    /// Value of the centre, HU.
    pub hu: f64,
    /// Half axis along the value, HU, above 0.
    pub hu_radius: f64,
    /// Gradient magnitude of the centre, HU/mm.
    pub gradient_hu_per_mm: f64,
    /// Half axis along the gradient magnitude, HU/mm, above 0.
    pub gradient_radius_hu_per_mm: f64,
    /// How far the rendered terms may be from this shape, of its height; 1/32 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_deviation: Option<f64>,
}

/// A Gaussian `exp(-(v - hu)²/2 hu_sigma² - (g - gradient)²/2 gradient_sigma²)`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GaussianSpec {
    /// Mean value, HU.
    pub hu: f64,
    /// Standard deviation, HU, above 0.
    pub hu_sigma: f64,
    /// Mean gradient magnitude, HU/mm; together with its standard deviation, or neither.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradient_hu_per_mm: Option<f64>,
    /// Standard deviation of the gradient magnitude, HU/mm, above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradient_sigma_hu_per_mm: Option<f64>,
    /// How far the rendered terms may be from this shape, of its height; 1/32 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_deviation: Option<f64>,
}

/// A point of a curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointSpec {
    /// Value, HU; two points at one value make a step.
    pub hu: f64,
    /// Opacity of 1 mm, from 0 to 1; exactly one of this and `extinction_per_mm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub opacity_per_mm: Option<f64>,
    /// Extinction, 1/mm, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub extinction_per_mm: Option<f64>,
    /// Colour; needed where the point absorbs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    /// Light of its own, in addition to the light of what absorbs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emission_per_mm: Option<EmissionSpec>,
}
