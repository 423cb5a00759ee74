//! The scan that a spec names.

use super::analytic;
use crate::error::Result;
use crate::io::{self, Scan, dicom::SeriesChoice, dicom::SliceSpacing};
use crate::spec::{PhantomHead, PhantomSpec, Series, SlicesName, Spec, VolumeSource};
use crate::synthetic::{self, HeadPhantom};

/// Reads or makes the volume of a spec, its values understood as the spec says.
///
/// # Errors
/// As [`io::load`] and [`synthetic::head`], and `Fault::Spec` for a formula that cannot be read or sampled.
pub fn load(spec: &Spec) -> Result<Scan> {
    let scan = match spec.volume_source() {
        VolumeSource::File { path, series, slices } => io::load_spaced(&path, &choice(series), spacing(slices))?,
        VolumeSource::Phantom(PhantomSpec::Head(head)) => phantom(&head)?,
        VolumeSource::Analytic(formula) => analytic::load(spec, &formula)?,
    };
    Ok(Scan { volume: spec.interpret(scan.volume), ..scan })
}

fn choice(series: Option<Series>) -> SeriesChoice {
    match series {
        None | Some(Series::Largest) => SeriesChoice::Largest,
        Some(Series::Uid(uid)) => SeriesChoice::Named(uid),
    }
}

fn spacing(slices: Option<SlicesName>) -> SliceSpacing {
    match slices {
        None | Some(SlicesName::Even) => SliceSpacing::Even,
        Some(SlicesName::Uneven) => SliceSpacing::Uneven,
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
    Ok(Scan { volume: synthetic::head(&head)?, facts, warnings: Vec::new(), files: Vec::new() })
}
