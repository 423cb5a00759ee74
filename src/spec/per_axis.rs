//! One number for all axes, or one for each.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, IntoDeserializer, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::typed::fraction;

/// One number for all axes, or a list with one for each; how long it may be is checked where the axes are known.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum PerAxis<T> {
    /// The same along all axes.
    All(T),
    /// One for each.
    Each(Vec<T>),
}

impl<T: Copy> PerAxis<T> {
    /// The numbers of `axes` axes, or `None` for a list of another length.
    pub fn numbers(&self, axes: usize) -> Option<Vec<T>> {
        match self {
            PerAxis::All(number) => Some(vec![*number; axes]),
            PerAxis::Each(numbers) => (numbers.len() == axes).then(|| numbers.clone()),
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for PerAxis<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PerAxisVisitor(PhantomData))
    }
}

struct PerAxisVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for PerAxisVisitor<T> {
    type Value = PerAxis<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a list with one for each axis")
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<PerAxis<T>, E> {
        T::deserialize(number.into_deserializer()).map(PerAxis::All)
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<PerAxis<T>, E> {
        T::deserialize(number.into_deserializer()).map(PerAxis::All)
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<PerAxis<T>, E> {
        T::deserialize(number.into_deserializer()).map(PerAxis::All)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<PerAxis<T>, E> {
        let number = fraction(text).ok_or_else(|| E::invalid_value(de::Unexpected::Str(text), &self))?;
        self.visit_f64(number)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<PerAxis<T>, A::Error> {
        let mut numbers = Vec::new();
        while let Some(number) = seq.next_element()? {
            numbers.push(number);
        }
        Ok(PerAxis::Each(numbers))
    }
}

impl<T: JsonSchema> JsonSchema for PerAxis<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("PerAxis_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = generator.subschema_for::<T>();
        json_schema!({
            "description": "A number, or a list with one for each axis.",
            "anyOf": [number, { "type": "array", "items": number, "minItems": 1, "maxItems": 3 }]
        })
    }
}
