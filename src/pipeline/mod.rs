//! From a spec to a picture: load, plan, clip, integrate, encode, and a sidecar that says how it was made.

mod clip;
mod load;
mod measure;
mod sidecar;

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Error, Fault, Result};
use crate::image::Image;
use crate::integrate;
use crate::io::{Scan, exr, png, whole_file};
use crate::plan::{Format, Plan, VolumeInfo};
use crate::spec::Spec;

pub use clip::Clipped;
pub use load::load;
pub use measure::StageTime;
pub use sidecar::Sidecar;

use measure::Stopwatch;

/// What is not written in the pipeline.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The picture's file, relative to the working directory; that of the pipeline by default.
    pub output: Option<PathBuf>,
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// A stage begins.
    Stage(&'static str),
    /// Rays begin, for a picture of so many pixels.
    Rays(usize),
    /// So many pixels more are done.
    Pixels(usize),
}

/// Called with each event, from any thread.
pub type Progress<'a> = &'a (dyn Fn(Event) + Sync);

/// A picture on disk.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The picture.
    pub picture: PathBuf,
    /// The sidecar next to it.
    pub sidecar_path: PathBuf,
    /// What the sidecar says.
    pub sidecar: Sidecar,
}

/// Renders a pipeline and writes the picture with its sidecar, each whole or not at all.
///
/// # Errors
/// Those of each stage; nothing is written if one fails before the picture is complete.
pub fn run(spec: &Spec, options: &Options, progress: Progress<'_>) -> Result<Outcome> {
    let mut stopwatch = Stopwatch::start(progress);
    let scan = stopwatch.time("load", || load(spec))?;
    let plan = stopwatch.time("plan", || plan(spec, &scan, options))?;
    let clipped = stopwatch.time("normalise", || Clipped::count(&scan.volume, plan.scene.transfer_function.window()));
    prepare_folder(&plan.output.path)?;
    progress(Event::Rays(plan.scene.camera.size().iter().product()));
    let pixels = |count| progress(Event::Pixels(count));
    let rendered =
        stopwatch.time("integrate", || integrate::render(&scan.volume, &plan.scene, &plan.method, &pixels))?;
    let encoded = stopwatch.time("encode", || encode(&rendered.image, plan.output.format))?;
    let sidecar = Sidecar::new(spec, &scan, &plan, clipped, &rendered, stopwatch.finish());
    whole_file::write(&plan.output.path, &encoded)?;
    let sidecar_path = sidecar.write_beside(&plan.output.path)?;
    Ok(Outcome { picture: plan.output.path, sidecar_path, sidecar })
}

/// The plan for a scan, with its picture where the caller wants it.
///
/// # Errors
/// As [`Plan::new`], and `Fault::Spec` for a picture whose suffix names no format.
pub fn plan(spec: &Spec, scan: &Scan, options: &Options) -> Result<Plan> {
    Plan::new(spec, &VolumeInfo::from(&scan.volume), options.output.as_deref())
}

fn encode(image: &Image, format: Format) -> Result<Vec<u8>> {
    match format {
        Format::Png8 => png::encode_8(image),
        Format::Png16 => png::encode_16(image),
        Format::Exr => exr::encode(image),
    }
}

/// Makes the picture's folder before the first ray, so that hours of rays do not end at a folder that is not there.
fn prepare_folder(picture: &Path) -> Result<()> {
    let folder = picture.parent().unwrap_or(Path::new(""));
    if folder.as_os_str().is_empty() {
        return Ok(());
    }
    fs::create_dir_all(folder).map_err(|cause| {
        Error::new(Fault::Output, "the folder of the picture could not be made")
            .at(folder)
            .remedy("write elsewhere with -o, or make the folder writable")
            .caused_by(cause)
    })
}
