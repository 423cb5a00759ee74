//! The shipped presets as classifiers, against labels made by others: a table of agreement and of what was possible.
//!
//! `cargo run --release --example tissue -- DATA_FOLDER [--out FILE]`
//!
//! Nothing is tuned here: tissues and cleaning are those of `pipelines/tissues.yaml`. Exit code 1 if a tissue agrees less
//! than is promised.
#![allow(clippy::print_stderr, reason = "progress of a program that is run by hand")]

mod scans;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use pellucid::io::dicom::SeriesChoice;
use pellucid::io::{load, read_labels};
use pellucid::plan::{Classification, VolumeInfo};
use pellucid::spec::Spec;
use pellucid::tissue::{Agreement, Bound, Comparison, Pair, agreement, bound, classify, clean, mask_of};
use pellucid::volume::LabelMap;
use pellucid::{Error, Fault, Result, Volume};

use scans::{ORGANS, Organ, SCANS, Scan, Subject, positions};

/// Compare the shipped presets with labels made by others
#[derive(Debug, Parser)]
struct Arguments {
    /// The folder of public scans
    data: PathBuf,

    /// The table
    #[arg(long, default_value = "tests/tissue/RESULTS.md")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => {
            eprintln!("a tissue agrees less than is promised: see {}", arguments.out.display());
            ExitCode::from(1)
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.fault().exit_code())
        }
    }
}

/// True if every promise was kept.
fn run(arguments: &Arguments) -> Result<bool> {
    let (mut table, mut kept) = (String::new(), true);
    for scan in &SCANS {
        eprintln!("{}", scan.scan);
        let loaded = Loaded::new(&arguments.data, scan)?;
        for (subject, row) in scan.subjects.iter().zip(loaded.rows()?) {
            kept &= row.keeps(subject);
            let _ = writeln!(table, "{}", row.text(subject, scan.scan));
        }
    }
    let organs = organs(&arguments.data)?;
    let text = format!("{}{table}{}{organs}", include_str!("head.md"), include_str!("organs.md"));
    std::fs::write(&arguments.out, text).map_err(|cause| {
        Error::new(Fault::Output, "the table could not be written").at(&arguments.out).caused_by(cause)
    })?;
    Ok(kept)
}

/// A scan with its reference, and the tissues of the pipeline for it.
struct Loaded {
    volume: Volume,
    reference: LabelMap,
    tissues: Classification,
    subjects: &'static [Subject],
}

impl Loaded {
    fn new(data: &Path, scan: &Scan) -> Result<Self> {
        let source = format!("volume.source={}", data.join(scan.scan).display());
        let spec = Spec::load(Path::new("pipelines/tissues.yaml"), &[source])?;
        let volume = load(&data.join(scan.scan), &SeriesChoice::Largest, None)?.volume;
        let tissues = Classification::new(&spec, &VolumeInfo::from(&volume))?;
        let reference = read_labels(&data.join(scan.reference))?;
        Ok(Loaded { volume, reference, tissues, subjects: scan.subjects })
    }

    fn rows(&self) -> Result<Vec<Row>> {
        let labels = classify(&self.volume, &self.tissues)?;
        let without_gradient = self.agreement(&classify(&self.volume, &self.tissues.without_gradient()?)?)?;
        let by_voxel = self.agreement(&labels)?;
        let cleaned = self.agreement(&clean(labels, &self.volume, &self.tissues)?)?;
        let rows = by_voxel.into_iter().zip(without_gradient).zip(cleaned).zip(self.subjects);
        let row = |(((by_voxel, without_gradient), cleaned), subject): (_, &Subject)| {
            let bound = bound(&self.volume, &mask_of(&self.reference, &positions(&self.reference, subject.labels)))?;
            Ok(Row { by_voxel, without_gradient, cleaned, bound })
        };
        rows.map(row).collect()
    }

    fn agreement(&self, labels: &LabelMap) -> Result<Vec<Agreement>> {
        let pair = |subject: &Subject| Pair {
            tissue: subject.tissue.to_owned(),
            label: labels.position_of(subject.tissue).unwrap_or(0),
            reference: positions(&self.reference, subject.labels),
        };
        let pairs = self.subjects.iter().map(pair).collect();
        agreement(&Comparison::new(labels, &self.reference, pairs)?)
    }
}

/// What was found of a tissue.
struct Row {
    by_voxel: Agreement,
    without_gradient: Agreement,
    cleaned: Agreement,
    bound: Bound,
}

impl Row {
    fn keeps(&self, subject: &Subject) -> bool {
        let at_least = |found: Option<f64>, promised: f64| found.unwrap_or(0.0) >= promised;
        at_least(self.by_voxel.dice, subject.promised) && at_least(self.cleaned.dice, subject.promised_cleaned)
    }

    fn text(&self, subject: &Subject, scan: &str) -> String {
        let three = |number: Option<f64>| number.map_or("-".to_owned(), |number| format!("{number:.3}"));
        let one = |number: Option<f64>| number.map_or("-".to_owned(), |number| format!("{number:.1}"));
        let Row { by_voxel, without_gradient, cleaned, bound } = self;
        format!(
            "| {} | {scan} | {} | {} | {} | {} | {} | {} | {} | {} |",
            subject.tissue,
            three(without_gradient.dice),
            three(Some(bound.by_value)),
            three(by_voxel.dice),
            three(Some(bound.by_value_and_gradient)),
            three(cleaned.dice),
            one(cleaned.difference_percent),
            one(cleaned.hausdorff_95_mm),
            one(cleaned.mean_surface_distance_mm),
        )
    }
}

/// What is possible for organs that no preset is made for.
fn organs(data: &Path) -> Result<String> {
    let volume = load(&data.join(SCANS[0].scan), &SeriesChoice::Largest, None)?.volume;
    let reference = read_labels(&data.join(SCANS[0].reference))?;
    let mut table = String::new();
    for Organ { name, labels } in &ORGANS {
        let mask = mask_of(&reference, &positions(&reference, labels));
        let Bound { by_value, by_value_and_gradient } = bound(&volume, &mask)?;
        let ml = mask.count() as f64 * volume.grid().voxel_mm3() / 1000.0;
        let _ = writeln!(table, "| {name} | {ml:.0} | {by_value:.3} | {by_value_and_gradient:.3} |");
    }
    Ok(table)
}
