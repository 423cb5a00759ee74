//! Against VTK: its pictures of the scenes in `vtk/scenes`, as `vtk/generate.py` rendered them, and pellucid's march with
//! its conventions. Neither Python nor VTK is needed here.

mod beyond;
mod changes;
mod exports;
mod pictures;

use std::path::{Path, PathBuf};

use pellucid::image::metrics::{Comparison, compare_as_seen};
use pellucid::io::png;
use pellucid::pipeline;
use pellucid::spec::Spec;
use pellucid::{Error, Image};

use crate::support;

/// What a picture is held to, in steps of 8 bits.
#[derive(Debug, Clone, Copy)]
struct Limits {
    max: f64,
    rms: f64,
    /// For all pixels but one in 1000.
    most: f64,
}

/// Of emission and absorption.
const UNLIT: Limits = Limits { max: 2.0, rms: 0.5, most: 2.0 };
/// With shading.
const LIT: Limits = Limits { max: f64::INFINITY, rms: 1.0, most: 4.0 };

/// Scenes that VTK's rounding moves by more than 2/255: its shader adds positions up in f32, and shells of a few HU or
/// hundreds of steps magnify that. `vtk/conventions.py` shows it ray by ray.
const ROUNDED: [(&str, Limits); 2] = [
    ("head-thin-shells", Limits { max: 6.0, rms: 0.5, most: 4.0 }),
    ("head-fine", Limits { max: 3.0, rms: 0.5, most: 2.0 }),
];

impl Limits {
    fn of(name: &str, lit: bool) -> Self {
        match ROUNDED.iter().find(|(rounded, _)| *rounded == name) {
            Some((_, limits)) => *limits,
            None if lit => LIT,
            None => UNLIT,
        }
    }

    /// Why a comparison is not within them, `None` if it is.
    fn objection(self, comparison: &Comparison) -> Option<String> {
        let steps = |d: f64| 255.0 * d;
        let [max, most, rms] = [comparison.max_abs_all, comparison.error_of_999_in_1000, comparison.rms_all].map(steps);
        let within = max <= self.max && most <= self.most && rms <= self.rms;
        (!within).then(|| format!("largest {max:.3}, 99.9 % below {most:.3}, RMS {rms:.4}, all /255; allowed {self:?}"))
    }
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vtk").join(name)
}

/// The names of all scenes, sorted.
fn scenes() -> Vec<String> {
    let entries = std::fs::read_dir(folder("scenes")).expect("the scenes are there");
    let stem = |path: PathBuf| path.file_stem().expect("a name").to_string_lossy().into_owned();
    let mut names: Vec<String> = entries.map(|entry| stem(entry.expect("readable").path())).collect();
    names.sort();
    names
}

/// A scene with overrides, its scan where that is; `None` if it is not on this machine.
fn spec(name: &str, overrides: &[&str]) -> Option<Spec> {
    let path = folder("scenes").join(format!("{name}.yaml"));
    let text = std::fs::read_to_string(&path).expect("the scene is readable");
    let mut all: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    if let Some((_, after)) = text.split_once("shared/data/") {
        let scan = after.split([' ', ',', '}']).next().expect("a path");
        all.push(format!("volume.source={}", support::scan_path(scan)?.display()));
    }
    Some(Spec::load(&path, &all).unwrap_or_else(|error| panic!("{name}: {error}")))
}

fn rendered(spec: &Spec) -> Result<Image, Error> {
    pipeline::picture(spec, &|_| ()).map(|rendered| rendered.image)
}

/// VTK's picture of a scene by its GPU mapper.
fn reference(name: &str) -> Image {
    png::read(&folder("references").join(format!("{name}.gpu.png"))).expect("the reference is readable").image
}

/// A scene's march, with overrides, against VTK's picture of the scene without.
fn against_vtk(name: &str, overrides: &[&str]) -> Option<Comparison> {
    let image = rendered(&spec(name, overrides)?).unwrap_or_else(|error| panic!("{name}: {error}"));
    Some(compare_as_seen(&reference(name), &image, 2.0 / 255.0).expect("one size"))
}
