//! Effects as written: what a scene asks for beyond emission and absorption.

mod shading;
mod show;

pub use shading::{LightSpec, ShadingSpec};
pub use show::{ProjectSpec, ProjectionOf, SurfaceSpec};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Effects; one that is not named is not computed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectsSpec {
    /// Levoy's gradient shading with the Blinn-Phong reflection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shading: Option<ShadingSpec>,
    /// Where the transfer function is evaluated; `samples` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub classify: Option<ClassifyAtName>,
    /// Shows one number of the values along each ray as a grey, instead of light.
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
