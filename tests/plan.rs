//! What will be done: cameras, framing, transfer functions, demand, and the plan in words.

use std::path::Path;

use glam::DVec3;
use pellucid::plan::{Plan, Storage, VolumeInfo};
use pellucid::spec::Spec;
use pellucid::volume::{Grid, Quantity, Rescale};

mod camera;
mod clip;
mod colors;
mod demand;
mod effects;
mod explain;
mod gallery;
mod mask;
mod method;
mod shapes;
mod show;
mod transfer_function;

/// A pipeline of one opaque bone widget, and whatever follows.
fn pipeline(rest: &str) -> String {
    let head = "version: 1\nvolume: { phantom: head }\n";
    let widgets = "transfer_function:\n  - widgets:\n      \
                   - { rectangle: { hu: [300, 3000] }, extinction_per_mm: 2, color: white }\n";
    if rest.contains("transfer_function:") { format!("{head}{rest}") } else { format!("{head}{widgets}{rest}") }
}

/// 64 x 48 x 33 voxels of 1 x 2 x 3 mm in HU.
fn volume() -> VolumeInfo {
    VolumeInfo {
        uneven_slices_mm: None,
        grid: Grid::axis_aligned([64, 48, 33], DVec3::new(1.0, 2.0, 3.0)).unwrap(),
        storage: Storage::I16,
        rescale: Rescale::IDENTITY,
        value_range: [-1000.0, 1800.0],
        quantity: Quantity::Hu,
        reading_bytes: 2 * 64 * 48 * 33,
        labels: None,
    }
}

fn spec(rest: &str) -> Spec {
    Spec::from_text(&pipeline(rest), Path::new("pipelines/scene.yaml"), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn plan(rest: &str) -> Plan {
    Plan::new(&spec(rest), &volume(), None).unwrap_or_else(|error| panic!("{error}"))
}
