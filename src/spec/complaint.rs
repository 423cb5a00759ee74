//! What is wrong with a node, as serde reports it, with its key path and place.

use std::fmt::{self, Display};

use serde::de::{self, Expected, Unexpected};

use super::suggest::did_you_mean;
use super::tree::{Node, Origin};

/// What is wrong; the innermost deserializer that sees it adds where. Boxed, so that results stay small.
#[derive(Debug)]
pub(super) struct Complaint(pub(super) Box<Parts>);

/// The parts of an error's message.
#[derive(Debug)]
pub(super) struct Parts {
    pub(super) what: String,
    pub(super) found: Option<String>,
    pub(super) expected: Option<String>,
    pub(super) remedy: Option<String>,
    pub(super) place: Option<(String, Origin)>,
}

impl Complaint {
    pub(super) fn new(what: impl Into<String>) -> Self {
        Complaint(Box::new(Parts { what: what.into(), found: None, expected: None, remedy: None, place: None }))
    }

    pub(super) fn wrong_kind(node: &Node, expected: &str) -> Self {
        let mut complaint = Complaint::new("a value is of the wrong kind");
        complaint.0.found = Some(node.describe());
        complaint.0.expected = Some(expected.to_owned());
        complaint
    }

    pub(super) fn unknown(what: &str, name: &str, known: &[&str]) -> Self {
        let mut complaint = Complaint::new(format!("there is no such {what}"));
        complaint.0.found = Some(name.to_owned());
        complaint.0.expected = Some(match known {
            [] => "none here".to_owned(),
            [one] => (*one).to_owned(),
            _ => format!("one of {}", known.join(", ")),
        });
        complaint.0.remedy = did_you_mean(name, known.iter().copied());
        complaint
    }

    /// Says where, unless something nearer to the cause has said so.
    pub(super) fn at(mut self, key_path: &str, origin: Origin) -> Self {
        self.0.place.get_or_insert_with(|| (key_path.to_owned(), origin));
        self
    }

    fn expecting(mut self, expected: &dyn Expected) -> Self {
        // The standard visitors name Rust types, which mean nothing to an author.
        let text = expected.to_string();
        self.0.expected = Some(match text.as_str() {
            "u16" | "u32" | "u64" => "a whole number of at least 0".to_owned(),
            "f64" => "a number".to_owned(),
            "a boolean" => "true or false".to_owned(),
            "a string" | "path string" => "a text".to_owned(),
            "a sequence" => "a list".to_owned(),
            _ => text,
        });
        self
    }
}

fn describe(unexpected: Unexpected<'_>) -> String {
    match unexpected {
        Unexpected::Str(text) => format!("{text:?}"),
        Unexpected::Signed(i) => i.to_string(),
        Unexpected::Unsigned(i) => i.to_string(),
        Unexpected::Float(x) => x.to_string(),
        Unexpected::Bool(b) => b.to_string(),
        Unexpected::Seq => "a list".to_owned(),
        Unexpected::Map => "a mapping".to_owned(),
        Unexpected::Unit => "nothing".to_owned(),
        other => other.to_string(),
    }
}

impl Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.what)
    }
}

impl std::error::Error for Complaint {}

impl de::Error for Complaint {
    fn custom<T: Display>(message: T) -> Self {
        Complaint::new(message.to_string())
    }

    fn invalid_type(unexpected: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let mut complaint = Complaint::new("a value is of the wrong kind").expecting(expected);
        complaint.0.found = Some(describe(unexpected));
        complaint
    }

    fn invalid_value(unexpected: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let mut complaint = Complaint::new("a value cannot be used").expecting(expected);
        complaint.0.found = Some(describe(unexpected));
        complaint
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        let mut complaint = Complaint::new("a list has the wrong length").expecting(expected);
        complaint.0.found = Some(length.to_string());
        complaint
    }

    fn unknown_variant(variant: &str, expected: &'static [&'static str]) -> Self {
        Complaint::unknown("choice", variant, expected)
    }

    fn missing_field(field: &'static str) -> Self {
        let mut complaint = Complaint::new("a key is missing");
        complaint.0.expected = Some(format!("the key {field}"));
        complaint
    }
}
