//! `pellucid classify`: a scan and presets to a label map, and what is in it.

use std::path::PathBuf;

use pellucid::pipeline::{self, LabelOptions, Labelled};
use pellucid::spec::Spec;
use pellucid::tissue::TissueMeasure;
use pellucid::{Error, Fault, Result};

use super::progress::Bar;
use super::table::{Table, TableFormat, number};
use super::{Global, stderr, stdout};

/// Arguments of `pellucid classify`.
#[derive(Debug, clap::Args)]
pub(super) struct Classify {
    /// A scan, whose tissues are named by --preset, or a pipeline (.yaml), whose layers are the tissues
    input: PathBuf,

    /// A preset, by name or as a .yaml file; may be repeated
    #[arg(short, long, value_name = "NAME")]
    preset: Vec<String>,

    /// Set a key of the pipeline, such as `clean.bone=[fill-holes]`; the value is YAML. May be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// The label map to write: .seg.nrrd for 3D Slicer, .nrrd, .nii or .nii.gz
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Write the membership of a tissue, from 0 to 1, as NRRD. May be repeated
    #[arg(long, value_name = "TISSUE=FILE", value_parser = named_file)]
    membership: Vec<(String, PathBuf)>,

    /// How the table of tissues is printed
    #[arg(long, value_enum, default_value_t = TableFormat::Text)]
    format: TableFormat,
}

impl Classify {
    /// Labels the scan; the table of tissues goes to stdout.
    pub(super) fn run(&self, global: &Global) -> Result<()> {
        let spec = self.spec()?;
        let options = LabelOptions { output: self.output.clone(), memberships: self.membership.clone() };
        let bar = Bar::new(global.quiet);
        let labelled = pipeline::classify(&spec, &options, &|event| bar.hear(event));
        bar.clear();
        let labelled = labelled?;
        if !global.quiet {
            stderr::say(&summary(&labelled));
        }
        match self.format {
            TableFormat::Text => stdout::print(&table(&labelled.tissues).text()),
            TableFormat::Csv => stdout::print(&table(&labelled.tissues).csv()),
            TableFormat::Json => stdout::print_json(&serde_json::json!({
                "tissues": labelled.tissues,
                "stages": labelled.stages,
                "peak_memory_bytes": pipeline::peak_memory_bytes(),
                "warnings": labelled.warnings,
            })),
        }
    }

    fn spec(&self) -> Result<Spec> {
        let is_pipeline = self.input.extension().is_some_and(|extension| extension == "yaml" || extension == "yml");
        let wrong = |what: &str| Error::new(Fault::Spec, what.to_owned()).at(&self.input).element("--preset");
        match (is_pipeline, self.preset.is_empty()) {
            (true, true) => Spec::load(&self.input, &self.set),
            (false, false) => Spec::of_presets(&self.input, &self.preset, &self.set),
            (true, false) => Err(wrong("the layers of a pipeline are its tissues").remedy("write presets into it")),
            (false, true) => Err(wrong("nothing says which tissues to look for")
                .remedy("name presets, such as --preset bone --preset fat, or give a pipeline")),
        }
    }
}

fn named_file(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((name, path)) if !name.is_empty() && !path.is_empty() => Ok((name.to_owned(), PathBuf::from(path))),
        _ => Err("expected TISSUE=FILE, such as bone=bone.nrrd".to_owned()),
    }
}

fn table(tissues: &[TissueMeasure]) -> Table {
    let mut table =
        Table::new(&["tissue", "label", "voxels", "ml", "mean HU", "SD HU", "surface mm2", "parts", "i", "j", "k"]);
    for tissue in tissues {
        let range = |axis: usize| tissue.bounds.map_or("-".to_owned(), |b| format!("{}..{}", b[axis][0], b[axis][1]));
        table.row(vec![
            tissue.name.clone(),
            tissue.label.to_string(),
            tissue.voxels.to_string(),
            number(Some(tissue.ml), 2),
            number(tissue.mean_hu, 1),
            number(tissue.sd_hu, 1),
            number(Some(tissue.surface_mm2), 0),
            tissue.parts.to_string(),
            range(0),
            range(1),
            range(2),
        ]);
    }
    table
}

fn summary(labelled: &Labelled) -> String {
    let times: Vec<String> = labelled.stages.iter().map(|s| format!("{} {:.2} s", s.stage, s.seconds)).collect();
    let memory = pipeline::peak_memory_bytes().map(|bytes| format!(", at most {} MB of memory", bytes / 1_000_000));
    let mut lines = vec![format!("{}{}", times.join(", "), memory.unwrap_or_default())];
    lines.extend(labelled.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.join("\n")
}
