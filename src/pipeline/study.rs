//! A study of a pipeline's scene, and its files.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::measure::Stopwatch;
use super::{Options, load, mask, memory, planned, prepare_folder};
use crate::chart;
use crate::error::{Error, Fault, Result};
use crate::image::Image;
use crate::interchange::vtk::{self, Frames, Mapper};
use crate::io::{picture, png, whole_file};
use crate::plan::{Method, Plan};
use crate::spec::Spec;
use crate::study::{self, ErrorMap, Family, Peer, Progress, Report, Settings, Study};
use crate::volume::Volume;

/// Another program whose points a study has, too.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VtkPeer {
    /// The Python that has VTK.
    pub python: PathBuf,
    /// Which of its renderers.
    pub mapper: Mapper,
}

/// Measures settings and choices on the scene of a pipeline, whose own method is not read. Loading the scan comes before and
/// is not part of `settings.time`, nor is the start of `peers`.
///
/// # Errors
/// Those of loading and planning, of [`vtk::export`] and [`Frames`], and as [`study::study`].
pub fn study(
    spec: &Spec,
    options: &Options,
    settings: &Settings,
    peers: &[VtkPeer],
    progress: Progress<'_>,
) -> Result<Study> {
    progress("load", 0.0);
    let scan = load(spec, options)?;
    let (_, plan) = planned(spec, &scan, options)?;
    memory::check(&plan, options)?;
    let (scan, _) = mask::classified(scan, &plan, &mut Stopwatch::start(&|_| ()))?;
    let copy_bytes = 4 * scan.volume.samples().len() as u64;
    let fits = memory::limit_bytes(options).is_none_or(|most| plan.memory_bytes() + copy_bytes <= most);
    let settings = Settings { room_for_f32: settings.room_for_f32 && fits, ..*settings };
    let mut started: Vec<Box<dyn Peer>> = Vec::new();
    for (place, peer) in peers.iter().enumerate() {
        progress("starting VTK", 0.0);
        started.push(Box::new(Started::new(peer, &scan.volume, &plan, place)?));
    }
    study::study(&scan.volume, &plan.scene, &settings, &mut started, progress)
}

/// VTK with the exported scene, in a folder that goes with it.
struct Started {
    name: String,
    folder: PathBuf,
    frames: Option<Frames>,
}

impl Started {
    fn new(peer: &VtkPeer, volume: &Volume, plan: &Plan, place: usize) -> Result<Self> {
        let folder = std::env::temp_dir().join(format!("pellucid-study-{}-{place}", std::process::id()));
        let mut started = Started { name: String::new(), folder, frames: None };
        let script = vtk::export(&started.folder, volume, plan)?;
        let frames = Frames::start(&peer.python, &script, peer.mapper, rayon::current_num_threads())?;
        let mapper = match peer.mapper {
            Mapper::Gpu => "GPU mapper",
            Mapper::Cpu => "CPU mapper",
        };
        started.name = format!("VTK {}, {mapper}", frames.version);
        started.frames = Some(frames);
        Ok(started)
    }
}

impl Peer for Started {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn render(&mut self, step_mm: f64) -> Result<(Image, f64)> {
        let output = self.folder.join("frame.npy");
        let frames = self.frames.as_mut().ok_or_else(|| Error::new(Fault::Internal, "VTK has not been started"))?;
        let seconds = frames.seconds(step_mm, Some(&output))?;
        Ok((picture::read(&output)?.image, seconds))
    }
}

impl Drop for Started {
    fn drop(&mut self) {
        drop(self.frames.take());
        // The measurements are in memory; a folder that stays behind is no reason to fail.
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// Writes a study into a folder, made if it is not there: `study.md`, `study.json`, `settings.csv`, `costs.csv`, the chart
/// `accuracy-against-time` as SVG and PNG, and `errors-….png` for each map. Gives their paths.
///
/// # Errors
/// `Fault::Output` for a file that cannot be written.
pub fn write_study(study: &Study, folder: &Path) -> Result<Vec<PathBuf>> {
    let report = Report(study);
    let chart = report.chart().svg();
    let texts = [
        ("study.md", report.markdown()),
        ("study.json", report.json()?),
        ("settings.csv", report.settings_csv()),
        ("costs.csv", report.costs_csv()),
        ("accuracy-against-time.svg", chart.clone()),
    ];
    let mut paths = Vec::new();
    for (name, text) in texts {
        let path = folder.join(name);
        prepare_folder(&path)?;
        whole_file::write(&path, |file| file.write_all(text.as_bytes()))?;
        paths.push(path);
    }
    let path = folder.join("accuracy-against-time.png");
    chart::write_png(&path, &chart)?;
    paths.push(path);
    for map in &study.maps {
        let path = folder.join(map_name(map));
        png::write(&path, &map.figure, png::Depth::Eight, &[])?;
        paths.push(path);
    }
    Ok(paths)
}

/// `errors-exact-0.003922.png`, or `errors-march-midpoint-0.4mm.png`.
fn map_name(map: &ErrorMap) -> String {
    let fineness = match map.rung.method {
        Method::Exact(exact) => format!("{:.4}", exact.tolerance),
        Method::March(march) => format!("{:.4}mm", march.step_mm),
        Method::Reference => String::new(),
    };
    let family = match map.rung.family {
        Family::Left => "march-left",
        Family::Midpoint => "march-midpoint",
        Family::Trapezoid => "march-trapezoid",
        Family::Jitter => "march-jitter",
        Family::Exact => "exact",
    };
    format!("errors-{family}-{fineness}.png")
}
