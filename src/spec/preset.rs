//! A preset file: the look of one tissue, in HU and per mm, the same on every scan.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ValuesName, Widget};

/// A preset.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "pellucid preset")]
pub struct Preset {
    /// Version of this form: 1.
    #[schemars(range(min = 1, max = 1))]
    pub version: u32,
    /// Its name, by which a pipeline calls it; that of its file without `.yaml`.
    pub name: String,
    /// What it shows and what it cannot, in a sentence or two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// The tissue it classifies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tissue: Option<Tissue>,
    /// What its positions measure; `hu` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub values: Option<ValuesName>,
    /// Its widgets, which add up.
    #[schemars(length(min = 1))]
    pub widgets: Vec<Widget>,
    /// Widgets for label maps in place of those of the picture, where the two want different ones: shapes without optics.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub classify: Option<Vec<Widget>>,
}

/// A tissue, for label maps.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tissue {
    /// Number in a label map, from 1.
    #[schemars(range(min = 1))]
    pub label: u16,
    /// SNOMED CT concept identifier, in quotes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snomed: Option<String>,
    /// What that concept is, in words; the name of the preset by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub meaning: Option<String>,
}
