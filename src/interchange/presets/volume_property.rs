//! What the formats have in common.

use super::function::Function;

/// A volume property of VTK, as far as a file holds one.
#[derive(Debug, Clone, PartialEq)]
pub struct VolumeProperty {
    /// What the file calls it; the file's name without its suffix where it has no name.
    pub name: String,
    /// α(v), opacity of one unit distance.
    pub scalar_opacity: Function<1>,
    /// α_g(g), factor by VTK's gradient magnitude; `None` where there is none or it is switched off.
    pub gradient_opacity: Option<Function<1>>,
    /// Colour over the value, sRGB numbers.
    pub color: Function<3>,
    /// Unit distance, mm, where the file says one; VTK's default is 1.
    pub unit_distance_mm: Option<f64>,
    /// Shading, if it is on and the file says how; a preset has none, its pipeline has.
    pub shading: Option<Phong>,
}

/// Coefficients of shading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phong {
    /// Share of light from everywhere.
    pub ambient: f64,
    /// Share of light reflected evenly.
    pub diffuse: f64,
    /// Share of light in highlights.
    pub specular: f64,
    /// Exponent of highlights.
    pub shininess: f64,
}
