//! What is computed, in order, and what is not, and why.

use crate::field::Steps;
use crate::scene::{ClassifyAt, Model, Scene, ValueModel, ValueOf};
use crate::spec::Spec;
use crate::transfer::TransferFunction;
use crate::volume::Grid;

use super::model::{self, reads_transfer_function};
use super::{
    Bound, Colors, Emission, Exact, ExactKernel, Jitter, JitterKind, Lattice, March, Method, Order, Plan, Reflection,
    SampleRule, VolumeInfo,
};
use super::{clip, mask, voxels};

/// One stage of the computation.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Stage {
    /// The module that does it: `volume`, `field`, `classify`, `integrate`, `image`, `oracle`; `light` is a part of
    /// `integrate`.
    pub name: &'static str,
    /// What it does, with the kernel it uses.
    pub what: String,
    /// Bytes it keeps in memory, estimated.
    pub bytes: u64,
}

/// Something that is not computed.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Omission {
    /// What.
    pub what: &'static str,
    /// Why nobody needs it.
    pub why: String,
}

/// Why most effects are not computed.
pub(super) const NOT_NAMED: &str = "the pipeline does not name it";

/// Cells along each axis of a block of macrocells, for marching and for the exact integrator.
const MARCHED_BLOCK_CELLS: usize = 8;
const PACKET_BLOCK_CELLS: usize = 4;
const EXACT_BLOCK_CELLS: usize = 4;

pub(super) fn computed(plan: &Plan, volume: &VolumeInfo) -> Vec<Stage> {
    let voxels = volume.grid.voxel_count() as u64;
    let mut stages =
        vec![Stage { name: "volume", what: describe_volume(volume), bytes: voxels * volume.storage.bytes() }];
    let given = voxels::are_given(plan);
    if given {
        stages.extend(voxels::stages(plan, volume, || classify(plan)));
    }
    let mut field = |what: &str, bytes| {
        if !given {
            stages.push(Stage { name: "field", what: what.to_owned(), bytes });
        }
    };
    if plan.demand.gradient_magnitude && matches!(plan.method, Method::March(_)) {
        let error = Steps::RELATIVE_ERROR;
        let what = "gradient magnitude at voxels where something may show";
        field(&format!("{what}, 16 bits, within {error:.0e} of the largest; at most"), 2 * voxels);
    } else if plan.demand.gradient_magnitude {
        field("gradient magnitude at corners of lit cells, by central differences, not stored", 0);
    }
    if plan.demand.gradient {
        field("gradient at samples, by central differences, not stored", 0);
    }
    if plan.demand.macrocells {
        let two_fields = plan.demand.gradient_magnitude;
        let (cells, bytes) = match plan.method {
            Method::Exact(_) => (EXACT_BLOCK_CELLS, 9),
            Method::March(march) if is_in_packets(plan, &march) => {
                (PACKET_BLOCK_CELLS, if two_fields { 17 } else { 9 })
            }
            _ => (MARCHED_BLOCK_CELLS, if two_fields { 17 } else { 9 }),
        };
        let what = format!("macrocells: value ranges of blocks of {cells} x {cells} x {cells} cells");
        field(&what, bytes * block_count(&volume.grid, cells));
    }
    if let Some(classes) = &plan.label_classes {
        stages.push(Stage {
            name: "mask",
            what: format!("a class for each voxel; {}", classes.description),
            bytes: voxels,
        });
    }
    if reads_transfer_function(&plan.scene) && !given {
        stages.push(classify(plan));
    }
    if plan.demand.visibility {
        let lights = plan.scene.occluded_directions().len() as u64;
        let towards = if lights == 1 { "1 light".to_owned() } else { format!("{lights} lights") };
        let what = format!("transmittance towards {towards} at the voxels that rays reach, f32");
        stages.push(Stage { name: "light", what, bytes: 4 * lights * voxels });
    }
    let pixels: u64 = plan.scene.camera.size().iter().map(|&n| n as u64).product();
    stages.push(Stage {
        name: "integrate",
        what: format!("{}: {}", kernel(plan, volume), describe_method(plan, volume)),
        bytes: 16 * pixels,
    });
    stages.push(Stage {
        name: "image",
        what: plan.output.format.describe().to_owned(),
        bytes: plan.output.format.bytes_per_pixel() * pixels + plan.output.format.encoder_bytes(),
    });
    if let Some(pixels) = plan.certify {
        stages.push(Stage { name: "oracle", what: format!("{pixels} random pixels again in f64"), bytes: 0 });
    }
    stages
}

fn describe_volume(volume: &VolumeInfo) -> String {
    let [nx, ny, nz] = volume.grid.dims();
    let mm = volume.grid.spacing_mm();
    let [low, high] = volume.value_range;
    let (unit, storage) = (volume.unit(), volume.storage.name());
    let values = match volume.storage.rgba_encoding() {
        Some(_) => format!("alpha {low} to {high}"),
        None => format!("values {low} to {high} {unit}"),
    };
    let between_slices = match volume.uneven_slices_mm {
        None => format!("{:.3}", mm.z),
        Some([least, most]) => format!("{least:.3} to {most:.3} (uneven, as they are)"),
    };
    format!("{nx} x {ny} x {nz} voxels of {:.3} x {:.3} x {between_slices} mm, {storage}, {values}", mm.x, mm.y)
}

/// Whether rays are marched side by side, which skips finer blocks.
fn is_in_packets(plan: &Plan, march: &March) -> bool {
    let Scene { model, effects, shading, .. } = &plan.scene;
    let of_values = plan.colors.is_none() && *model == Model::Light && effects.classify == ClassifyAt::Samples;
    let plain = !effects.change_light() && effects.mask.is_none();
    let reflects = shading.is_none() || march.reflection == Reflection::BlinnPhong;
    of_values && plain && reflects && march.is_plain() && march.lattice == Lattice::PerRay
}

pub(super) fn marched_block_count(grid: &Grid) -> u64 {
    block_count(grid, MARCHED_BLOCK_CELLS)
}

fn block_count(grid: &Grid, cells: usize) -> u64 {
    grid.dims().iter().map(|&n| (n - 1).div_ceil(cells).max(1) as u64).product()
}

fn classify(plan: &Plan) -> Stage {
    let tf = &plan.scene.transfer_function;
    let own = plan.scene.transfer_functions().count() - 1;
    let values = tf.value_knots().len();
    let [low, high] = tf.window();
    let layers = match plan.layers.len() {
        1 => "1 layer".to_owned(),
        n => format!("{n} layers"),
    };
    let layers = if own > 0 { format!("{layers} and {own} of labels") } else { layers };
    // Four channels in f32: linear along the value, bilinear in a patch.
    let (what, coefficients) = if plan.demand.gradient_magnitude {
        let gradients = tf.gradient_knots().len();
        let size = format!("{values} x {gradients} knots");
        let range = tf.gradient_range_per_mm();
        (
            format!("2D transfer function of {layers}, {size}, values {low} to {high}, gradients to {range} per mm"),
            4 * (gradients - 1),
        )
    } else {
        (format!("1D transfer function of {layers}, {values} knots, values {low} to {high}"), 2)
    };
    Stage { name: "classify", what, bytes: (4 * 4 * coefficients * (values - 1) * (own + 1)) as u64 }
}

/// Name of a kernel by what it is made of, such as `march/i16/tf2d/lit`.
fn kernel(plan: &Plan, volume: &VolumeInfo) -> String {
    let scene = &plan.scene;
    let (method, real) = match plan.method {
        Method::Exact(_) => ("exact", "f64"),
        Method::March(_) => ("march", "f32"),
        Method::Reference => return "reference in f64".to_owned(),
    };
    if scene.model == Model::Light
        && (volume.storage.rgba_encoding().is_some() || scene.effects.classify == ClassifyAt::Voxels)
    {
        return format!("{method}/{}", voxels::kernel(scene, volume));
    }
    let storage = volume.storage.name();
    let by_gradient = scene.transfer_functions().any(TransferFunction::reads_gradient);
    let masked = if scene.effects.mask.is_some() { "-masked" } else { "" };
    let classifier = format!("{}{masked}", if by_gradient { "tf2d" } else { "tf1d" });
    match &scene.model {
        Model::Light => {}
        Model::Value(ValueModel { of: ValueOf::OpticalDepth, .. }) => {
            return format!("{method}/{storage}/{classifier}/{}/{real}", ValueOf::OpticalDepth.name());
        }
        Model::Value(model) => return format!("{method}/{storage}/{}/{real}", model.of.name()),
        Model::Surfaces(_) => return format!("{method}/{storage}/surfaces/{real}"),
    }
    let shader = match &scene.shading {
        _ if scene.effects.change_light() => "atmosphere",
        Some(_) if plan.exact_kernel == Some(ExactKernel::InRegisters(Bound::Proven)) => "lit-proven",
        Some(_) => "lit",
        None => "unlit",
    };
    format!("{method}/{storage}/{classifier}/{shader}")
}

fn describe_method(plan: &Plan, volume: &VolumeInfo) -> String {
    let shown = model::describe(&plan.scene.model, volume.quantity);
    let march = match (&plan.method, &shown) {
        (Method::Exact(Exact { tolerance, bound: asked }), None) => {
            let bound = match (plan.bound(), asked) {
                (Some(Bound::Estimated), _) => ", of which what shading misses is estimated",
                // Where less was enough.
                (_, Bound::Estimated) if plan.scene.shading.is_some() => ", all of it proven",
                _ => "",
            };
            return format!("each channel of a pixel within {tolerance:.3e}{bound}");
        }
        (Method::Exact(_), Some(shown)) => return format!("{shown}; exact to rounding"),
        (Method::Reference, None) => return "every pixel by the oracle".to_owned(),
        (Method::Reference, Some(shown)) => return format!("{shown}; every pixel by the oracle"),
        (Method::March(march), _) => march,
    };
    let rule = match march.rule {
        SampleRule::Left => "left samples",
        SampleRule::Midpoint => "midpoint samples",
        SampleRule::Trapezoid => "trapezoid samples",
        SampleRule::WholeSteps => "samples at the ends of whole steps",
    };
    let order = match march.order {
        Order::FrontToBack => "front to back",
        Order::BackToFront => "back to front",
    };
    let model = &plan.scene.model;
    let mut parts = vec![format!("steps of {:.4} mm", march.step_mm)];
    // Surfaces lie between samples unless steps are whole, and only light is composited in either order.
    let at_samples = !matches!(model, Model::Surfaces(_)) || march.rule == SampleRule::WholeSteps;
    parts.extend(at_samples.then(|| rule.to_owned()));
    parts.extend((*model == Model::Light).then(|| order.to_owned()));
    let unusual = [
        (march.colors == Colors::Straight, "straight colours"),
        (march.emission == Emission::PerSample, "emission per sample"),
        (march.lattice == Lattice::ViewPlanes, "on view planes"),
        (march.table.is_some(), "from a table"),
        (march.reflection == Reflection::VtkPhong, "highlights as VTK's"),
    ];
    parts.extend(unusual.into_iter().filter(|(is, _)| *is).map(|(_, text)| text.to_owned()));
    if let Some(Jitter { seed, kind }) = march.jitter {
        let kind = match kind {
            JitterKind::White => "white",
            JitterKind::LowDiscrepancy => "low-discrepancy",
        };
        parts.push(format!("{kind} jitter of seed {seed}"));
    }
    if march.termination_transmittance > 0.0 {
        parts.push(format!("until {:.2e} is transmitted", march.termination_transmittance));
    }
    if march.bisections > 0 {
        parts.push(format!("{} bisections", march.bisections));
    }
    shown.into_iter().chain([parts.join(", ")]).collect::<Vec<_>>().join("; ")
}

pub(super) fn not_computed(plan: &Plan, spec: &Spec, volume: &VolumeInfo) -> Vec<Omission> {
    let mut omissions = Vec::new();
    let mut omit = |what, why: &str| omissions.push(Omission { what, why: why.to_owned() });
    if plan.colors.is_some() {
        omit("classification", "the volume has colours of its own");
    }
    for omission in model::not_computed(plan, spec) {
        omit(omission.what, &omission.why);
    }
    if !plan.demand.gradient_magnitude && plan.colors.is_none() {
        omit("gradient magnitude", "no layer depends on it within the range of gradient magnitudes");
    }
    if !plan.demand.gradient {
        let shading = spec.pipeline.effects.as_ref().and_then(|effects| effects.shading.as_ref());
        omit(
            "gradient",
            match shading {
                None if plan.colors.is_some() => "the volume has no values",
                None => "no effect asks for shading",
                Some(_) => "shading has neither diffuse nor specular light, so it is a constant factor",
            },
        );
    }
    if !plan.demand.macrocells {
        let why = match plan.method {
            Method::Reference => "the reference skips nothing",
            Method::March(_) if volume.uneven_slices_mm.is_some() => {
                "slices are uneven, and blocks of cells are counted in even steps: every sample is taken"
            }
            Method::March(_) => "every value counts, so no block of cells could be skipped",
            Method::Exact(_) if plan.colors.is_some() => {
                "the exact integrator skips cell by cell, by the colours at their corners"
            }
            Method::Exact(_) => "the exact integrator skips cell by cell, by the values at their corners",
        };
        omit("macrocells", why);
    }
    if let Method::March(march) = &plan.method {
        if march.jitter.is_none() {
            omit("jitter", "integrate.march has none: all rays share one lattice");
        }
        if march.termination_transmittance == 0.0 && !matches!(plan.scene.model, Model::Value(_)) {
            omit("early ray termination", "termination_transmittance is 0, so that it costs no accuracy");
        }
    }
    for layer in plan.layers.iter().filter(|layer| layer.terms.is_empty()) {
        omissions.push(Omission { what: "layer", why: model::why_empty(layer, spec) });
    }
    if plan.scene.effects.clip.half_spaces.is_empty() {
        let written = clip::written(spec).is_some();
        let why = if written { "effects.clip holds the whole volume" } else { NOT_NAMED };
        omissions.push(Omission { what: "clipping", why: why.to_owned() });
    }
    if plan.label_classes.is_none() {
        let written = mask::written(spec).is_some();
        let why = if written { "all labels that occur show what the transfer function says" } else { NOT_NAMED };
        omissions.push(Omission { what: "mask", why: why.to_owned() });
    }
    if plan.certify.is_none() {
        omissions.push(Omission { what: "certificate", why: "certify asks for no pixels".to_owned() });
    }
    omissions
}
