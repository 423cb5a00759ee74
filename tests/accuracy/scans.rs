//! The public scans, as the table needs them.

use std::path::{Path, PathBuf};

use pellucid::io::dicom::SeriesChoice;
use pellucid::io::load;
use pellucid::volume::{Quantity, Rescale};
use pellucid::{Result, Volume};

/// A scan by name.
pub(crate) struct Source {
    pub(crate) name: &'static str,
    pub(crate) path: PathBuf,
    /// Values of the file minus HU, for a scan in HU.
    shift: Option<f64>,
}

/// All scans of the folder, in the order of the table.
pub(crate) fn sources(data: &Path, skull: Option<&Path>) -> Vec<Source> {
    let hu = |name, path: &str, shift| Source { name, path: data.join(path), shift: Some(shift) };
    let other = |name, path: &str| Source { name, path: data.join(path), shift: None };
    let mut sources = vec![
        hu("thorax", "thorax-dicom", 0.0),
        hu("abdomen", "abdomen/ct.nrrd", 0.0),
        hu("head", "head/quarter.nhdr", 1024.0),
        other("tooth", "tooth.nrrd"),
        other("engine", "engine.nrrd"),
        other("bonsai", "bonsai.nrrd"),
    ];
    sources.extend(skull.map(|path| Source { name: "skull", path: path.to_path_buf(), shift: Some(0.0) }));
    sources
}

impl Source {
    /// The volume, in HU or declared to be something else.
    pub(crate) fn load(&self) -> Result<Volume> {
        let volume = load(&self.path, &SeriesChoice::Largest, None)?.volume;
        let Rescale { slope, intercept } = volume.rescale();
        Ok(match self.shift {
            Some(shift) => {
                volume.with_rescale(Rescale { slope, intercept: intercept - shift }).with_quantity(Quantity::Hu)
            }
            None => volume.with_quantity(Quantity::Arbitrary),
        })
    }
}
