//! From what a plan says to the types of a kernel, once per frame.

use super::empty_space::EmptySpace;
use super::march::Kernel;
use super::shade::{Lit, Shader, Unlit};
use super::{Frame, KernelName, Rendered, Statistics};
use crate::classify::{Baked, Classifier, bake};
use crate::error::Result;
use crate::field::{GradientUnits, Macrocells, SliceTable, Spacing, Trilinear, Voxel, gradient_magnitude_per_mm};
use crate::plan::March;
use crate::volume::Samples;

/// Renders by marching.
pub(super) fn march(frame: &Frame<'_>, settings: &March) -> Result<Rendered> {
    match frame.volume.samples() {
        Samples::I16(voxels) => by_classifier(frame, settings, voxels),
        Samples::F32(voxels) => by_classifier(frame, settings, voxels),
    }
}

fn by_classifier<V: Voxel>(frame: &Frame<'_>, settings: &March, voxels: &[V]) -> Result<Rendered> {
    match bake(&frame.scene.transfer_function, frame.volume.rescale()) {
        Baked::OneD(classifier) => by_shader(frame, settings, voxels, &classifier),
        Baked::TwoD(classifier) => by_shader(frame, settings, voxels, &classifier),
    }
}

fn by_shader<V: Voxel, C: Classifier<f32>>(
    frame: &Frame<'_>,
    settings: &March,
    voxels: &[V],
    classifier: &C,
) -> Result<Rendered> {
    match &frame.scene.shading {
        None => by_spacing(frame, settings, voxels, classifier, &Unlit),
        Some(shading) => by_spacing(frame, settings, voxels, classifier, &Lit::new(shading)),
    }
}

fn by_spacing<V: Voxel, C: Classifier<f32>, S: Shader>(
    frame: &Frame<'_>,
    settings: &March,
    voxels: &[V],
    classifier: &C,
    shader: &S,
) -> Result<Rendered> {
    let field = Trilinear::new(voxels, frame.volume.grid().dims())?;
    match frame.volume.slices() {
        None => run(frame, settings, field, classifier, shader),
        Some(slices) => {
            let table = SliceTable::new(slices);
            run(frame, settings, field.with_spacing(table.spacing()), classifier, shader)
        }
    }
}

/// Computes what this kernel reads, and nothing else, and renders.
fn run<V: Voxel, K: Spacing, C: Classifier<f32>, S: Shader>(
    frame: &Frame<'_>,
    settings: &March,
    field: Trilinear<'_, V, K>,
    classifier: &C,
    shader: &S,
) -> Result<Rendered> {
    let grid = frame.volume.grid();
    let units = GradientUnits::new(grid, frame.volume.rescale());
    let magnitudes = C::READS_GRADIENT.then(|| gradient_magnitude_per_mm(&field, &units));
    let magnitude = magnitudes.as_deref().map(|m| Trilinear::new(m, grid.dims())).transpose()?;
    // Blocks are counted in even steps.
    let empty_space = (frame.schedule.empty_space_skipping && K::EVEN).then(|| {
        let magnitudes = magnitude.as_ref().map(Macrocells::new);
        EmptySpace::new(&Macrocells::new(&field), magnitudes.as_ref(), classifier)
    });
    let kernel = Kernel { field, magnitude, units, classifier, shader, empty_space };
    let (image, tally) = kernel.render(frame, settings);
    let name = KernelName { method: "march", voxel: V::NAME, reads_gradient: C::READS_GRADIENT, shader: S::NAME };
    let statistics =
        Statistics { samples: tally.samples, error_bound: None, rays: tally.rays, kernel: name.to_string() };
    Ok(Rendered { image, statistics })
}
