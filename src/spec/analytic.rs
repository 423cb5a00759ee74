//! A volume by formula.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::PerAxis;

/// A formula sampled on a lattice along the patient's axes, centred at the origin: its resolution by `size` and exactly
/// one of `spacing_mm` and `extent_mm`. With `planes_mm` these are of x and y alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnalyticSpec {
    /// The formula, of the position in mm (LPS).
    pub field: FieldSpec,
    /// Voxels along x, y and z: one number for all, or three; each from 1 to 4096.
    pub size: PerAxis<u32>,
    /// Distance between voxels, mm: one number, or three.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing_mm: Option<PerAxis<f64>>,
    /// Distance between the first and the last voxel, mm: one number, or three. Thickness along an axis of one voxel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extent_mm: Option<PerAxis<f64>>,
    /// Positions of the slices along z in ascending order, mm, at any distances: a rectilinear lattice.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 2, max = 4096))]
    pub planes_mm: Option<Vec<f64>>,
}

/// A scalar field by formula; positions are LPS mm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum FieldSpec {
    /// A ball about the origin: the value rises with the depth beneath its surface.
    Sphere(SphereSpec),
    /// A ring about the z axis: the value rises with the depth beneath its surface.
    Torus(TorusSpec),
    /// A linear field.
    Ramp(RampSpec),
    /// The test signal of Marschner and Lobb (1994), values 0 to 1; meant for 40 x 40 x 40 voxels over 2 units.
    MarschnerLobb(MarschnerLobbSpec),
    /// Arithmetic in x, y and z, such as `100 - hypot(x, y)^2`: numbers, `+ - * / ^`, parentheses, `pi`, `e`, and `abs`,
    /// `sqrt`, `cbrt`, `exp`, `ln`, `log10`, `sin`, `cos`, `tan`, `asin`, `acos`, `atan`, `sinh`, `cosh`, `tanh`,
    /// `floor`, `ceil`, `round` of one, `min`, `max`, `hypot`, `atan2`, `mod` of two numbers. Angles are in radians.
    Expression(String),
}

/// A ball about the origin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SphereSpec {
    /// Radius, mm; above 0.
    pub radius_mm: f64,
    /// Value on the surface; 0 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface_value: Option<f64>,
    /// Rise of the value per mm of depth; 1 by default, so that the value is the depth in mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value_per_mm: Option<f64>,
}

/// A ring about the z axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TorusSpec {
    /// Radius of the circle in the middle of the tube, mm; above 0.
    pub major_radius_mm: f64,
    /// Radius of the tube, mm; above 0.
    pub minor_radius_mm: f64,
    /// Value on the surface; 0 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface_value: Option<f64>,
    /// Rise of the value per mm of depth; 1 by default, so that the value is the depth in mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value_per_mm: Option<f64>,
}

/// A linear field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RampSpec {
    /// Gradient along x, y and z, values per mm.
    pub gradient_per_mm: [f64; 3],
    /// Value at the origin; 0 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin_value: Option<f64>,
}

/// Settings of the test signal of Marschner and Lobb.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MarschnerLobbSpec {
    /// Length of one unit of the formula, mm; 1 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit_mm: Option<f64>,
    /// Frequency of the ripples, per unit; 6 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency: Option<f64>,
    /// Weight of the ripples; 1/4 by default, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alpha: Option<f64>,
}
