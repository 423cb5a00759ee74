//! `pellucid phantom`: a scan made by formula, as NRRD or as a DICOM series.

use std::path::PathBuf;

use pellucid::Result;
use pellucid::io::dicom::{SeriesDescription, write_series};
use pellucid::io::{labels, nrrd};
use pellucid::synthetic::{self, HeadPhantom};

use super::stdout;

/// Arguments of `pellucid phantom`.
#[derive(Debug, clap::Args)]
pub(super) struct Phantom {
    #[command(subcommand)]
    kind: Kind,
}

#[derive(Debug, clap::Subcommand)]
enum Kind {
    /// A head: skin, skull, brain, ventricles, airways and teeth, in HU
    Head(Head),
}

#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("target").required(true).multiple(true).args(["nrrd", "dicom", "labels"])))]
struct Head {
    /// Write a NRRD file
    #[arg(long, value_name = "FILE")]
    nrrd: Option<PathBuf>,

    /// Write a DICOM series into a new folder
    #[arg(long, value_name = "DIR")]
    dicom: Option<PathBuf>,

    /// Write the label map: the number and name of the structure at each voxel, as a NRRD segmentation
    #[arg(long, value_name = "FILE")]
    labels: Option<PathBuf>,

    /// Voxels from ear to ear
    #[arg(long, value_name = "N", default_value_t = HeadPhantom::default().size)]
    size: usize,

    /// Chooses the noise; the anatomy is always the same
    #[arg(long, value_name = "SEED", default_value_t = HeadPhantom::default().seed)]
    seed: u64,

    /// Standard deviation of the noise, HU
    #[arg(long, value_name = "HU", default_value_t = HeadPhantom::default().noise_hu)]
    noise_hu: f64,
}

impl Phantom {
    /// Makes the scan and writes it; the paths written go to stdout.
    pub(super) fn run(&self) -> Result<()> {
        let Kind::Head(head) = &self.kind;
        if let Some(path) = &head.labels {
            let segments = labels::segments(synthetic::head_structures());
            nrrd::write(path, &synthetic::head_labels(head.size)?, nrrd::Encoding::Gzip, &segments)?;
            stdout::print(&path.display().to_string())?;
        }
        if head.nrrd.is_none() && head.dicom.is_none() {
            return Ok(());
        }
        let volume = synthetic::head(&HeadPhantom { size: head.size, seed: head.seed, noise_hu: head.noise_hu })?;
        if let Some(path) = &head.nrrd {
            nrrd::write(path, &volume, nrrd::Encoding::Gzip, &[])?;
            stdout::print(&path.display().to_string())?;
        }
        if let Some(folder) = &head.dicom {
            let description = SeriesDescription { description: "pellucid head phantom".to_string(), seed: head.seed };
            write_series(folder, &volume, &description)?;
            stdout::print(&folder.display().to_string())?;
        }
        Ok(())
    }
}
