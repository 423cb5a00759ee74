//! How the volume rendering integral is computed: settings of the integrators, all resolved.

use serde::Serialize;

/// An integrator with its settings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Within a tolerance, without a step size.
    Exact(Exact),
    /// Fixed steps, as the textbooks and VTK do it.
    March(March),
    /// The oracle, for every pixel: slow.
    Reference,
}

/// Settings of the exact integrator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Exact {
    /// Largest error of a channel of a pixel (linear, premultiplied), above 0.
    pub tolerance: f64,
    /// What is known of the error of what is shaded.
    pub bound: Bound,
}

impl Exact {
    /// The defaults for a tolerance.
    pub fn within(tolerance: f64) -> Self {
        Exact { tolerance, bound: Bound::default() }
    }
}

/// What the bound on the error of a shaded pixel is. Of pixels that are not shaded it is proven in any case.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// What shading may miss between the nodes of pieces is estimated, as a standard deviation, and counts four times.
    #[default]
    Estimated,
    /// All of it is proven, which takes several times as long.
    Proven,
}

/// Settings of the marching integrator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct March {
    /// Distance between samples, mm, above 0.
    pub step_mm: f64,
    /// Where in an interval its sample lies.
    pub rule: SampleRule,
    /// Direction of compositing.
    pub order: Order,
    /// What is averaged and stored per sample.
    pub colors: Colors,
    /// What a sample's emission is measured by.
    pub emission: Emission,
    /// Where the intervals of neighbouring rays lie.
    pub lattice: Lattice,
    /// How often an interval in which a surface is crossed is halved before the crossing is interpolated linearly.
    pub bisections: u32,
    /// Offset of the lattice per pixel; `None` for the same on all rays.
    pub jitter: Option<Jitter>,
    /// A front-to-back ray stops where less than this transmittance is left; 0 never.
    pub termination_transmittance: f64,
    /// The transfer function as a table; `None` evaluates it as it is defined.
    pub table: Option<Table>,
    /// The model of the highlight and of the lights.
    pub reflection: Reflection,
}

impl March {
    /// Plain settings: front to back, from each ray's entry, to its end, the transfer function as it is defined.
    pub const fn plain(rule: SampleRule, step_mm: f64) -> Self {
        March {
            step_mm,
            rule,
            order: Order::FrontToBack,
            colors: Colors::Associated,
            emission: Emission::PerLength,
            lattice: Lattice::PerRay,
            bisections: 0,
            jitter: None,
            termination_transmittance: 0.0,
            table: None,
            reflection: Reflection::BlinnPhong,
        }
    }
}

/// A transfer function sampled over the range of the volume's own values and gradient magnitudes, looked up as graphics
/// hardware looks up a texture: see [`crate::classify::Tabulated`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Table {
    /// Entries along the value axis, at least 2.
    pub values: usize,
    /// Entries along the gradient axis of a transfer function that has one, at least 2.
    pub gradients: usize,
    /// Opacities of 1 mm that are at most this are taken for those of a step, whatever its length; of transfer functions
    /// of the value alone.
    pub uncorrected_opacity: f64,
}

/// The model of the highlight and of the lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reflection {
    /// As [`crate::scene::Shading`] defines it.
    BlinnPhong,
    /// As VTK's GPU mapper does it: Phong's highlight about the mirrored light, no fade where the gradient vanishes.
    VtkPhong,
}
impl March {
    /// Whether samples are composited as for most pictures: front to back, one for an interval, in associated colours, emission by
    /// length, without a table.
    pub fn is_plain(&self) -> bool {
        self.rule != SampleRule::Trapezoid
            && self.order == Order::FrontToBack
            && (self.colors, self.emission) == (Colors::Associated, Emission::PerLength)
            && self.table.is_none()
    }
}

/// Where in an interval its sample lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SampleRule {
    /// At its start: first order.
    Left,
    /// In its middle: second order.
    Midpoint,
    /// At both ends, averaged: second order.
    Trapezoid,
    /// At the end of each whole step; what is left of the ray after the last whole step counts for nothing. At least one
    /// sample is taken, be the ray shorter than a step. VTK without jitter; first order.
    ///
    /// Surfaces are shown at the first sample behind them. Where the volume is clipped, samples are where VTK's GPU mapper
    /// has them: a step behind a plane that the ray enters by, up to one beyond a plane that it leaves by, and of what is
    /// cut off along the voxels' axes ([`super::Crop`]) those inside, half a voxel off at the border.
    WholeSteps,
}

/// Direction of compositing; the results differ by rounding only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// From the eye, with early termination.
    FrontToBack,
    /// Towards the eye, by the *over* operator.
    BackToFront,
}

/// Colour as it is composited; the results differ by rounding only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Colors {
    /// Multiplied by opacity.
    Associated,
    /// Divided out and multiplied in again by the compositor.
    Straight,
}

/// What a sample's emission is measured by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Emission {
    /// By length: `(1 − e^{−σΔ}) q/σ`, or `qΔ` where nothing absorbs; independent of the step.
    PerLength,
    /// By sample: `q · 1 mm` once per sample whatever the step, as renderers without colour correction do.
    PerSample,
}

/// Where the intervals of neighbouring rays lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Lattice {
    /// From each ray's own entry into the volume.
    PerRay,
    /// On planes across the line of sight, as with slices for proxy geometry; the first and last interval are partial.
    ViewPlanes,
}

/// Offset of the sample lattice per pixel, by a counter-based hash of (seed, pixel): the same for any thread count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Jitter {
    /// Seed.
    pub seed: u64,
    /// Distribution over the picture.
    pub kind: JitterKind,
}

/// Distribution of the offsets over the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum JitterKind {
    /// Independent per pixel.
    White,
    /// Spread evenly over neighbouring pixels.
    LowDiscrepancy,
}
