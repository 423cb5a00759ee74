//! From what a plan says to the types of a kernel, once per frame.

use super::empty_space::EmptySpace;
use super::march::{Kernel, VtkPhong};
use super::shade::{Lit, Shader, Unlit};
use super::{Frame, KernelName, Rendered, Statistics};
use crate::classify::{Baked, Classifier, StepOpacity, Tabulated, Texture, bake};
use crate::error::Result;
use crate::field::{GradientUnits, Macrocells, Trilinear, Voxel, gradient_magnitude_per_mm, gradient_range_per_mm};
use crate::plan::{March, Reflection, Table};
use crate::volume::Samples;

/// Renders by marching.
pub(super) fn march(frame: &Frame<'_>, settings: &March) -> Result<Rendered> {
    match frame.volume.samples() {
        Samples::I16(voxels) => by_classifier(frame, settings, voxels),
        Samples::F32(voxels) => by_classifier(frame, settings, voxels),
    }
}

fn by_classifier<V: Voxel>(frame: &Frame<'_>, settings: &March, voxels: &[V]) -> Result<Rendered> {
    if let Some(table) = &settings.table {
        return by_table(frame, settings, voxels, table);
    }
    match bake(&frame.scene.transfer_function, frame.volume.rescale()) {
        Baked::OneD(classifier) => by_shader(frame, settings, voxels, &classifier),
        Baked::TwoD(classifier) => by_shader(frame, settings, voxels, &classifier),
    }
}

/// Looks the transfer function up in a texture over the volume's own ranges.
fn by_table<V: Voxel>(frame: &Frame<'_>, settings: &March, voxels: &[V], table: &Table) -> Result<Rendered> {
    let (transfer_function, volume) = (&frame.scene.transfer_function, frame.volume);
    let (step_mm, rescale) = (settings.step_mm, volume.rescale());
    if transfer_function.reads_gradient() {
        let gradients = gradient_range_per_mm(volume)?;
        let tabulated =
            Tabulated::new(transfer_function, table.values, volume.value_range(), Some((table.gradients, gradients)))?;
        let texture = Texture::<2>::new(&tabulated, rescale, StepOpacity { step_mm, uncorrected: 0.0 });
        by_shader(frame, settings, voxels, &texture)
    } else {
        let tabulated = Tabulated::new(transfer_function, table.values, volume.value_range(), None)?;
        let opacity = StepOpacity { step_mm, uncorrected: table.uncorrected_opacity };
        by_shader(frame, settings, voxels, &Texture::<1>::new(&tabulated, rescale, opacity))
    }
}

fn by_shader<V: Voxel, C: Classifier<f32>>(
    frame: &Frame<'_>,
    settings: &March,
    voxels: &[V],
    classifier: &C,
) -> Result<Rendered> {
    match (&frame.scene.shading, settings.reflection) {
        (None, _) => run(frame, settings, voxels, classifier, &Unlit),
        (Some(shading), Reflection::VtkPhong) => {
            let shader = VtkPhong::new(shading, &frame.scene.camera, frame.volume.grid(), C::READS_GRADIENT);
            run(frame, settings, voxels, classifier, &shader)
        }
        (Some(shading), Reflection::BlinnPhong) => run(frame, settings, voxels, classifier, &Lit::new(shading)),
    }
}

/// Computes what this kernel reads, and nothing else, and renders.
fn run<V: Voxel, C: Classifier<f32>, S: Shader>(
    frame: &Frame<'_>,
    settings: &March,
    voxels: &[V],
    classifier: &C,
    shader: &S,
) -> Result<Rendered> {
    let grid = frame.volume.grid();
    let field = Trilinear::new(voxels, grid.dims())?;
    let units = GradientUnits::new(grid, frame.volume.rescale());
    let magnitudes = C::READS_GRADIENT.then(|| gradient_magnitude_per_mm(&field, &units));
    let magnitude = magnitudes.as_deref().map(|m| Trilinear::new(m, grid.dims())).transpose()?;
    let empty_space = frame.schedule.empty_space_skipping.then(|| {
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
