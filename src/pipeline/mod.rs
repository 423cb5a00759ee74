//! From a spec to a picture: load, plan, clip, integrate, encode, and a sidecar that says how it was made. And from a spec to
//! labels: load, plan, classify, clean, measure, write.

mod analytic;
mod auto;
mod certify;
mod clip;
mod compare;
mod digest;
mod label;
mod load;
mod mask;
mod measure;
pub mod memory;
mod sidecar;
mod stack;
mod study;

use std::cell::OnceCell;
use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Error, Fault, Result};
use crate::image::Image;
use crate::integrate::{self, Rendered, Schedule, Views};
use crate::io::{Scan, exr, png};
use crate::plan::{Format, LabelInfo, Output, Plan, VolumeInfo};
use crate::simd::Level;
use crate::spec::Spec;

pub use certify::Certificate;
pub use clip::Clipped;
pub use compare::{pairs, positions};
pub use label::{LabelOptions, Labelled, classify};
pub use load::load;
pub use measure::{StageTime, peak_memory_bytes};
pub use sidecar::Sidecar;
pub use stack::{StackOutcome, StackSidecar, composite};
pub use study::{VtkPeer, study, write_study};

use crate::study::Choice;
use measure::Stopwatch;
use sidecar::{LabelsRecord, Made, VolumeRecord};

/// What is not written in the pipeline.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The picture's file, relative to the working directory; that of the pipeline by default.
    pub output: Option<PathBuf>,
    /// Most bytes of memory to hold; 80 % of what is free by default.
    pub max_memory_bytes: Option<u64>,
    /// The registers that kernels are run with; the widest of this processor by default. The picture does not depend on it.
    pub level: Option<Level>,
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

/// Renders a pipeline and writes its pictures, in the order of its views, each with a sidecar, and each whole or not at all.
///
/// # Errors
/// Those of each stage; nothing is written if one fails before a picture is complete. `Fault::Limit` before anything
/// is allocated that would not fit into memory. `Fault::Tolerance` if a picture
/// was certified and found not to be within its tolerance; then it and its sidecar are there to be looked at.
pub fn run(spec: &Spec, options: &Options, progress: Progress<'_>) -> Result<Vec<Outcome>> {
    let mut stopwatch = Stopwatch::start(progress);
    let scan = stopwatch.time("load", || load(spec, options))?;
    let (info, plan) = stopwatch.time("plan", || planned(spec, &scan, options))?;
    memory::check(&plan, options)?;
    let (scan, labels) = mask::classified(scan, &plan, &mut stopwatch)?;
    let (plan, choice) = auto::settled((spec, &info), &scan.volume, plan, options, &mut stopwatch)?;
    let clipped = stopwatch.time("normalise", || Clipped::count(&scan.volume, plan.scene.transfer_function.window()));
    prepare_folder(&plan.output.path)?;
    let shared = Shared { spec, scan: &scan, volume: OnceCell::new(), labels, choice, clipped };
    let [_, count] = plan.view;
    let views = Views::new(&scan.volume, &plan.scene, &plan.method, schedule(options))?;
    if count == 1 {
        // What is kept for further views goes as soon as the only one is rendered.
        return Ok(vec![shared.finish(&plan, move |pixels| views.render(pixels), stopwatch)?]);
    }
    let first = shared.finish(&plan, |pixels| views.render(pixels), stopwatch)?;
    let others = (1..count).map(|view| {
        let mut stopwatch = Stopwatch::start(progress);
        let output = options.output.as_deref();
        let plan = stopwatch.time("plan", || plan.of_view(spec, &info, output, view))?;
        shared.finish(&plan, |pixels| views.render_scene(&plan.scene, pixels), stopwatch)
    });
    std::iter::once(Ok(first)).chain(others).collect()
}

/// What all pictures of a run share.
struct Shared<'a> {
    spec: &'a Spec,
    scan: &'a Scan,
    /// Made with the first sidecar: hashing takes one thread a while.
    volume: OnceCell<VolumeRecord>,
    labels: Option<LabelsRecord>,
    choice: Option<Choice>,
    clipped: Clipped,
}

impl Shared<'_> {
    /// Renders a view, and writes its picture and its sidecar.
    fn finish(
        &self,
        plan: &Plan,
        render: impl FnOnce(integrate::Progress<'_>) -> Result<Rendered>,
        mut stopwatch: Stopwatch<'_>,
    ) -> Result<Outcome> {
        let Shared { spec, scan, .. } = *self;
        let progress = stopwatch.progress();
        let rendered = stopwatch.time("integrate", || watched(plan, progress, render))?;
        let pixels_sha256 = digest::of_pixels(&rendered.image);
        let certificate = plan.certify.map(|count| {
            stopwatch.time("certify", || Certificate::of(&rendered.image, &pixels_sha256, &scan.volume, plan, count))
        });
        stopwatch.time("encode", || {
            encode(&rendered.image, &plan.output, &texts(&rendered.statistics.kernel, &pixels_sha256))
        })?;
        let made = Made {
            volume: self.volume.get_or_init(|| VolumeRecord::from(&scan.volume)).clone(),
            labels: self.labels.clone(),
            choice: self.choice.clone(),
            clipped: self.clipped,
            rendered: &rendered,
            pixels_sha256,
            certificate,
            stages: stopwatch.finish(),
        };
        let sidecar = Sidecar::new(spec, scan, plan, made);
        let sidecar_path = sidecar.write_beside(&plan.output.path)?;
        refuse_above_tolerance(&plan.output.path, sidecar.certificate.as_ref())?;
        Ok(Outcome { picture: plan.output.path.clone(), sidecar_path, sidecar })
    }
}

/// Renders a pipeline, of several views the first, and writes nothing.
///
/// # Errors
/// Those of each stage.
pub fn picture(spec: &Spec, progress: Progress<'_>) -> Result<Rendered> {
    let (mut stopwatch, options) = (Stopwatch::start(progress), Options::default());
    let scan = load(spec, &options)?;
    let (info, plan) = planned(spec, &scan, &options)?;
    memory::check(&plan, &options)?;
    let (scan, _) = mask::classified(scan, &plan, &mut stopwatch)?;
    let (plan, _) = auto::settled((spec, &info), &scan.volume, plan, &options, &mut stopwatch)?;
    let views = Views::new(&scan.volume, &plan.scene, &plan.method, schedule(&options))?;
    watched(&plan, progress, |pixels| views.render(pixels))
}

/// The plan for a scan as [`plan`] makes it; where the pipeline leaves the method to measurements, these are made.
///
/// # Errors
/// As [`plan`], and those of the integrators.
pub fn settled_plan(spec: &Spec, scan: Scan, options: &Options) -> Result<Plan> {
    let (info, plan) = planned(spec, &scan, options)?;
    if auto::wanted(spec).is_none() {
        return Ok(plan);
    }
    memory::check(&plan, options)?;
    let mut stopwatch = Stopwatch::start(&|_| ());
    let (scan, _) = mask::classified(scan, &plan, &mut stopwatch)?;
    Ok(auto::settled((spec, &info), &scan.volume, plan, options, &mut stopwatch)?.0)
}

/// The plan for a scan, with its picture where the caller wants it.
///
/// # Errors
/// As [`Plan::new`], and `Fault::Spec` for a picture whose suffix names no format.
pub fn plan(spec: &Spec, scan: &Scan, options: &Options) -> Result<Plan> {
    Ok(planned(spec, scan, options)?.1)
}

/// The plan, and the metadata that it was made for.
fn planned(spec: &Spec, scan: &Scan, options: &Options) -> Result<(VolumeInfo, Plan)> {
    let labels = scan.labels.as_ref().map(LabelInfo::from);
    let info = VolumeInfo { reading_bytes: scan.reading_bytes, labels, ..VolumeInfo::from(&scan.volume) };
    let plan = Plan::new(spec, &info, options.output.as_deref())?;
    Ok((info, plan))
}

fn schedule(options: &Options) -> Schedule {
    Schedule { level: options.level.unwrap_or_else(Level::widest), ..Schedule::default() }
}

/// Renders and says how far it is.
fn watched(
    plan: &Plan,
    progress: Progress<'_>,
    render: impl FnOnce(integrate::Progress<'_>) -> Result<Rendered>,
) -> Result<Rendered> {
    progress(Event::Rays(plan.scene.camera.size().iter().product()));
    render(&|count| progress(Event::Pixels(count)))
}

/// What the picture's file says of itself, for those who have lost its sidecar.
fn texts(kernel: &str, pixels_sha256: &str) -> Vec<(String, String)> {
    let texts = [
        ("Software", concat!("pellucid ", env!("CARGO_PKG_VERSION"))),
        ("pellucid kernel", kernel),
        ("pellucid pixels SHA-256", pixels_sha256),
    ];
    texts.map(|(keyword, text)| (keyword.to_string(), text.to_string())).to_vec()
}

fn encode(image: &Image, output: &Output, texts: &[(String, String)]) -> Result<()> {
    match output.format {
        Format::Png8 => png::write(&output.path, image, png::Depth::Eight, texts),
        Format::Png16 => png::write(&output.path, image, png::Depth::Sixteen, texts),
        Format::Exr => exr::write(&output.path, image, texts),
    }
}

fn refuse_above_tolerance(picture: &Path, certificate: Option<&Certificate>) -> Result<()> {
    match certificate {
        Some(certificate) if certificate.fails() => {
            let Certificate { largest_error, statement, .. } = certificate;
            Err(Error::new(Fault::Tolerance, "the picture is not within its tolerance")
                .at(picture)
                .found(format!("{statement}, the largest error {largest_error:.3e}"))
                .remedy(
                    "report it with the pipeline: the method's bound should have held; a method that integrate: auto \
                    chose has been measured and has none, and integrate: exact has",
                ))
        }
        _ => Ok(()),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_breaks_its_tolerance_is_refused_with_an_exit_code_of_its_own() {
        let certificate = |above| Certificate {
            pixels: 1000,
            largest_error: 0.01,
            error_of_999_in_1000: 0.01,
            rms_error: 0.001,
            above_tolerance: Some(above),
            statement: format!("{above} of 1000 above tolerance"),
        };
        let judged = |above| refuse_above_tolerance(Path::new("a.png"), Some(&certificate(above)));
        assert!(judged(0).is_ok(), "none is above");
        let error = judged(3).expect_err("three are above");
        assert_eq!(error.fault().exit_code(), 9);
        assert!(error.to_string().contains("3 of 1000 above tolerance"), "found {error}");
    }
}
