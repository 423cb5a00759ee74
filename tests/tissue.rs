//! Labels by presets, against definitions and against labels made by others.

mod clean;
mod label_maps;
mod membership;
mod public_scans;
mod scans;

use std::path::Path;

use glam::DVec3;
use pellucid::plan::{Classification, VolumeInfo};
use pellucid::spec::Spec;
use pellucid::volume::{Grid, LabelMap, Quantity, Rescale, Samples, Segment};
use pellucid::{Result, Volume};

/// The tissues of a pipeline for a volume. The volume of the pipeline itself is not read.
fn tissues(layers: &str, volume: &Volume) -> Result<Classification> {
    let text = format!("version: 1\nvolume: {{ phantom: head }}\n{layers}\n");
    let spec = Spec::from_text(&text, Path::new("tissues.yaml"), &[])?;
    Classification::new(&spec, &VolumeInfo::from(volume))
}

/// A volume of 1 mm voxels whose value is a function of the index.
fn volume(dims: [usize; 3], hu: impl Fn([usize; 3]) -> i16) -> Volume {
    let grid = Grid::axis_aligned(dims, DVec3::ONE).expect("a valid grid");
    let samples = (0..grid.voxel_count()).map(|index| hu(grid.unflatten(index))).collect();
    Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).expect("a valid volume")
}

fn segment(name: &str, label: u16) -> Segment {
    Segment { name: name.to_owned(), label, color_srgb: [0.25, 0.5, 1.0], concept: None }
}

/// Labels of a map as files have them.
fn numbers(labels: &LabelMap) -> Vec<u16> {
    labels.voxels().iter().map(|voxel| labels.label_of(*voxel)).collect()
}
