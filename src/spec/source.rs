//! A file as read, with its overrides, for errors that point into it.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::complaint::{Complaint, Parts};
use super::overrides;
use super::tree::{self, Node, Origin, Value};
use super::typed;
use crate::error::{Error, Fault, Result, TextPlace};

/// A YAML file with its overrides applied.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Source {
    path: PathBuf,
    text: String,
    overrides: Vec<String>,
    tree: Node,
}

impl Source {
    /// Reads a file; at most 4 MiB, which no author writes.
    pub(super) fn read(path: &Path, overrides: &[String]) -> Result<Self> {
        const MOST_BYTES: u64 = 4 << 20;
        let unreadable = |error: std::io::Error| {
            Error::new(Fault::Spec, "the file cannot be read").at(path).caused_by(error).remedy("check the path")
        };
        let size = std::fs::metadata(path).map_err(unreadable)?.len();
        if size > MOST_BYTES {
            return Err(Error::new(Fault::Spec, "the file is too large to be a pipeline or a preset")
                .at(path)
                .found(format!("{size} bytes"))
                .expected(format!("at most {MOST_BYTES}")));
        }
        let text = std::fs::read_to_string(path).map_err(unreadable)?;
        Source::parse(text, path, overrides)
    }

    /// Parses a text; `path` is for messages.
    pub(super) fn parse(text: String, path: &Path, overrides: &[String]) -> Result<Self> {
        let mut tree = match tree::parse(&text) {
            Ok(tree) => tree,
            Err(error) => return Err(syntax_error(&error, path, text)),
        };
        if tree.value == Value::Null {
            return Err(Error::new(Fault::Spec, "the file is empty")
                .at(path)
                .expected("a mapping that begins with version: 1"));
        }
        for (index, text) in overrides.iter().enumerate() {
            overrides::apply(&mut tree, index, text)?;
        }
        Ok(Source { path: path.to_path_buf(), text, overrides: overrides.to_vec(), tree })
    }

    /// The file.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// True if this key is written at the top.
    pub(super) fn has(&self, key: &str) -> bool {
        self.tree.child(key).is_some()
    }

    /// A path that is written at a key path: one of the file is relative to the file, one of an override to the working
    /// directory, where whoever typed it stands.
    pub(super) fn resolve(&self, key_path: &str, path: &Path) -> PathBuf {
        match self.tree.nearest(key_path).origin {
            Origin::Override(_) => path.to_path_buf(),
            Origin::File { .. } => self.path.parent().unwrap_or(Path::new("")).join(path),
        }
    }

    /// The text as it is in the file.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// The tree as a type.
    pub(super) fn typed<T: DeserializeOwned>(&self) -> Result<T> {
        typed::from_tree(&self.tree).map_err(|complaint| self.complain(complaint))
    }

    /// An error about what is written at a key path, or, where nothing is, about the mapping it would be in.
    pub(super) fn error(&self, key_path: &str, what: impl Into<String>) -> Error {
        self.place(Error::new(Fault::Spec, what).element(key_path), self.tree.nearest(key_path).origin)
    }

    /// An error of what was made by the words at a key path, with their place.
    pub(super) fn located(&self, key_path: &str, error: Error) -> Error {
        self.place(error.element(key_path), self.tree.nearest(key_path).origin)
    }

    /// What is written at a key path, for messages.
    pub(super) fn found(&self, key_path: &str) -> String {
        self.tree.nearest(key_path).describe()
    }

    fn complain(&self, complaint: Complaint) -> Error {
        let Parts { what, found, expected, remedy, place } = *complaint.0;
        let mut error = Error::new(Fault::Spec, what);
        let (key_path, origin) = place.unwrap_or((String::new(), self.tree.origin));
        if !key_path.is_empty() {
            error = error.element(key_path);
        }
        if let Some(found) = found {
            error = error.found(found);
        }
        if let Some(expected) = expected {
            error = error.expected(expected);
        }
        if let Some(remedy) = remedy {
            error = error.remedy(remedy);
        }
        self.place(error, origin)
    }

    fn place(&self, error: Error, origin: Origin) -> Error {
        match origin {
            Origin::Override(index) => error.at(format!("--set {}", self.overrides[index])),
            Origin::File { line, column, span } => {
                error.at(&self.path).place(TextPlace { line, column, span, text: self.text.clone() })
            }
        }
    }
}

fn syntax_error(error: &serde_saphyr::Error, path: &Path, text: String) -> Error {
    let location = error.location();
    // The message without the parser's own account of the place, which we give ourselves.
    let message = error.without_snippet().to_string();
    let what = message.split(" at line ").next().unwrap_or(&message).trim_end_matches([':', ' ']).to_owned();
    let ours = Error::new(Fault::Spec, format!("this is not valid YAML: {what}")).at(path);
    match location.map(tree::origin) {
        Some(Origin::File { line, column, span }) => ours.place(TextPlace { line, column, span, text }),
        _ => ours,
    }
}
