//! `pellucid phantom`: a scan made by formula, as NRRD or as a DICOM series.

use std::path::PathBuf;

use pellucid::Result;
use pellucid::io::dicom::{SeriesDescription, write_series};
use pellucid::io::{labels, nrrd};
use pellucid::pipeline::{self, Options};
use pellucid::spec::{Spec, VolumeSource};
use pellucid::synthetic::{self, BodyPhantom, Region};

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
    Head(Body),
    /// A chest in the arterial phase: ribs, lungs, airways, heart with its chambers, great vessels and liver, in HU
    Chest(Body),
    /// The formula of a pipeline's `volume: { analytic: … }`, sampled
    Analytic(Analytic),
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
#[command(group(clap::ArgGroup::new("target").required(true).multiple(true).args(["nrrd", "dicom", "labels"])))]
struct Body {
    /// Write a NRRD file
    #[arg(long, value_name = "FILE")]
    nrrd: Option<PathBuf>,

    /// Write a DICOM series into a new folder
    #[arg(long, value_name = "DIR")]
    dicom: Option<PathBuf>,

    /// Write the label map: the number and name of the structure at each voxel, as a NRRD segmentation
    #[arg(long, value_name = "FILE")]
    labels: Option<PathBuf>,

    /// Voxels from the patient's right to the left
    #[arg(long, value_name = "N", default_value_t = BodyPhantom::of(Region::Head).size)]
    size: usize,

    /// Chooses the noise; the anatomy is always the same
    #[arg(long, value_name = "SEED", default_value_t = BodyPhantom::of(Region::Head).seed)]
    seed: u64,

    /// Standard deviation of the noise, HU
    #[arg(long, value_name = "HU", default_value_t = BodyPhantom::of(Region::Head).noise_hu)]
    noise_hu: f64,
}

#[derive(Debug, clap::Args)]
struct Analytic {
    /// The pipeline, a YAML file
    pipeline: PathBuf,

    /// Set a key of the pipeline, such as `volume.analytic.size=64`; the value is YAML. May be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// Write a NRRD file
    #[arg(long, value_name = "FILE")]
    nrrd: PathBuf,
}

impl Phantom {
    /// Makes the scan and writes it; the paths written go to stdout.
    pub(super) fn run(&self) -> Result<()> {
        match &self.kind {
            Kind::Head(body) => body.run(Region::Head),
            Kind::Chest(body) => body.run(Region::Chest),
            Kind::Analytic(analytic) => analytic.run(),
            Kind::Rings(rings) => {
                nrrd::write(&rings.nrrd, &synthetic::rings(rings.size)?, nrrd::Encoding::Gzip, &[])?;
                stdout::print(&rings.nrrd.display().to_string())
            }
        }
    }
}

impl Body {
    fn run(&self, region: Region) -> Result<()> {
        if let Some(path) = &self.labels {
            let segments = labels::segments(region.structures());
            nrrd::write(path, &synthetic::body_labels(region, self.size)?, nrrd::Encoding::Gzip, &segments)?;
            stdout::print(&path.display().to_string())?;
        }
        if self.nrrd.is_none() && self.dicom.is_none() {
            return Ok(());
        }
        let Body { size, seed, noise_hu, .. } = *self;
        let volume = synthetic::body(&BodyPhantom { region, size, seed, noise_hu })?;
        if let Some(path) = &self.nrrd {
            nrrd::write(path, &volume, nrrd::Encoding::Gzip, &[])?;
            stdout::print(&path.display().to_string())?;
        }
        if let Some(folder) = &self.dicom {
            let description = SeriesDescription { description: format!("pellucid {} phantom", region.name()), seed };
            write_series(folder, &volume, &description)?;
            stdout::print(&folder.display().to_string())?;
        }
        Ok(())
    }
}

impl Analytic {
    fn run(&self) -> Result<()> {
        let spec = Spec::load(&self.pipeline, &self.set)?;
        if !matches!(spec.volume_source(), VolumeSource::Analytic(_)) {
            return Err(spec.error("volume", "the volume of this pipeline is no formula").expected("the key analytic"));
        }
        let scan = pipeline::load(&spec, &Options::default())?;
        nrrd::write(&self.nrrd, &scan.volume, nrrd::Encoding::Gzip, &[])?;
        stdout::print(&self.nrrd.display().to_string())
    }
}
