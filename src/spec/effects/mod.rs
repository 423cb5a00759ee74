//! Effects as written: what a scene asks for beyond emission and absorption.

mod clip;
mod mask;
mod shading;
mod show;

pub use clip::{ClipBoxSpec, ClipPlaneSpec, ClipSpec, RangeSpec, TrimSpec};
pub use mask::{LabelSpec, MaskPhantom, MaskSpec, OtherLabels};
pub use shading::{LightSpec, ShadingSpec};
pub use show::{ProjectSpec, ProjectionOf, SurfaceSpec};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Effects; one that is not named is not computed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectsSpec {
    /// Shows a part of the volume only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip: Option<ClipSpec>,
    /// Hides labels of a segmentation, or gives them a look of their own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mask: Option<MaskSpec>,
    /// Levoy's gradient shading with the Blinn-Phong reflection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shading: Option<ShadingSpec>,
    /// Shows one number of the values along each ray as a grey, instead of light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub project: Option<ProjectSpec>,
    /// Shows level surfaces, instead of light.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub surfaces: Option<Vec<SurfaceSpec>>,
}
