//! Label masks: what of a segmentation is shown.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::spec::LayerSpec;

/// Hides labels of a segmentation, or gives them a look of their own; see [`crate::scene::Mask`]. Exactly one of `source`
/// and `phantom`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaskSpec {
    /// A `.nrrd`, `.nhdr` or `.seg.nrrd` file of labels on the lattice of the scan, relative to the pipeline's file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<PathBuf>,
    /// The labels of the phantom that is pictured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phantom: Option<MaskPhantom>,
    /// What each label shows, by its number or by the name that the file gives it: `hide`, `show`, or a layer such as
    /// `{ preset: bone }` in place of the transfer function.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub labels: BTreeMap<String, LabelSpec>,
    /// What all other labels show, the background 0 among them; `show` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub default: Option<OtherLabels>,
}

/// Labels that a phantom has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MaskPhantom {
    /// Anatomical structures, by their names. Head: skin, muscle, brain, eyes, skull, jaw, spine, airways, teeth, vessels. Chest:
    /// skin, muscle, mediastinum, abdomen, liver, lungs, airways, vessels, heart, spine, ribs, sternum, shoulders.
    Structures,
}

/// What labels show that are not listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OtherLabels {
    /// What the transfer function says.
    Show,
    /// Nothing.
    Hide,
}

/// What a label shows.
#[derive(Debug, Clone, PartialEq)]
pub enum LabelSpec {
    /// What the transfer function says.
    Show,
    /// Nothing.
    Hide,
    /// What this layer says, in place of the transfer function.
    Own(LayerSpec),
}

struct LabelVisitor;

impl<'de> Visitor<'de> for LabelVisitor {
    type Value = LabelSpec;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("hide, show, or a layer such as { preset: bone }")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<LabelSpec, E> {
        match text {
            "show" => Ok(LabelSpec::Show),
            "hide" => Ok(LabelSpec::Hide),
            _ => Err(E::invalid_value(Unexpected::Str(text), &self)),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<LabelSpec, A::Error> {
        LayerSpec::deserialize(MapAccessDeserializer::new(map)).map(LabelSpec::Own)
    }
}

impl<'de> Deserialize<'de> for LabelSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(LabelVisitor)
    }
}

impl Serialize for LabelSpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            LabelSpec::Show => serializer.serialize_str("show"),
            LabelSpec::Hide => serializer.serialize_str("hide"),
            LabelSpec::Own(layer) => layer.serialize(serializer),
        }
    }
}

impl JsonSchema for LabelSpec {
    fn schema_name() -> Cow<'static, str> {
        "Label".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let layer = generator.subschema_for::<LayerSpec>();
        json_schema!({
            "description": "`hide`, `show`, or a layer in place of the transfer function.",
            "anyOf": [{ "enum": ["hide", "show"] }, layer]
        })
    }
}
