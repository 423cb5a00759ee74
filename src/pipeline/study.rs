//! A study of a pipeline's scene, and its files.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::measure::Stopwatch;
use super::{Options, load, mask, memory, planned, prepare_folder};
use crate::error::Result;
use crate::io::{png, whole_file};
use crate::plan::Method;
use crate::spec::Spec;
use crate::study::{self, ErrorMap, Family, Progress, Report, Settings, Study};

/// Measures settings and choices on the scene of a pipeline, whose own method is not read. Loading the scan comes before and
/// is not part of `settings.time`.
///
/// # Errors
/// Those of loading and planning, and as [`study::study`].
pub fn study(spec: &Spec, options: &Options, settings: &Settings, progress: Progress<'_>) -> Result<Study> {
    progress("load", 0.0);
    let scan = load(spec, options)?;
    let (_, plan) = planned(spec, &scan, options)?;
    memory::check(&plan, options)?;
    let (scan, _) = mask::classified(scan, &plan, &mut Stopwatch::start(&|_| ()))?;
    let copy_bytes = 4 * scan.volume.samples().len() as u64;
    let fits = memory::limit_bytes(options).is_none_or(|most| plan.memory_bytes() + copy_bytes <= most);
    let settings = Settings { room_for_f32: settings.room_for_f32 && fits, ..*settings };
    study::study(&scan.volume, &plan.scene, &settings, progress)
}

/// Writes a study into a folder, made if it is not there: `study.md`, `study.json`, `settings.csv`, `costs.csv`, the chart
/// `accuracy-against-time` as SVG and PNG, and `errors-….png` for each map. Gives their paths.
///
/// # Errors
/// `Fault::Output` for a file that cannot be written.
pub fn write_study(study: &Study, folder: &Path) -> Result<Vec<PathBuf>> {
    let report = Report(study);
    let chart = report.chart();
    let texts = [
        ("study.md", report.markdown()),
        ("study.json", report.json()?),
        ("settings.csv", report.settings_csv()),
        ("costs.csv", report.costs_csv()),
        ("accuracy-against-time.svg", chart.svg()?),
    ];
    let mut pictures = vec![("accuracy-against-time.png".to_owned(), chart.image()?)];
    pictures.extend(study.maps.iter().map(|map| (map_name(map), map.figure.clone())));
    let mut paths = Vec::new();
    for (name, text) in texts {
        let path = folder.join(name);
        prepare_folder(&path)?;
        whole_file::write(&path, |file| file.write_all(text.as_bytes()))?;
        paths.push(path);
    }
    for (name, picture) in pictures {
        let path = folder.join(name);
        png::write(&path, &picture, png::Depth::Eight, &[])?;
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
