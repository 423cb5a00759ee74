//! Shadows towards directional lights.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shadows that the volume casts on itself, towards each directional light of shading; see [`crate::scene::Shadows`].
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShadowsSpec {
    /// From 0 for none to 1, the default, for all of the shadow.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub strength: Option<f64>,
}
