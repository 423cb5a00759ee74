//! Which labels of a reference make up which tissue, as written.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use super::source::Source;
use crate::error::{Error, Result};

/// A table that says which labels of a reference make up a tissue of ours, such as all vertebrae and ribs for bone.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceTissues {
    tissues: Vec<(String, Vec<LabelRange>)>,
    source: Source,
}

/// Labels from a first to a last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LabelRange {
    /// First label.
    pub first: u16,
    /// Last label, which may be the first.
    pub last: u16,
}

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    version: u32,
    tissues: BTreeMap<String, Vec<Labels>>,
}

/// `25`, or `92-115`.
#[derive(Deserialize)]
#[serde(untagged)]
enum Labels {
    One(u16),
    Text(String),
}

impl ReferenceTissues {
    /// Reads a table from a YAML file.
    ///
    /// # Errors
    /// `Fault::Spec`, with place, for a file that cannot be read, a range that is none, and a label that two tissues claim.
    pub fn load(path: &Path) -> Result<Self> {
        Self::from_source(Source::read(path, &[])?)
    }

    /// The same from text; `path` is for messages.
    ///
    /// # Errors
    /// As [`ReferenceTissues::load`].
    pub fn from_text(text: &str, path: &Path) -> Result<Self> {
        Self::from_source(Source::parse(text.to_owned(), path, &[])?)
    }

    fn from_source(source: Source) -> Result<Self> {
        let table: Table = source.typed()?;
        if table.version != 1 {
            return Err(source.error("version", "a value is out of range").expected("1"));
        }
        let mut owners: BTreeMap<u16, &str> = BTreeMap::new();
        let mut tissues = Vec::new();
        for (name, labels) in &table.tissues {
            let mut ranges = Vec::new();
            for (i, written) in labels.iter().enumerate() {
                let key_path = format!("tissues.{name}.{i}");
                let range = range(written).ok_or_else(|| {
                    let error = source.error(&key_path, "this is neither a label nor a range of labels");
                    error.found(source.found(&key_path)).expected("a number from 1 to 65535, or two such as \"92-115\"")
                })?;
                for label in range.first..=range.last {
                    if let Some(owner) = owners.insert(label, name) {
                        return Err(source
                            .error(&key_path, "a label stands for two tissues")
                            .found(format!("{label} in {owner} and in {name}")));
                    }
                }
                ranges.push(range);
            }
            tissues.push((name.clone(), ranges));
        }
        Ok(ReferenceTissues { tissues, source })
    }

    /// Each tissue with its labels.
    pub fn tissues(&self) -> impl Iterator<Item = (&str, &[LabelRange])> {
        self.tissues.iter().map(|(name, ranges)| (name.as_str(), ranges.as_slice()))
    }

    /// An error about a tissue, with its place in the table.
    pub fn error(&self, tissue: &str, what: impl Into<String>) -> Error {
        self.source.error(&format!("tissues.{tissue}"), what)
    }
}

fn range(written: &Labels) -> Option<LabelRange> {
    let (first, last) = match written {
        Labels::One(label) => (*label, *label),
        Labels::Text(text) => {
            let (first, last) = text.split_once('-')?;
            (first.trim().parse().ok()?, last.trim().parse().ok()?)
        }
    };
    (first >= 1 && first <= last).then_some(LabelRange { first, last })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Result<ReferenceTissues> {
        ReferenceTissues::from_text(text, Path::new("tissues.yaml"))
    }

    #[test]
    fn labels_and_ranges_are_read() {
        let read = table("version: 1\ntissues:\n  bone: [25, \"92-115\"]\n  fat: [1]\n").unwrap();
        let found: Vec<_> = read.tissues().map(|(name, ranges)| (name, ranges.to_vec())).collect();
        let range = |first, last| LabelRange { first, last };
        assert_eq!(found, [("bone", vec![range(25, 25), range(92, 115)]), ("fat", vec![range(1, 1)])]);
    }

    #[test]
    fn mistakes_are_named_with_their_place() {
        for (labels, says) in [
            ("[0]", "neither a label nor a range"),
            ("[\"9-3\"]", "neither a label nor a range"),
            ("[ribs]", "neither a label nor a range"),
            ("[3, \"1-4\"]", "stands for two tissues"),
        ] {
            let error = table(&format!("version: 1\ntissues:\n  bone: {labels}\n")).unwrap_err().to_string();
            assert!(error.contains(says) && error.contains("tissues.yaml:3:"), "{labels}: found {error}");
        }
    }
}
