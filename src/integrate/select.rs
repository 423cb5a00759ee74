//! From what a plan says to the types of a kernel, once per frame.

use super::atmosphere::Atmosphere;
use super::classify_voxels::classify_voxels;
use super::empty_space::EmptySpace;
use super::march::{
    AtVoxels, ByLanes, ByPlace, Classified, Kernel, LevelChanges, Masked, Medium, OneByOne, Packets, VtkPhong,
    suits_packets,
};
use super::shade::{LaneShader, Lit, Shader, Unlit};
use super::shown::Shown;
use super::texels::{Component, Rgba, Texels};
use super::tiles::Tally;
use super::{Frame, KernelName, Rendered, Statistics};
use crate::classify::{
    Baked, BakedAlike, LaneClassifier, OneDColumns, StepOpacity, Tabulated, Texture, TwoDColumns, bake, bake_alike,
};
use crate::error::Result;
use crate::field::{
    GradientUnits, MOST_VOXELS_PER_STEP, Macrocells, Magnitude, SliceTable, Spacing, Trilinear, Voxel,
    gradient_range_per_mm,
};
use crate::image::Image;
use crate::plan::{Lattice, March, Reflection, Table};
use crate::scene::{ClassifyAt, Surface};
use crate::simd::{Level, Pairs};
use crate::volume::{Grid, Samples};

/// Base-2 logarithm of the cells per axis of the blocks that are skipped where empty.
const BLOCKS: u32 = Macrocells::LOG2_CELLS;

/// The same of packets, to which finer blocks cost little.
const PACKET_BLOCKS: u32 = 2;

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
    let around = || EmptySpace::around(dims, |voxel| medium.is_lit(voxel));
    let empty_space = frame.schedule.empty_space_skipping.then(|| frame.survey.empty_space.get_or_init(around));
    Ok(walked(frame, settings, &OneByOne(&medium), empty_space, kernel))
}

/// Marches through a medium.
fn walked<M: Medium>(
    frame: &Frame<'_>,
    settings: &March,
    medium: &M,
    empty_space: Option<&EmptySpace>,
    name: String,
) -> Rendered {
    let level = if M::BY_LANES { frame.schedule.level } else { Level::Scalar };
    let (image, tally) = Kernel { medium, empty_space, level }.render(frame, settings);
    rendered(image, tally, name, level)
}

fn rendered(image: Image, tally: Tally, name: String, level: Level) -> Rendered {
    let kernel = format!("{name}/{level}");
    let statistics = Statistics { samples: tally.samples, error_bound: None, bound: None, rays: tally.rays, kernel };
    Rendered { image, statistics }
}

fn by_classifier<V: Voxel + Pairs>(frame: &Frame<'_>, settings: &March, voxels: &[V]) -> Result<Rendered> {
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
        Baked::OneD(classifier) => plain(frame, settings, voxels, &classifier, &OneDColumns::new(&classifier)),
        Baked::TwoD(classifier) => plain(frame, settings, voxels, &classifier, &TwoDColumns::new(&classifier)),
    }
}

/// Renders one transfer function, many samples at a time where there is a kernel for that.
fn plain<V: Voxel + Pairs, C: ByPlace, T: LaneClassifier>(
    frame: &Frame<'_>,
    settings: &March,
    voxels: &[V],
    classifier: &C,
    columns: &T,
) -> Result<Rendered> {
    let (grid, scene) = (frame.volume.grid(), frame.scene);
    let field = Trilinear::new(voxels, grid.dims())?;
    let suits = field.suits_lanes() && steps_are_short(settings, grid) && frame.volume.slices().is_none();
    if !suits || scene.effects.change_light() {
        return by_shader(frame, settings, voxels, classifier);
    }
    match (&scene.shading, settings.reflection) {
        (None, _) => by_lanes(frame, settings, field, classifier, columns, &Unlit),
        (Some(shading), Reflection::BlinnPhong) => {
            by_lanes(frame, settings, field, classifier, columns, &Lit::new(shading))
        }
        (Some(_), Reflection::VtkPhong) => by_shader(frame, settings, voxels, classifier),
    }
}

/// Whether a batch of samples in any direction fits the offsets of lanes.
fn steps_are_short(settings: &March, grid: &Grid) -> bool {
    let rows = grid.lps_mm_to_index().matrix3.transpose();
    // View planes are met at an angle, as far apart as it makes them.
    settings.lattice == Lattice::PerRay
        && [rows.x_axis, rows.y_axis, rows.z_axis]
            .iter()
            .all(|row| settings.step_mm * row.length() <= MOST_VOXELS_PER_STEP)
}

/// Renders many samples at a time.
fn by_lanes<V: Voxel + Pairs, C: ByPlace, T: LaneClassifier, S: LaneShader>(
    frame: &Frame<'_>,
    settings: &March,
    field: Trilinear<'_, V>,
    classifier: &C,
    columns: &T,
    shader: &S,
) -> Result<Rendered> {
    let (grid, level) = (frame.volume.grid(), frame.schedule.level);
    let units = GradientUnits::new(grid, frame.volume.rescale());
    if suits_packets(settings, grid) {
        let (magnitude, empty_space) = surveyed::<PACKET_BLOCKS, _, _, _>(frame, &field, classifier)?;
        let packets = Packets { field, magnitude, units, classifier: columns, shader, empty_space, level };
        let (image, tally) = packets.render(frame, settings);
        return Ok(rendered(image, tally, name::<V, C, S>(), level));
    }
    let (magnitude, empty_space) = surveyed::<BLOCKS, _, _, _>(frame, &field, classifier)?;
    let medium = ByLanes { field, magnitude, units, classifier: columns, shader };
    Ok(walked(frame, settings, &medium, empty_space, name::<V, C, S>()))
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
        let atmosphere = Atmosphere::new(frame);
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
        let atmosphere = Atmosphere::new(frame);
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

/// Renders one sample after the other.
fn run<V: Voxel, K: Spacing, C: ByPlace, S: Shader>(
    frame: &Frame<'_>,
    settings: &March,
    field: Trilinear<'_, V, K>,
    classifier: &C,
    shader: &S,
) -> Result<Rendered> {
    let (magnitude, empty_space) = surveyed::<BLOCKS, _, _, _>(frame, &field, classifier)?;
    let units = GradientUnits::new(frame.volume.grid(), frame.volume.rescale());
    let medium = Classified { field, magnitude, units, classifier, shader };
    Ok(walked(frame, settings, &OneByOne(&medium), empty_space, name::<V, C, S>()))
}

/// What a kernel reads of a volume, and nothing else: the gradient magnitude, HU/mm, as a field, and where nothing is to be seen.
fn surveyed<'a, const LOG2: u32, V: Voxel, K: Spacing, C: ByPlace>(
    frame: &Frame<'a>,
    field: &Trilinear<'_, V, K>,
    classifier: &C,
) -> Result<(Option<Magnitude<'a>>, Option<&'a EmptySpace>)> {
    let Shown { magnitudes, empty_space } = frame.survey.shown.get_or_init(|| {
        let units = GradientUnits::new(frame.volume.grid(), frame.volume.rescale());
        Shown::new::<LOG2, _, _, _>(field, &units, classifier, frame.schedule.empty_space_skipping)
    });
    let magnitude = magnitudes.as_ref().map(|m| m.field(field.dims())).transpose()?;
    Ok((magnitude, empty_space.as_ref()))
}

fn name<V: Voxel, C: ByPlace, S: Shader>() -> String {
    let name = KernelName {
        method: "march",
        voxel: V::NAME,
        reads_gradient: C::READS_GRADIENT,
        suffix: C::SUFFIX,
        shader: S::NAME,
    };
    name.to_string()
}
