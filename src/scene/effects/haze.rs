//! Fog as a medium.

/// A homogeneous medium that fills space from each ray's origin to a distance behind the volume.
///
/// **Definition.** It adds `σ_h` to the extinction and `σ_h C` to the emission, unshaded, from the ray's origin to `end_mm`,
/// inside the volume and outside of it. So a ray that meets nothing else shows `I₀T + C(1 − T)` with `T = e^{−σ_h end}`, the
/// closed form of a homogeneous medium, and what is seen through a length `z` of it is dimmed by `e^{−σ_h z}`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Haze {
    /// σ_h, 1/mm, above 0.
    pub extinction_per_mm: f64,
    /// C, the colour it has where nothing is seen through it, linear RGB.
    pub color: [f64; 3],
    /// Where it ends along each ray, mm; no point of the volume lies beyond.
    pub end_mm: f64,
}
