//! Shading and its lights.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::spec::Color;

/// Shading by the gradient; see [`crate::scene::Shading`] for its definition.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShadingSpec {
    /// Share of the colour seen without any light; 0.2 by default, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub ambient: Option<f64>,
    /// Share of the colour that follows Lambert's cosine law; 0.7 by default, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub diffuse: Option<f64>,
    /// Strength of the highlight; 0.2 by default, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub specular: Option<f64>,
    /// Exponent of the highlight; 20 by default, at least 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub shininess: Option<f64>,
    /// Light both sides of a surface alike; true by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub two_sided: Option<bool>,
    /// Gradient magnitude at which shading has half its strength, HU/mm; 20 by default, about the gradient of noise,
    /// and 0 for none of this fade.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub soft_gradient_hu_per_mm: Option<f64>,
    /// The lights; one white headlight by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub lights: Option<Vec<LightSpec>>,
}

/// A light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum LightSpec {
    /// At the eye.
    Headlight {
        /// Its colour; white by default.
        #[serde(skip_serializing_if = "Option::is_none")]
        color: Option<Color>,
    },
    /// Infinitely far away.
    Directional {
        /// Direction from the patient towards the light, LPS: x to the patient's left, y to the back, z to the head.
        /// Of any length but 0.
        towards: [f64; 3],
        /// Its colour; white by default.
        #[serde(skip_serializing_if = "Option::is_none")]
        color: Option<Color>,
    },
}
