//! Effects as written: what a scene asks for beyond emission and absorption.

mod clip;
mod depth_cue;
mod fog;
mod haze;
mod mask;
mod scattering;
mod shading;
mod shadows;
mod show;

pub use clip::{ClipBoxSpec, ClipPlaneSpec, ClipSpec, RangeSpec, TrimSpec};
pub use depth_cue::DepthCueSpec;
pub use fog::{ExpFogSpec, FogSpec, LinearFogSpec};
pub use haze::HazeSpec;
pub use mask::{LabelSpec, MaskPhantom, MaskSpec, OtherLabels};
pub use scattering::ScatteringSpec;
pub use shading::{LightSpec, ShadingSpec};
pub use shadows::ShadowsSpec;
pub use show::{ProjectSpec, ProjectionOf, SurfaceSpec, TransportName};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Effects; one that is not named is not computed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectsSpec {
    /// Shows a part of the volume only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip: Option<ClipSpec>,
    /// What of the transfer function shows; `both` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<TransportName>,
    /// Hides labels of a segmentation, or gives them a look of their own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mask: Option<MaskSpec>,
    /// Levoy's gradient shading with the Blinn-Phong reflection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shading: Option<ShadingSpec>,
    /// Levoy's depth cue: dims the lit terms of shading with distance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_cue: Option<DepthCueSpec>,
    /// Shadows that the volume casts on itself, towards the directional lights of shading.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shadows: Option<ShadowsSpec>,
    /// Light scattered once, from directional lights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scattering: Option<ScatteringSpec>,
    /// Fog as OpenGL defines it: colours fade to that of the fog with distance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fog: Option<FogSpec>,
    /// Fog as a medium that fills the space in front of the volume, in it and behind it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub haze: Option<HazeSpec>,
    /// Where the transfer function is evaluated; `samples` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub classify: Option<ClassifyAtName>,
    /// Shows one number of what lies along each ray as a grey, instead of light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub project: Option<ProjectSpec>,
    /// Shows level surfaces, instead of light.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub surfaces: Option<Vec<SurfaceSpec>>,
}

/// Where the transfer function is evaluated; see [`crate::scene::ClassifyAt`] for its definition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ClassifyAtName {
    /// At each point of a ray, from the interpolated value and gradient magnitude.
    Samples,
    /// At the voxels, shaded there too, as Levoy did; extinction and emission are interpolated.
    Voxels,
}
