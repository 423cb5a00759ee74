//! `pellucid presets check`: whether files are what they should be.

use std::path::{Path, PathBuf};

use pellucid::interchange::presets;
use pellucid::plan::preset_terms;
use pellucid::spec::load_preset;
use pellucid::{Error, Fault, Result};

use crate::cli::{report, stdout};

/// Arguments of `pellucid presets check`.
#[derive(Debug, clap::Args)]
pub(super) struct Check {
    /// Presets, .yaml files; or files of other programs, as `import` reads them
    #[arg(required = true)]
    files: Vec<PathBuf>,
}

impl Check {
    /// Prints a line per file that is fine, and an error per file that is not.
    pub(super) fn run(&self) -> Result<()> {
        let mut wrong = 0;
        for file in &self.files {
            match verdict(file) {
                Ok(fine) => stdout::print(&format!("{}: {fine}", file.display()))?,
                Err(error) => {
                    report::print(&error);
                    wrong += 1;
                }
            }
        }
        if wrong == 0 {
            return Ok(());
        }
        let error = Error::new(Fault::Spec, "not every file is a preset that can be used");
        Err(error.found(format!("{wrong} of {} with errors", self.files.len())))
    }
}

/// What a file holds: its keys and numbers are right, and its shapes become terms of a transfer function.
fn verdict(file: &Path) -> Result<String> {
    let is_ours = file.extension().is_none_or(|suffix| suffix == "yaml" || suffix == "yml");
    if !is_ours {
        let properties = presets::read(file)?;
        let names: Vec<&str> = properties.iter().map(|property| property.name.as_str()).collect();
        return Ok(format!("{} to import: {}", names.len(), names.join(", ")));
    }
    let preset = load_preset(file)?.preset;
    let terms = preset_terms(&preset).map_err(|error| error.at(file))?;
    let knots = terms.iter().flat_map(|term| term.curve.knots());
    let densest = knots.map(|knot| knot.optics.extinction_per_mm).fold(0.0, f64::max);
    let opacity = -(-densest).exp_m1();
    let gradient = if terms.iter().any(|term| term.weight.is_some()) { ", reads the gradient" } else { "" };
    Ok(format!("{} widgets, {} terms, up to {opacity:.3} opaque per mm{gradient}", preset.widgets.len(), terms.len()))
}
