//! What types cannot say: ranges, exactly one of several keys, and keys that nothing would read.

mod analytic;
mod camera;
mod clean;
mod clip;
mod effects;
mod light;
mod mask;
mod pipeline;
mod show;
mod stack;
mod widget;

pub(super) use pipeline::check_pipeline;
pub(super) use stack::check_stack;
pub(super) use widget::check_preset;

use super::source::Source;
use crate::error::Result;

/// Checks on one file.
#[derive(Clone, Copy)]
struct Check<'a> {
    source: &'a Source,
}

impl Check<'_> {
    /// Refuses what is written at `path` unless `holds`.
    fn require(self, path: &str, holds: bool, expected: &str) -> Result<()> {
        if holds {
            return Ok(());
        }
        let error = self.source.error(path, "a value is out of range");
        Err(error.found(self.source.found(path)).expected(expected))
    }

    /// A number of at least `least`, where there is one.
    fn at_least(self, path: &str, number: Option<f64>, least: f64) -> Result<()> {
        self.require(path, number.is_none_or(|x| x >= least), &format!("at least {least}"))
    }

    /// A number above 0, where there is one.
    fn above_zero(self, path: &str, number: Option<f64>) -> Result<()> {
        self.require(path, number.is_none_or(|x| x > 0.0), "a number above 0")
    }

    /// Refuses a key that is given though nothing would read it.
    fn unread(self, path: &str, given: bool, why: &str) -> Result<()> {
        if !given {
            return Ok(());
        }
        Err(self.source.error(path, format!("nothing would read this key: {why}")).remedy("remove the key"))
    }

    /// Refuses a missing key; the place is that of the mapping it would be in.
    fn needed(self, path: &str, given: bool, why: &str) -> Result<()> {
        if given {
            return Ok(());
        }
        Err(self.source.error(path, "a key is missing").expected(why))
    }

    /// The one key of several that is given; refuses none and two.
    fn exactly_one<'k>(self, path: &str, keys: &[(&'k str, bool)]) -> Result<&'k str> {
        let names = || keys.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        let mut given = keys.iter().filter(|(_, given)| *given).map(|(name, _)| *name);
        match (given.next(), given.next()) {
            (Some(one), None) => Ok(one),
            (None, _) => {
                let error = self.source.error(path, "a key is missing");
                Err(error.expected(format!("exactly one of {}", names())))
            }
            (Some(one), Some(two)) => {
                let error = self.source.error(&join(path, two), "two keys exclude each other");
                Err(error.found(format!("{one} and {two}")).expected(format!("exactly one of {}", names())))
            }
        }
    }
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}
