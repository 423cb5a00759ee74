//! `pellucid presets`: the transfer functions that come with pellucid.

use pellucid::spec::{BUILT_IN_PRESETS, built_in_preset};
use pellucid::{Error, Fault, Result};

use super::stdout;

/// Arguments of `pellucid presets`.
#[derive(Debug, clap::Args)]
pub(super) struct Presets {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, clap::Subcommand)]
enum Action {
    /// List their names and what they show
    List,
    /// Print one as YAML, to begin one's own from
    Show {
        /// Its name
        name: String,
    },
}

impl Presets {
    /// Prints the list or the preset.
    pub(super) fn run(&self) -> Result<()> {
        match &self.action {
            Action::List => stdout::print(&list()?),
            Action::Show { name } => stdout::print(text(name)?),
        }
    }
}

fn list() -> Result<String> {
    let widest = BUILT_IN_PRESETS.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let presets = BUILT_IN_PRESETS.iter().filter_map(|(name, _)| built_in_preset(name));
    let line = |loaded: Result<pellucid::spec::LoadedPreset>| {
        let preset = loaded?.preset;
        Ok(format!("{:widest$}  {}", preset.name, preset.description.unwrap_or_default()))
    };
    Ok(presets.map(line).collect::<Result<Vec<String>>>()?.join("\n"))
}

fn text(name: &str) -> Result<&'static str> {
    if let Some((_, text)) = BUILT_IN_PRESETS.iter().find(|(known, _)| *known == name) {
        return Ok(text);
    }
    let names: Vec<&str> = BUILT_IN_PRESETS.iter().map(|(name, _)| *name).collect();
    let similarity = |known: &&str| strsim::jaro_winkler(known, name);
    let nearest = names.iter().copied().max_by(|a, b| similarity(a).total_cmp(&similarity(b)));
    let error =
        Error::new(Fault::Spec, "there is no such preset").found(name).expected(format!("one of {}", names.join(", ")));
    Err(match nearest.filter(|known| similarity(known) > 0.7) {
        Some(known) => error.remedy(format!("did you mean {known}?")),
        None => error,
    })
}
