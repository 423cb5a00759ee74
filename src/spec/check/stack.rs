//! Checks on a stack of pictures.

use super::Check;
use super::pipeline::{check_bits, extension};
use crate::error::Result;
use crate::spec::Stack;
use crate::spec::source::Source;

/// Checks a stack as far as that is possible without its pictures.
pub(in crate::spec) fn check_stack(source: &Source, stack: &Stack) -> Result<()> {
    let check = Check { source };
    check.require("version", stack.version == 1, "1")?;
    check.require("layers", !stack.layers.is_empty(), "at least one picture")?;
    for (i, layer) in stack.layers.iter().enumerate() {
        check.require(&format!("layers.{i}"), extension(layer) == "png", "a .png file")?;
    }
    check_bits(check, stack.image.as_ref().and_then(|image| image.bits), stack.output.as_deref())
}
