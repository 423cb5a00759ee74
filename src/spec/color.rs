//! Colours as written, and the light behind the volume: sRGB notation or linear numbers.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::BackgroundSpec;

/// A colour, linear RGB in [0, 1].
///
/// Written as `"#rgb"` or `"#rrggbb"` in sRGB (IEC 61966-2-1), by name, or as `[r, g, b]` in linear light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Color(pub [f64; 3]);

const NAMES: [(&str, [u8; 3]); 10] = [
    ("black", [0, 0, 0]),
    ("white", [255, 255, 255]),
    ("gray", [128, 128, 128]),
    ("red", [255, 0, 0]),
    ("green", [0, 128, 0]),
    ("blue", [0, 0, 255]),
    ("yellow", [255, 255, 0]),
    ("cyan", [0, 255, 255]),
    ("magenta", [255, 0, 255]),
    ("orange", [255, 165, 0]),
];

impl Color {
    /// White.
    pub const WHITE: Color = Color([1.0; 3]);
    /// Black.
    pub const BLACK: Color = Color([0.0; 3]);

    /// The colour of 8-bit sRGB numbers.
    pub fn from_srgb8(rgb: [u8; 3]) -> Self {
        Color(rgb.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        }))
    }

    /// The colour of a text: `#rgb`, `#rrggbb` or a name.
    ///
    /// # Errors
    /// What was found and what was expected, as one clause.
    pub fn parse(text: &str) -> Result<Self, String> {
        if let Some(digits) = text.strip_prefix('#') {
            return Self::parse_hex(digits)
                .ok_or_else(|| format!("{text:?}, expected \"#rgb\" or \"#rrggbb\" in hexadecimal digits"));
        }
        if let Some((_, rgb)) = NAMES.iter().find(|(name, _)| *name == text) {
            return Ok(Self::from_srgb8(*rgb));
        }
        let names: Vec<&str> = NAMES.iter().map(|(name, _)| *name).collect();
        Err(format!("{text:?}, expected \"#rrggbb\" in quotes, [r, g, b], or one of {}", names.join(", ")))
    }

    fn parse_hex(digits: &str) -> Option<Self> {
        let nibbles: Vec<u8> = digits.chars().map(|c| c.to_digit(16).map(|d| d as u8)).collect::<Option<_>>()?;
        match *nibbles.as_slice() {
            [r, g, b] => Some(Self::from_srgb8([r * 17, g * 17, b * 17])),
            [r, rr, g, gg, b, bb] => Some(Self::from_srgb8([r * 16 + rr, g * 16 + gg, b * 16 + bb])),
            _ => None,
        }
    }
}

struct ColorVisitor;

impl<'de> Visitor<'de> for ColorVisitor {
    type Value = Color;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a colour: \"#rrggbb\" in quotes, a name, or [r, g, b]")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Color, E> {
        Color::parse(text).map_err(|clause| E::custom(format!("found {clause}")))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Color, A::Error> {
        let mut rgb = [0.0; 3];
        for (i, c) in rgb.iter_mut().enumerate() {
            *c = seq.next_element()?.ok_or_else(|| de::Error::invalid_length(i, &"3 numbers, linear r, g and b"))?;
        }
        if seq.next_element::<f64>()?.is_some() {
            return Err(de::Error::invalid_length(4, &"3 numbers, linear r, g and b"));
        }
        match rgb.iter().find(|c| !(0.0..=1.0).contains(*c)) {
            Some(c) => Err(de::Error::custom(format!("found {c}, expected linear r, g and b from 0 to 1"))),
            None => Ok(Color(rgb)),
        }
    }
}

impl<'de> Deserialize<'de> for Color {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ColorVisitor)
    }
}

impl Serialize for Color {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl JsonSchema for Color {
    fn schema_name() -> Cow<'static, str> {
        "Color".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A colour: \"#rgb\" or \"#rrggbb\" in sRGB, a name, or [r, g, b] in linear light.",
            "anyOf": [
                { "type": "string", "pattern": "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$" },
                { "type": "string", "enum": NAMES.map(|(name, _)| name) },
                { "type": "array", "items": { "type": "number", "minimum": 0, "maximum": 1 },
                  "minItems": 3, "maxItems": 3 }
            ]
        })
    }
}

impl<'de> Deserialize<'de> for BackgroundSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BackgroundVisitor;
        impl<'de> Visitor<'de> for BackgroundVisitor {
            type Value = BackgroundSpec;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"transparent\" or a colour: \"#rrggbb\" in quotes, a name, or [r, g, b]")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<BackgroundSpec, E> {
                if text == "transparent" {
                    return Ok(BackgroundSpec::Transparent);
                }
                ColorVisitor.visit_str(text).map(BackgroundSpec::Color)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<BackgroundSpec, A::Error> {
                ColorVisitor.visit_seq(seq).map(BackgroundSpec::Color)
            }
        }
        deserializer.deserialize_any(BackgroundVisitor)
    }
}

impl Serialize for BackgroundSpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            BackgroundSpec::Transparent => serializer.serialize_str("transparent"),
            BackgroundSpec::Color(color) => color.serialize(serializer),
        }
    }
}

impl JsonSchema for BackgroundSpec {
    fn schema_name() -> Cow<'static, str> {
        "Background".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let color = generator.subschema_for::<Color>();
        json_schema!({
            "description": "`transparent`, or an even colour.",
            "anyOf": [{ "const": "transparent" }, color]
        })
    }
}
