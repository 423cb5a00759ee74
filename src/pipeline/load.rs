//! The scan that a spec names.

use super::{Options, analytic, memory};
use crate::error::Result;
use crate::io::{self, Labels, Scan, dicom::SeriesChoice, dicom::SliceSpacing};
use crate::spec::{MaskPhantom, PhantomBody, PhantomRings, PhantomSpec, Series, SlicesName, Spec, VolumeSource};
use crate::synthetic::{self, BodyPhantom, Region};

/// Reads or makes the volume of a spec, its values understood as the spec says.
///
/// # Errors
/// As [`io::load`], [`io::labels::read`] and [`synthetic::body`], and `Fault::Spec` for a formula that cannot be read or
/// sampled; `Fault::Limit` for a scan that takes more memory than the options allow.
pub fn load(spec: &Spec, options: &Options) -> Result<Scan> {
    let max_bytes = memory::limit_bytes(options);
    let scan = match spec.volume_source() {
        VolumeSource::File { path, series, slices } => {
            io::load_spaced(&path, &choice(series), spacing(slices), max_bytes)?
        }
        VolumeSource::Phantom(PhantomSpec::Head(body)) => phantom(Region::Head, &body, max_bytes)?,
        VolumeSource::Phantom(PhantomSpec::Chest(body)) => phantom(Region::Chest, &body, max_bytes)?,
        VolumeSource::Phantom(PhantomSpec::Rings(PhantomRings { size })) => {
            let size = size.map_or(64, |size| size as usize);
            let reading_bytes = 4 * (size as u64).pow(3);
            memory::refuse_beyond(max_bytes, reading_bytes, "volume.phantom.rings.size")?;
            let facts = vec![("format".to_string(), "synthetic rings in colours".to_string())];
            Scan {
                volume: synthetic::rings(size)?,
                labels: None,
                facts,
                warnings: Vec::new(),
                files: Vec::new(),
                reading_bytes,
            }
        }
        VolumeSource::Analytic(formula) => analytic::load(spec, &formula, max_bytes)?,
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
            let region = match spec.volume_source() {
                VolumeSource::Phantom(PhantomSpec::Chest(_)) => Region::Chest,
                _ => Region::Head,
            };
            let names = region.structures().map(|(label, name)| (name.to_owned(), label));
            Labels::new(synthetic::body_labels(region, scan.volume.grid().dims()[0])?, names).map(Some)
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

fn spacing(slices: Option<SlicesName>) -> SliceSpacing {
    match slices {
        None | Some(SlicesName::Even) => SliceSpacing::Even,
        Some(SlicesName::Uneven) => SliceSpacing::Uneven,
    }
}

fn phantom(region: Region, body: &PhantomBody, max_bytes: Option<u64>) -> Result<Scan> {
    let default = BodyPhantom::of(region);
    let phantom = BodyPhantom {
        size: body.size.map_or(default.size, |size| size as usize),
        seed: body.seed.unwrap_or(default.seed),
        ..default
    };
    let facts = [
        ("format", format!("synthetic {}", region.name())),
        ("seed", phantom.seed.to_string()),
        ("noise", format!("{} HU", phantom.noise_hu)),
    ];
    let facts = facts.map(|(label, text)| (label.to_string(), text)).to_vec();
    let reading_bytes = phantom.making_bytes()?;
    memory::refuse_beyond(max_bytes, reading_bytes, &format!("volume.phantom.{}.size", region.name()))?;
    let volume = synthetic::body(&phantom)?;
    Ok(Scan { volume, labels: None, facts, warnings: Vec::new(), files: Vec::new(), reading_bytes })
}
