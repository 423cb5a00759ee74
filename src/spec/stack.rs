//! A stack: a pipeline with pictures in place of a scan.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::check::check_stack;
use super::source::Source;
use super::{BackgroundSpec, Bits, Spec};
use crate::error::Result;

/// Pictures that are composited, the first in front, by Porter and Duff's *over*.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "pellucid stack")]
pub struct Stack {
    /// Version of this form: 1.
    #[schemars(range(min = 1, max = 1))]
    pub version: u32,
    /// PNG files of one size, the first in front, relative to the pipeline's file.
    #[schemars(length(min = 1))]
    pub layers: Vec<PathBuf>,
    /// Whether the colours in the files are multiplied by their alpha; `straight`, they are not, by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alpha: Option<AlphaName>,
    /// The picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub image: Option<StackImageSpec>,
    /// The file to write, `.png` or `.exr`, relative to the pipeline's file; by default the pipeline's name with `.png`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<PathBuf>,
}

/// Whether colours are multiplied by their alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AlphaName {
    /// They are not, as the PNG standard has it.
    Straight,
    /// They are, as encoded; some programs write this into PNG files against the standard.
    Associated,
}

/// The picture of a stack, of the size of its layers.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StackImageSpec {
    /// Light behind the last layer; `black` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub background: Option<BackgroundSpec>,
    /// Bits per channel of a PNG; 8 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bits: Option<Bits>,
}

/// A stack as read from its file.
#[derive(Debug, Clone, PartialEq)]
pub struct StackSpec {
    /// The stack as written, overrides applied.
    pub stack: Stack,
    source: Source,
}

/// A pipeline file, of either form.
#[derive(Debug, Clone, PartialEq)]
pub enum Document {
    /// A scan and what is pictured of it.
    Scan(Box<Spec>),
    /// A stack of pictures: the file has the key `layers`.
    Stack(Box<StackSpec>),
}

impl Document {
    /// Reads a pipeline file of either form, with `overrides` of the form `key.path=value` in their order.
    ///
    /// # Errors
    /// As [`Spec::load`].
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self> {
        let source = Source::read(path, overrides)?;
        if source.has("layers") {
            StackSpec::from_source(source).map(|stack| Document::Stack(Box::new(stack)))
        } else {
            Spec::from_source(source).map(|spec| Document::Scan(Box::new(spec)))
        }
    }
}

impl StackSpec {
    /// A stack from text; `path` is for messages and for what is relative to the file.
    ///
    /// # Errors
    /// As [`Spec::load`].
    pub fn from_text(text: &str, path: &Path, overrides: &[String]) -> Result<Self> {
        Self::from_source(Source::parse(text.to_owned(), path, overrides)?)
    }

    fn from_source(source: Source) -> Result<Self> {
        let stack: Stack = source.typed()?;
        check_stack(&source, &stack)?;
        Ok(StackSpec { stack, source })
    }

    /// The stack's file.
    pub fn path(&self) -> &Path {
        self.source.path()
    }

    /// The stack's text as it is in the file, without overrides; for hashes.
    pub fn text(&self) -> &str {
        self.source.text()
    }

    /// The pictures' paths, the first in front, relative to the working directory.
    pub fn layers(&self) -> Vec<PathBuf> {
        let resolve = |(i, path): (usize, &PathBuf)| self.source.resolve(&format!("layers.{i}"), path);
        self.stack.layers.iter().enumerate().map(resolve).collect()
    }

    /// The picture's path, if the stack names one, relative to the working directory.
    pub fn output(&self) -> Option<PathBuf> {
        self.stack.output.as_deref().map(|path| super::without_detours(&self.source.resolve("output", path)))
    }
}
