//! From a spec to labels and what is in them.

use std::path::{Path, PathBuf};

use super::measure::Stopwatch;
use super::{Options, Progress, StageTime, load};
use crate::error::{Error, Fault, Result};
use crate::io::{LabelFormat, nrrd, write_labels};
use crate::plan::{Classification, VolumeInfo};
use crate::spec::Spec;
use crate::tissue::{self, TissueMeasure};
use crate::volume::{LabelMap, Quantity, Rescale, Samples, Volume};

/// What is not written in the pipeline.
#[derive(Debug, Clone, Default)]
pub struct LabelOptions {
    /// The label map's file, relative to the working directory; none is written by default.
    pub output: Option<PathBuf>,
    /// Names of tissues, and the NRRD files for their memberships.
    pub memberships: Vec<(String, PathBuf)>,
}

/// Labels, and what is known of them.
#[derive(Debug, Clone)]
pub struct Labelled {
    /// The labels.
    pub labels: LabelMap,
    /// What is in them.
    pub tissues: Vec<TissueMeasure>,
    /// Seconds per stage.
    pub stages: Vec<StageTime>,
    /// What a careful user should know.
    pub warnings: Vec<String>,
}

/// Labels the scan of a pipeline by its layers, cleans the labels as the pipeline says, measures them, and writes what is
/// asked for, each file whole or not at all.
///
/// # Errors
/// Those of each stage; names that ask for no format, and memberships of tissues that there are not, before the scan is read.
pub fn classify(spec: &Spec, options: &LabelOptions, progress: Progress<'_>) -> Result<Labelled> {
    if let Some(path) = &options.output {
        LabelFormat::of(path)?;
    }
    options.memberships.iter().try_for_each(|(_, path)| refuse_other_than_nrrd(path))?;
    let mut stopwatch = Stopwatch::start(progress);
    let scan = stopwatch.time("load", || load(spec, &Options::default()))?;
    let volume = &scan.volume;
    let classification = Classification::new(spec, &VolumeInfo::from(volume))?;
    for (name, path) in &options.memberships {
        stopwatch.time("memberships", || write_membership(volume, &classification, name, path))?;
    }
    let labels = stopwatch.time("classify", || tissue::classify(volume, &classification))?;
    let labels = stopwatch.time("clean", || tissue::clean(labels, volume, &classification))?;
    let tissues = stopwatch.time("measure", || tissue::measure(&labels, volume))?;
    if let Some(path) = &options.output {
        stopwatch.time("write", || write_labels(path, &labels))?;
    }
    Ok(Labelled { labels, tissues, stages: stopwatch.finish(), warnings: scan.warnings })
}

fn refuse_other_than_nrrd(path: &Path) -> Result<()> {
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("nrrd")) {
        return Ok(());
    }
    Err(Error::new(Fault::Output, "memberships are written as NRRD").at(path).expected("a name that ends in .nrrd"))
}

fn write_membership(volume: &Volume, classification: &Classification, name: &str, path: &Path) -> Result<()> {
    let tissues = &classification.tissues;
    let tissue = tissues.iter().find(|tissue| tissue.segment.name == name).ok_or_else(|| {
        let names: Vec<&str> = tissues.iter().map(|tissue| tissue.segment.name.as_str()).collect();
        Error::new(Fault::Spec, "there is no such tissue to write the membership of")
            .found(name)
            .expected(format!("one of {}", names.join(", ")))
    })?;
    let samples = Samples::F32(tissue::membership(volume, tissue)?);
    let shares = Volume::new(*volume.grid(), samples, Rescale::IDENTITY, Quantity::Arbitrary)?;
    nrrd::write(path, &shares, nrrd::Encoding::Gzip, &[])
}
