//! From the tree to types: a serde deserializer that knows the key path and place of every value.
//!
//! It is stricter than YAML libraries are: a key without a value is an error (a colour whose `#` began a comment would
//! else be lost silently), numbers must be finite, and only mappings are structs. And kinder: numbers may be fractions,
//! and a choice may be written by its name alone, which takes all its defaults.

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, MapAccess, SeqAccess, VariantAccess,
    Visitor,
};
use serde::forward_to_deserialize_any;

use super::complaint::Complaint;
use super::tree::{Key, Node, Origin, Value};

type Result<T> = std::result::Result<T, Complaint>;

/// A value of this type from a tree.
pub(super) fn from_tree<T: DeserializeOwned>(node: &Node) -> Result<T> {
    T::deserialize(Typed { node, path: String::new() })
}

/// A node on its way to a type.
struct Typed<'a> {
    node: &'a Node,
    path: String,
}

fn join(path: &str, part: &str) -> String {
    if path.is_empty() { part.to_owned() } else { format!("{path}.{part}") }
}

/// The number of a text such as `1/255`.
pub(super) fn fraction(text: &str) -> Option<f64> {
    let (above, below) = text.split_once('/')?;
    let quotient = above.trim().parse::<f64>().ok()? / below.trim().parse::<f64>().ok()?;
    quotient.is_finite().then_some(quotient)
}

impl<'a> Typed<'a> {
    /// Says of an error where it is.
    fn placed<T>(node: &Node, path: &str, result: Result<T>) -> Result<T> {
        result.map_err(|complaint| complaint.at(path, node.origin))
    }

    fn visit<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        let Typed { node, path } = self;
        let result = match &node.value {
            Value::Null => Err(no_value()),
            Value::Bool(b) => visitor.visit_bool(*b),
            Value::Integer(i) => match (i64::try_from(*i), u64::try_from(*i)) {
                (Ok(i), _) => visitor.visit_i64(i),
                (_, Ok(i)) => visitor.visit_u64(i),
                _ => Err(Complaint::wrong_kind(node, "a number of at most 64 bits")),
            },
            Value::Number(x) if !x.is_finite() => Err(Complaint::wrong_kind(node, "a finite number")),
            Value::Number(x) => visitor.visit_f64(*x),
            Value::Text(text) => visitor.visit_str(text),
            Value::List(items) => visitor.visit_seq(Items { rest: items, index: 0, path: &path }),
            Value::Map(entries) => visitor.visit_map(Entries { rest: entries, value: None, path: &path }),
        };
        Self::placed(node, &path, result)
    }
}

fn no_value() -> Complaint {
    let mut complaint = Complaint::new("a key has no value");
    complaint.0.remedy =
        Some("leave the key out, or give it a value; a colour goes in quotes, because # starts a comment".to_owned());
    complaint
}

impl<'de> Deserializer<'de> for Typed<'_> {
    type Error = Complaint;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        self.visit(visitor)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match &self.node.value {
            Value::Text(text) => match fraction(text) {
                Some(number) => Self::placed(self.node, &self.path, visitor.visit_f64(number)),
                None => Err(Complaint::wrong_kind(self.node, "a number, or a fraction such as 1/255")
                    .at(&self.path, self.node.origin)),
            },
            _ => self.visit(visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.node.value {
            Value::Null => Err(no_value().at(&self.path, self.node.origin)),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value> {
        match &self.node.value {
            Value::List(items) if items.len() == len => self.visit(visitor),
            _ => {
                let expected = format!("a list of {len}");
                Err(Complaint::wrong_kind(self.node, &expected).at(&self.path, self.node.origin))
            }
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value> {
        let Value::Map(entries) = &self.node.value else {
            let complaint = match self.node.value {
                Value::Null => no_value(),
                _ => Complaint::wrong_kind(self.node, &format!("a mapping with keys such as {}", fields[0])),
            };
            return Err(complaint.at(&self.path, self.node.origin));
        };
        if let Some((key, _)) = entries.iter().find(|(key, _)| !fields.contains(&key.name.as_str())) {
            let path = join(&self.path, &key.name);
            return Err(Complaint::unknown("key", &key.name, fields).at(&path, key.origin));
        }
        self.visit(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value> {
        let Typed { node, path } = self;
        let choice = match &node.value {
            Value::Null => return Err(no_value().at(&path, node.origin)),
            Value::Text(name) => Choice { name, origin: node.origin, content: None, path: &path },
            Value::Map(entries) if entries.len() == 1 => {
                let (key, content) = &entries[0];
                Choice { name: &key.name, origin: key.origin, content: Some(content), path: &path }
            }
            _ => {
                let expected = format!("one of {}", variants.join(", "));
                return Err(Complaint::wrong_kind(node, &expected).at(&path, node.origin));
            }
        };
        Self::placed(node, &path, visitor.visit_enum(choice))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 char str string bytes byte_buf unit unit_struct seq
        tuple_struct map identifier ignored_any
    }
}

struct Items<'a> {
    rest: &'a [Node],
    index: usize,
    path: &'a str,
}

impl<'de> SeqAccess<'de> for Items<'_> {
    type Error = Complaint;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>> {
        let Some((node, rest)) = self.rest.split_first() else { return Ok(None) };
        let path = join(self.path, &self.index.to_string());
        self.rest = rest;
        self.index += 1;
        // Here, and not only in the value's own deserializer, so that errors of `from` and `try_from` find their place.
        Typed::placed(node, &path, seed.deserialize(Typed { node, path: path.clone() })).map(Some)
    }
}

struct Entries<'a> {
    rest: &'a [(Key, Node)],
    value: Option<(&'a Key, &'a Node)>,
    path: &'a str,
}

impl<'de> MapAccess<'de> for Entries<'_> {
    type Error = Complaint;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>> {
        let Some(((key, node), rest)) = self.rest.split_first() else { return Ok(None) };
        self.rest = rest;
        self.value = Some((key, node));
        let name: StrDeserializer<'_, Complaint> = key.name.as_str().into_deserializer();
        seed.deserialize(name).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value> {
        let (key, node) = self.value.take().ok_or_else(|| Complaint::new("a value was read before its key"))?;
        let path = join(self.path, &key.name);
        Typed::placed(node, &path, seed.deserialize(Typed { node, path: path.clone() }))
    }
}

struct Choice<'a> {
    name: &'a str,
    origin: Origin,
    content: Option<&'a Node>,
    path: &'a str,
}

impl<'de> EnumAccess<'de> for Choice<'_> {
    type Error = Complaint;
    type Variant = Content;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Content)> {
        let name: StrDeserializer<'_, Complaint> = self.name.into_deserializer();
        let variant = seed.deserialize(name).map_err(|complaint| complaint.at(self.path, self.origin))?;
        // A name alone is the choice with all its defaults.
        let empty = Node { value: Value::Map(Vec::new()), origin: self.origin };
        let node = self.content.cloned().unwrap_or(empty);
        Ok((variant, Content { path: join(self.path, self.name), node }))
    }
}

struct Content {
    node: Node,
    path: String,
}

impl<'de> VariantAccess<'de> for Content {
    type Error = Complaint;

    fn unit_variant(self) -> Result<()> {
        match &self.node.value {
            Value::Map(entries) if entries.is_empty() => Ok(()),
            _ => Err(Complaint::wrong_kind(&self.node, "the name alone: it has no settings")
                .at(&self.path, self.node.origin)),
        }
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value> {
        seed.deserialize(Typed { node: &self.node, path: self.path })
    }

    fn tuple_variant<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value> {
        Typed { node: &self.node, path: self.path }.deserialize_tuple(len, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value> {
        Typed { node: &self.node, path: self.path }.deserialize_struct("", fields, visitor)
    }
}
