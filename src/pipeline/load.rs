//! The scan that a spec names.

use crate::error::Result;
use crate::io::{self, Labels, Scan, dicom::SeriesChoice};
use crate::spec::{MaskPhantom, PhantomHead, PhantomSpec, Series, Spec, VolumeSource};
use crate::synthetic::{self, HeadPhantom};

/// Reads or makes the volume of a spec, its values understood as the spec says.
///
/// # Errors
/// As [`io::load`], [`io::labels::read`] and [`synthetic::head`].
pub fn load(spec: &Spec) -> Result<Scan> {
    let scan = match spec.volume_source() {
        VolumeSource::File { path, series } => io::load(&path, &choice(series))?,
        VolumeSource::Phantom(PhantomSpec::Head(head)) => phantom(&head)?,
    };
    let labels = labels(spec, &scan)?;
    Ok(Scan { volume: spec.interpret(scan.volume), labels, ..scan })
}

/// The labels that a mask asks for.
fn labels(spec: &Spec, scan: &Scan) -> Result<Option<Labels>> {
    let mask = spec.pipeline.effects.as_ref().and_then(|effects| effects.mask.as_ref());
    match (spec.labels_path(), mask.and_then(|mask| mask.phantom)) {
        (Some(path), _) => io::labels::read(&path, scan.volume.grid()).map(Some),
        (None, Some(MaskPhantom::Structures)) => {
            let names = synthetic::head_structures().map(|(label, name)| (name.to_owned(), label));
            Labels::new(synthetic::head_labels(scan.volume.grid().dims()[0])?, names).map(Some)
        }
        (None, None) => Ok(None),
    }
}

fn choice(series: Option<Series>) -> SeriesChoice {
    match series {
        None | Some(Series::Largest) => SeriesChoice::Largest,
        Some(Series::Uid(uid)) => SeriesChoice::Named(uid),
    }
}

fn phantom(head: &PhantomHead) -> Result<Scan> {
    let default = HeadPhantom::default();
    let head = HeadPhantom {
        size: head.size.map_or(default.size, |size| size as usize),
        seed: head.seed.unwrap_or(default.seed),
        ..default
    };
    let facts = [
        ("format", "synthetic head".to_string()),
        ("seed", head.seed.to_string()),
        ("noise", format!("{} HU", head.noise_hu)),
    ];
    let facts = facts.map(|(label, text)| (label.to_string(), text)).to_vec();
    Ok(Scan { volume: synthetic::head(&head)?, labels: None, facts, warnings: Vec::new(), files: Vec::new() })
}
