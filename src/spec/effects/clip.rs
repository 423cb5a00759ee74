//! Clipping: the part of the volume that is shown.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::spec::typed::fraction;

/// What is shown of the volume: the inside of a box, and of planes one side; see [`crate::scene::Clip`].
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClipSpec {
    /// A box; what is inside is shown.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub within: Option<ClipBoxSpec>,
    /// Planes; what is on the side of each that its normal points to is shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 64))]
    pub planes: Option<Vec<ClipPlaneSpec>>,
}

/// A box, in one of three systems.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ClipBoxSpec {
    /// Continuous voxel indices along i, j and k; the box is turned and sheared with the voxels' axes. The first voxel is at
    /// index 0, and `[0, 9]` is what lies between voxels 0 and 9.
    Voxels([RangeSpec; 3]),
    /// Patient coordinates LPS along x (to the left), y (to the back) and z (to the head), mm.
    Mm([RangeSpec; 3]),
    /// What is cut off on each side of the patient, mm.
    TrimMm(TrimSpec),
}

/// What is cut off on each side of the patient, mm from where the volume ends on that side; nothing by default.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrimSpec {
    /// On the patient's left, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub left: Option<f64>,
    /// On the patient's right, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub right: Option<f64>,
    /// At the front, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub anterior: Option<f64>,
    /// At the back, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub posterior: Option<f64>,
    /// At the head, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub superior: Option<f64>,
    /// At the feet, at least 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub inferior: Option<f64>,
}

/// A plane, by exactly one of `point_mm` and `offset_mm`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClipPlaneSpec {
    /// Direction towards the side that is shown, LPS; of any length but 0.
    pub normal: [f64; 3],
    /// A point of the plane, LPS mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_mm: Option<[f64; 3]>,
    /// Distance of the plane from the origin along the normal, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub offset_mm: Option<f64>,
}

/// `[low, high]`, either of which may be `open`; or `open` for both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeSpec {
    /// Lower end; `None` where it is open.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
}

/// The word for an end that clips nothing.
const OPEN: &str = "open";

/// A number, or `open`.
struct End(Option<f64>);

struct EndVisitor;

impl Visitor<'_> for EndVisitor {
    type Value = End;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or open")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<End, E> {
        match (text, fraction(text)) {
            (OPEN, _) => Ok(End(None)),
            (_, Some(number)) => Ok(End(Some(number))),
            _ => Err(E::invalid_value(Unexpected::Str(text), &self)),
        }
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<End, E> {
        Ok(End(Some(number)))
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<End, E> {
        Ok(End(Some(number as f64)))
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<End, E> {
        Ok(End(Some(number as f64)))
    }
}

impl<'de> Deserialize<'de> for End {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EndVisitor)
    }
}

struct RangeVisitor;

impl<'de> Visitor<'de> for RangeVisitor {
    type Value = RangeSpec;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("[low, high], either of which may be open, or open for both")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<RangeSpec, E> {
        match text {
            OPEN => Ok(RangeSpec { low: None, high: None }),
            _ => Err(E::invalid_value(Unexpected::Str(text), &self)),
        }
    }

    fn visit_seq<A: de::SeqAccess<'de>>(self, mut seq: A) -> Result<RangeSpec, A::Error> {
        let mut ends = [None; 2];
        for (i, end) in ends.iter_mut().enumerate() {
            let End(number) = seq.next_element()?.ok_or_else(|| de::Error::invalid_length(i, &self))?;
            *end = number;
        }
        match seq.next_element::<End>()? {
            Some(_) => Err(de::Error::invalid_length(3, &self)),
            None => Ok(RangeSpec { low: ends[0], high: ends[1] }),
        }
    }
}

impl<'de> Deserialize<'de> for RangeSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(RangeVisitor)
    }
}

/// As it is read; an end is a number or a word.
impl Serialize for RangeSpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let end = |end: Option<f64>| end.map_or_else(|| OPEN.into(), serde_json::Value::from);
        [end(self.low), end(self.high)].serialize(serializer)
    }
}

impl JsonSchema for RangeSpec {
    fn schema_name() -> Cow<'static, str> {
        "Range".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "`[low, high]`, either of which may be `open`; or `open` for both.",
            "anyOf": [
                { "const": OPEN },
                { "type": "array", "items": { "anyOf": [{ "type": "number" }, { "const": OPEN }] },
                  "minItems": 2, "maxItems": 2 }
            ]
        })
    }
}
