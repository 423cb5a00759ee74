//! The scan that a spec names.

use crate::error::Result;
use crate::io::{self, Scan, dicom::SeriesChoice};
use crate::spec::{PhantomHead, PhantomRings, PhantomSpec, Series, Spec, VolumeSource};
use crate::synthetic::{self, HeadPhantom};

/// Reads or makes the volume of a spec, its values understood as the spec says.
///
/// # Errors
/// As [`io::load`] and [`synthetic::head`].
pub fn load(spec: &Spec) -> Result<Scan> {
    let scan = match spec.volume_source() {
        VolumeSource::File { path, series } => io::load(&path, &choice(series))?,
        VolumeSource::Phantom(PhantomSpec::Head(head)) => phantom(&head)?,
        VolumeSource::Phantom(PhantomSpec::Rings(PhantomRings { size })) => {
            let volume = synthetic::rings(size.map_or(64, |size| size as usize))?;
            let facts = vec![("format".to_string(), "synthetic rings in colours".to_string())];
            Scan { volume, facts, warnings: Vec::new(), files: Vec::new() }
        }
    };
    Ok(Scan { volume: spec.interpret(scan.volume), ..scan })
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
    Ok(Scan { volume: synthetic::head(&head)?, facts, warnings: Vec::new(), files: Vec::new() })
}
