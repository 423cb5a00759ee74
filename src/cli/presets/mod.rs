//! `pellucid presets`: the transfer functions that come with pellucid.

mod check;
mod export;
mod import;

use std::path::PathBuf;

use pellucid::io::dicom::SeriesChoice;
use pellucid::io::{load, read_labels};
use pellucid::pipeline;
use pellucid::spec::{BUILT_IN_PRESETS, LoadedPreset, ReferenceTissues, built_in_preset};
use pellucid::tissue::{fit, mask_of};
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
    /// Propose widgets for a tissue from a scan whose labels are known
    Fit(Fit),
    /// Make presets of those of 3D Slicer (.vp, .vp.json, presets.xml) and ParaView (.json)
    Import(import::Import),
    /// Write a preset for 3D Slicer or ParaView, over the value alone, and say what that loses
    Export(export::Export),
    /// Check preset files: keys, numbers, shapes
    Check(check::Check),
}

#[derive(Debug, clap::Args)]
struct Fit {
    /// The scan
    scan: PathBuf,

    /// Its labels: .seg.nrrd, .nrrd, .nii or .nii.gz
    labels: PathBuf,

    /// Which tissue of the labels, by name; a number where they have no names
    #[arg(long, value_name = "NAME")]
    tissue: String,

    /// Which labels make up which tissue, a YAML file as for `evaluate`
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
}

impl Presets {
    /// Does what its action says.
    pub(super) fn run(&self) -> Result<()> {
        match &self.action {
            Action::List => stdout::print(&list()?),
            Action::Show { name } => stdout::print(&named(name)?.text),
            Action::Fit(fit) => stdout::print(&fit.proposal()?),
            Action::Import(import) => import.run(),
            Action::Export(export) => export.run(),
            Action::Check(check) => check.run(),
        }
    }
}

impl Fit {
    /// A preset to begin from: its shapes are what labels and scan say, its opacity and colour are anyone's.
    fn proposal(&self) -> Result<String> {
        let labels = read_labels(&self.labels)?;
        let positions = match &self.map {
            Some(path) => pipeline::positions(&labels, &ReferenceTissues::load(path)?, &self.tissue)?,
            None => labels.position_of(&self.tissue).into_iter().collect(),
        };
        let volume = load(&self.scan, &SeriesChoice::Largest, None)?.volume;
        let proposals = fit(&volume, &mask_of(&labels, &positions)).map_err(|error| error.element(&self.tissue))?;
        let dice: Vec<String> = proposals.iter().map(|proposal| format!("{:.3}", proposal.dice)).collect();
        let mut text = format!(
            "# Proposed from labels; Dice on that scan, widget by widget: {}. Opacity and colour are yours to choose.\n\
             version: 1\nname: {}\nwidgets:\n",
            dice.join(", "),
            serde_json::json!(self.tissue),
        );
        for proposal in &proposals {
            let (hu, gradient) = proposal.trapezoid();
            text.push_str(&format!("  - trapezoid: {{ hu: {hu:?}, gradient_hu_per_mm: {gradient:?} }}\n"));
            text.push_str("    opacity_per_mm: 0.3\n    color: \"#cccccc\"\n");
        }
        Ok(text)
    }
}

fn list() -> Result<String> {
    let widest = BUILT_IN_PRESETS.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let presets = BUILT_IN_PRESETS.iter().filter_map(|(name, _)| built_in_preset(name));
    let line = |loaded: Result<LoadedPreset>| {
        let preset = loaded?.preset;
        Ok(format!("{:widest$}  {}", preset.name, preset.description.unwrap_or_default()))
    };
    Ok(presets.map(line).collect::<Result<Vec<String>>>()?.join("\n"))
}

/// A preset that comes along, or an error that suggests one.
fn named(name: &str) -> Result<LoadedPreset> {
    if let Some(preset) = built_in_preset(name) {
        return preset;
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
