//! `pellucid phantom`: a scan made by formula, as NRRD or as a DICOM series.

use std::path::PathBuf;

use pellucid::Result;
use pellucid::io::dicom::{SeriesDescription, write_series};
use pellucid::io::nrrd;
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
    /// Three rings in changing colours: an RGBA volume
    Rings(Rings),
}

#[derive(Debug, clap::Args)]
struct Rings {
    /// Write a NRRD file
    #[arg(long, value_name = "FILE")]
    nrrd: PathBuf,

    /// Voxels along each side
    #[arg(long, value_name = "N", default_value_t = 64)]
    size: usize,
}

#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("target").required(true).multiple(true).args(["nrrd", "dicom"])))]
struct Head {
    /// Write a NRRD file
    #[arg(long, value_name = "FILE")]
    nrrd: Option<PathBuf>,

    /// Write a DICOM series into a new folder
    #[arg(long, value_name = "DIR")]
    dicom: Option<PathBuf>,

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
        let head = match &self.kind {
            Kind::Head(head) => head,
            Kind::Rings(rings) => {
                nrrd::write(&rings.nrrd, &synthetic::rings(rings.size)?, nrrd::Encoding::Gzip, &[])?;
                return stdout::print(&rings.nrrd.display().to_string());
            }
        };
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
