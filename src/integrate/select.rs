//! From what a plan says to the types of a kernel, once per frame.

use super::atmosphere::Atmosphere;
use super::classify_voxels::classify_voxels;
use super::empty_space::EmptySpace;
use super::march::{AtVoxels, ByPlace, Classified, Kernel, LevelChanges, Masked, VtkPhong};
use super::shade::{Lit, Shader, Unlit};
use super::texels::{Component, Rgba, Texels};
use super::{Frame, KernelName, Rendered, Statistics};
use crate::classify::{Baked, BakedAlike, StepOpacity, Tabulated, Texture, bake, bake_alike};
use crate::error::Result;
use crate::field::{
    GradientUnits, Macrocells, SliceTable, Spacing, Trilinear, Voxel, gradient_magnitude_per_mm, gradient_range_per_mm,
};
use crate::plan::{March, Reflection, Table};
use crate::scene::{ClassifyAt, Surface};
use crate::volume::Samples;

/// Renders by marching.
pub(super) fn march(frame: &Frame<'_>, settings: &March) -> Result<Rendered> {
    match frame.volume.samples() {
        Samples::Rgba8(texels) => colors(frame, settings, texels),
        Samples::Rgba16(texels) => colors(frame, settings, texels),
        _ if frame.scene.effects.classify == ClassifyAt::Voxels => {
            let reads_gradient = frame.scene.transfer_function.reads_gradient();
            let shader = if frame.scene.shading.is_some() { Lit::NAME } else { Unlit::NAME };
            let name = KernelName { method: "march", voxel: "voxels", reads_gradient, suffix: "", shader };
            at_voxels(frame, settings, classify_voxels(frame.volume, frame.scene), name.to_string())
        }
        Samples::I16(voxels) => by_classifier(frame, settings, voxels),
        Samples::F32(voxels) => by_classifier(frame, settings, voxels),
    }
}

fn colors<T: Component>(frame: &Frame<'_>, settings: &March, texels: &[[T; 4]]) -> Result<Rendered> {
    let Some(encoding) = frame.volume.rgba_encoding() else { unreachable!("colours are understood in some way") };
    at_voxels(frame, settings, Rgba::new(texels, encoding), format!("march/{}/unlit", T::NAME))
}

/// Renders a medium given at the voxels.
fn at_voxels<T: Texels<f32>>(frame: &Frame<'_>, settings: &March, texels: T, kernel: String) -> Result<Rendered> {
    let dims = frame.volume.grid().dims();
    let medium = AtVoxels::new(texels, dims)?;
    let empty_space =
        frame.schedule.empty_space_skipping.then(|| EmptySpace::around(dims, |voxel| medium.is_lit(voxel)));
    let (image, tally) = Kernel { medium: &medium, empty_space }.render(frame, settings);
    let statistics = Statistics { samples: tally.samples, error_bound: None, rays: tally.rays, kernel };
    Ok(Rendered { image, statistics })
}

fn by_classifier<V: Voxel>(frame: &Frame<'_>, settings: &March, voxels: &[V]) -> Result<Rendered> {
    if let Some((mask, classes)) = frame.scene.effects.mask.as_ref().zip(frame.volume.classes()) {
        let functions = mask.functions(classes.count(), &frame.scene.transfer_function);
        let grid = frame.volume.grid();
        return match bake_alike(&functions, frame.volume.rescale()) {
            BakedAlike::OneD(all) => by_shader(frame, settings, voxels, &Masked::new(all, classes, grid)),
            BakedAlike::TwoD(all) => by_shader(frame, settings, voxels, &Masked::new(all, classes, grid)),
        };
    }
    if let Some(table) = &settings.table {
        return by_table(frame, settings, voxels, table);
    }
    match bake(&frame.scene.transfer_function, frame.volume.rescale()) {
        Baked::OneD(classifier) => by_shader(frame, settings, voxels, &classifier),
        Baked::TwoD(classifier) => by_shader(frame, settings, voxels, &classifier),
    }
}

/// Renders level surfaces at the samples of whole steps.
pub(super) fn level_changes(frame: &Frame<'_>, settings: &March, surfaces: &[Surface]) -> Result<Rendered> {
    match frame.volume.samples() {
        Samples::I16(voxels) => changes(frame, settings, surfaces, voxels),
        Samples::F32(voxels) => changes(frame, settings, surfaces, voxels),
        Samples::Rgba8(_) | Samples::Rgba16(_) => unreachable!("colours have no values, and are refused"),
    }
}

fn changes<V: Voxel>(frame: &Frame<'_>, settings: &March, surfaces: &[Surface], voxels: &[V]) -> Result<Rendered> {
    let (grid, scene) = (frame.volume.grid(), frame.scene);
    let field = Trilinear::new(voxels, grid.dims())?;
    if scene.effects.change_light() {
        let atmosphere = Atmosphere::new(frame.volume, scene);
        return Ok(LevelChanges::new(frame, field, surfaces, &atmosphere).render(frame, settings));
    }
    Ok(match (&scene.shading, settings.reflection) {
        (None, _) => LevelChanges::new(frame, field, surfaces, &Unlit).render(frame, settings),
        (Some(shading), Reflection::VtkPhong) => {
            let shader = VtkPhong::new(shading, &scene.camera, grid, false);
            LevelChanges::new(frame, field, surfaces, &shader).render(frame, settings)
        }
        (Some(shading), Reflection::BlinnPhong) => {
            LevelChanges::new(frame, field, surfaces, &Lit::new(shading)).render(frame, settings)
        }
    })
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

fn by_shader<V: Voxel, C: ByPlace>(
    frame: &Frame<'_>,
    settings: &March,
    voxels: &[V],
    classifier: &C,
) -> Result<Rendered> {
    if frame.scene.effects.change_light() {
        let atmosphere = Atmosphere::new(frame.volume, frame.scene);
        return by_spacing(frame, settings, voxels, classifier, &atmosphere);
    }
    match (&frame.scene.shading, settings.reflection) {
        (None, _) => by_spacing(frame, settings, voxels, classifier, &Unlit),
        (Some(shading), Reflection::VtkPhong) => {
            let shader = VtkPhong::new(shading, &frame.scene.camera, frame.volume.grid(), C::READS_GRADIENT);
            by_spacing(frame, settings, voxels, classifier, &shader)
        }
        (Some(shading), Reflection::BlinnPhong) => by_spacing(frame, settings, voxels, classifier, &Lit::new(shading)),
    }
}

fn by_spacing<V: Voxel, C: ByPlace, S: Shader>(
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
fn run<V: Voxel, K: Spacing, C: ByPlace, S: Shader>(
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
    let medium = Classified { field, magnitude, units, classifier, shader };
    let (image, tally) = Kernel { medium: &medium, empty_space }.render(frame, settings);
    let name = KernelName {
        method: "march",
        voxel: V::NAME,
        reads_gradient: C::READS_GRADIENT,
        suffix: C::SUFFIX,
        shader: S::NAME,
    };
    let statistics =
        Statistics { samples: tally.samples, error_bound: None, rays: tally.rays, kernel: name.to_string() };
    Ok(Rendered { image, statistics })
}
