//! Integrators as written.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the volume rendering integral is computed. A name alone takes all its defaults.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum IntegrateSpec {
    /// Within a tolerance, without a step size.
    Exact(ExactSpec),
    /// Fixed steps, as the textbooks and VTK do it.
    March(MarchSpec),
    /// The oracle in f64, for every pixel: slow.
    Reference,
    /// The quickest setting that keeps a tolerance, or the most accurate one within a time, as measured on this scene and
    /// this machine.
    Auto(AutoSpec),
}

/// What the chosen setting must keep: one of the two.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AutoSpec {
    /// Largest error of a channel of a pixel, linear and premultiplied; above 0 and below 1. 1/255 by default. Kept by the
    /// setting's bound, or, where it has none, kept to half on random pixels. Not together with `budget_ms`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Time for integrating the picture, ms, above 0. Not together with `tolerance`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub budget_ms: Option<f64>,
}

/// Settings of the exact integrator.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExactSpec {
    /// Largest error of a channel of a pixel, linear and premultiplied; 1/255 by default, above 0 and below 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// What is known of the error of shaded pixels; `estimated` by default. It changes nothing where nothing is shaded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bound: Option<BoundName>,
}

/// What is known of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BoundName {
    /// What shading may miss between the nodes of pieces is estimated, with a margin of four standard deviations.
    Estimated,
    /// Every part of it is proven, which takes several times as long.
    Proven,
}

/// Settings of the marching integrator.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MarchSpec {
    /// Distance between samples, mm, above 0. Not together with `step_voxels`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_mm: Option<f64>,
    /// Distance between samples in units of the smallest spacing, above 0; 0.5 by default. Not together with `step_mm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_voxels: Option<f64>,
    /// Where in an interval its sample lies; `midpoint` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rule: Option<RuleName>,
    /// For surfaces: how often the interval in which one is crossed is halved before the crossing is interpolated; 0 by
    /// default, at most 32.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 32))]
    pub bisections: Option<u32>,
    /// Direction of compositing; `front-to-back` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<OrderName>,
    /// Colour as it is composited; `associated` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colors: Option<ColorsName>,
    /// What a sample's emission is measured by; `per-length` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emission: Option<EmissionName>,
    /// Where the intervals of neighbouring rays lie; `per-ray` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lattice: Option<LatticeName>,
    /// Offset of the lattice per pixel; none by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jitter: Option<JitterSpec>,
    /// A front-to-back ray stops where less than this transmittance is left; 0, never, by default. Below 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub termination_transmittance: Option<f64>,
    /// Look the transfer function up in a table, as renderers on graphics hardware do; by default it is evaluated as it is
    /// defined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<TableSpec>,
    /// The model of the highlight and of the lights; `blinn-phong`, the definition, by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reflection: Option<ReflectionName>,
    /// Defaults of the keys above as another program has them, for comparison; our own by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compatibility: Option<CompatibilityName>,
}

/// A transfer function as a table over the range of the volume's own values and gradient magnitudes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TableSpec {
    /// Entries along the value axis; 4096 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2, max = 65536))]
    pub values: Option<u32>,
    /// Entries along the gradient axis of a transfer function that has one; 1024 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2, max = 65536))]
    pub gradients: Option<u32>,
    /// Opacities of 1 mm that are at most this are taken for those of a step, whatever its length, where the transfer
    /// function is one of the value alone; 0 by default, 1e-4 with `compatibility: vtk`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub uncorrected_opacity: Option<f64>,
}

/// A program whose conventions are taken over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CompatibilityName {
    /// VTK's GPU mapper: `rule: whole-steps`, `table: {}` with opacities of up to 1e-4 left uncorrected, `reflection:
    /// vtk-phong`, and `termination_transmittance: 1/255`.
    Vtk,
}

/// The model of the highlight and of the lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ReflectionName {
    /// The definition.
    BlinnPhong,
    /// As VTK's GPU mapper does it: Phong's highlight, no soft fade, a headlight that is a light from the eye only if it is
    /// the only one, no ambient light with any other.
    VtkPhong,
}

/// Offset of the sample lattice per pixel, the same for any number of threads.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JitterSpec {
    /// Seed; 0 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Distribution over the picture; `white` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kind: Option<JitterKindName>,
}

/// Where in an interval its sample lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RuleName {
    /// At its start: first order.
    Left,
    /// In its middle: second order.
    Midpoint,
    /// At both ends, averaged: second order.
    Trapezoid,
    /// At the end of each whole step, the rest of the ray left out: first order, as VTK does without jitter. Surfaces are
    /// then shown at the first sample behind them, and clipping ends where VTK's does.
    WholeSteps,
}

/// Direction of compositing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OrderName {
    /// From the eye.
    FrontToBack,
    /// Towards the eye.
    BackToFront,
}

/// Colour as it is composited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ColorsName {
    /// Multiplied by opacity.
    Associated,
    /// Divided out and multiplied in again.
    Straight,
}

/// What a sample's emission is measured by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EmissionName {
    /// By length, independent of the step.
    PerLength,
    /// By sample, as renderers without colour correction do.
    PerSample,
}

/// Where the intervals of neighbouring rays lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LatticeName {
    /// From each ray's own entry into the volume.
    PerRay,
    /// On planes across the line of sight.
    ViewPlanes,
}

/// Distribution of the offsets over the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JitterKindName {
    /// Independent per pixel.
    White,
    /// Spread evenly over neighbouring pixels.
    LowDiscrepancy,
}
