//! Colours as written, and the light behind the volume: sRGB notation or linear numbers.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, SeqAccess, Unexpected, Visitor};
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

    /// The colour of a text, `#rgb`, `#rrggbb` or a name, if it is one.
    pub fn parse(text: &str) -> Option<Self> {
        match text.strip_prefix('#') {
            Some(digits) => Self::parse_hex(digits),
            None => NAMES.iter().find(|(name, _)| *name == text).map(|(_, rgb)| Self::from_srgb8(*rgb)),
        }
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

/// Expects a colour, or, with `or_transparent`, what is behind the volume.
struct ColorVisitor {
    or_transparent: bool,
}

impl<'de> Visitor<'de> for ColorVisitor {
    type Value = BackgroundSpec;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = NAMES.iter().map(|(name, _)| *name).collect();
        let before = if self.or_transparent { "\"transparent\" or " } else { "" };
        write!(f, "{before}a colour: \"#rgb\" or \"#rrggbb\" in quotes, [r, g, b], or one of {}", names.join(", "))
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<BackgroundSpec, E> {
        if self.or_transparent && text == "transparent" {
            return Ok(BackgroundSpec::Transparent);
        }
        let color = Color::parse(text).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))?;
        Ok(BackgroundSpec::Color(color))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<BackgroundSpec, A::Error> {
        const EXPECTED: &str = "3 numbers: linear red, green and blue";
        let mut rgb = [0.0; 3];
        for (i, channel) in rgb.iter_mut().enumerate() {
            let Share(share) = seq.next_element()?.ok_or_else(|| de::Error::invalid_length(i, &EXPECTED))?;
            *channel = share;
        }
        match seq.next_element::<Share>()? {
            Some(_) => Err(de::Error::invalid_length(4, &EXPECTED)),
            None => Ok(BackgroundSpec::Color(Color(rgb))),
        }
    }
}

/// A number from 0 to 1.
struct Share(f64);

impl<'de> Deserialize<'de> for Share {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let share = f64::deserialize(deserializer)?;
        if (0.0..=1.0).contains(&share) {
            return Ok(Share(share));
        }
        let expected = &"linear red, green and blue from 0 to 1";
        Err(de::Error::invalid_value(Unexpected::Float(share), expected))
    }
}

impl<'de> Deserialize<'de> for Color {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match deserializer.deserialize_any(ColorVisitor { or_transparent: false })? {
            BackgroundSpec::Color(color) => Ok(color),
            BackgroundSpec::Transparent => Err(de::Error::custom("a colour is needed here")),
        }
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
        deserializer.deserialize_any(ColorVisitor { or_transparent: true })
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
