//! What is computed, in order, and what is not, and why.

use crate::scene::{Model, Scene};
use crate::spec::Spec;
use crate::volume::Grid;

use super::{
    Colors, Emission, Exact, Jitter, JitterKind, Lattice, Method, Order, Plan, Reflection, SampleRule, VolumeInfo,
};

/// One stage of the computation.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Stage {
    /// The module that does it: `volume`, `field`, `classify`, `integrate`, `image`, `oracle`.
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

/// Cells along each axis of a block of macrocells.
const BLOCK_CELLS: usize = 8;

pub(super) fn computed(plan: &Plan, volume: &VolumeInfo) -> Vec<Stage> {
    let voxels = volume.grid.voxel_count() as u64;
    let mut stages =
        vec![Stage { name: "volume", what: describe_volume(volume), bytes: voxels * volume.storage.bytes() }];
    let mut field = |what: &str, bytes| stages.push(Stage { name: "field", what: what.to_owned(), bytes });
    if plan.demand.gradient_magnitude && plan.demand.macrocells {
        field("gradient magnitude at the voxels, by central differences, f32", 4 * voxels);
    } else if plan.demand.gradient_magnitude {
        field("gradient magnitude at corners of lit cells, by central differences, not stored", 0);
    }
    if plan.demand.gradient {
        field("gradient at samples, by central differences, not stored", 0);
    }
    if plan.demand.macrocells {
        let channels = if plan.demand.gradient_magnitude { 2 } else { 1 };
        field("macrocells: value ranges of blocks of 8 x 8 x 8 cells", 8 * channels * block_count(&volume.grid));
    }
    if plan.scene.model == Model::Light {
        stages.push(classify(plan));
    }
    let pixels: u64 = plan.scene.camera.size().iter().map(|&n| n as u64).product();
    stages.push(Stage {
        name: "integrate",
        what: format!("{}: {}", kernel(&plan.method, &plan.scene, volume), describe_method(&plan.method)),
        bytes: 16 * pixels,
    });
    stages.push(Stage {
        name: "image",
        what: plan.output.format.describe().to_owned(),
        bytes: plan.output.format.bytes_per_pixel() * pixels,
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
    format!(
        "{nx} x {ny} x {nz} voxels of {:.3} x {:.3} x {:.3} mm, {storage}, values {low} to {high} {unit}",
        mm.x, mm.y, mm.z
    )
}

fn block_count(grid: &Grid) -> u64 {
    grid.dims().iter().map(|&n| (n - 1).div_ceil(BLOCK_CELLS).max(1) as u64).product()
}

fn classify(plan: &Plan) -> Stage {
    let tf = &plan.scene.transfer_function;
    let values = tf.value_knots().len();
    let [low, high] = tf.window();
    let layers = match plan.layers.len() {
        1 => "1 layer".to_owned(),
        n => format!("{n} layers"),
    };
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
    Stage { name: "classify", what, bytes: (4 * 4 * coefficients * (values - 1)) as u64 }
}

/// Name of a kernel by what it is made of, such as `march/i16/tf2d/lit`.
fn kernel(method: &Method, scene: &Scene, volume: &VolumeInfo) -> String {
    let method = match method {
        Method::Exact(_) => "exact",
        Method::March(_) => "march",
        Method::Reference => return "reference in f64".to_owned(),
    };
    match scene.model {
        Model::Light => {}
        Model::Value(_) => return format!("{method}/{}/value/f64", volume.storage.name()),
        Model::Surfaces(_) => return format!("{method}/{}/surfaces/f64", volume.storage.name()),
    }
    let classifier = if scene.transfer_function.reads_gradient() { "tf2d" } else { "tf1d" };
    let shader = if scene.shading.is_some() { "lit" } else { "unlit" };
    format!("{method}/{}/{classifier}/{shader}", volume.storage.name())
}

fn describe_method(method: &Method) -> String {
    let march = match method {
        Method::Exact(Exact { tolerance }) => return format!("each channel of a pixel within {tolerance:.3e}"),
        Method::Reference => return "every pixel by the oracle".to_owned(),
        Method::March(march) => march,
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
    let mut parts = vec![format!("steps of {:.4} mm", march.step_mm), rule.to_owned(), order.to_owned()];
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
    parts.join(", ")
}

pub(super) fn not_computed(plan: &Plan, spec: &Spec) -> Vec<Omission> {
    let mut omissions = Vec::new();
    let mut omit = |what, why: &str| omissions.push(Omission { what, why: why.to_owned() });
    match plan.scene.model {
        Model::Light => {}
        Model::Value(_) => omit("classification", "effects.project shows a number of the values, not light"),
        Model::Surfaces(_) => omit("classification", "effects.surfaces shows surfaces, not light"),
    }
    if !plan.demand.gradient_magnitude {
        omit("gradient magnitude", "no layer depends on it within the range of gradient magnitudes");
    }
    if !plan.demand.gradient {
        let shading = spec.pipeline.effects.as_ref().and_then(|effects| effects.shading.as_ref());
        omit(
            "gradient",
            match shading {
                None => "no effect asks for shading",
                Some(_) => "shading has neither diffuse nor specular light, so it is a constant factor",
            },
        );
    }
    if !plan.demand.macrocells {
        let why = match plan.method {
            Method::Reference => "the reference skips nothing",
            _ => "the exact integrator skips cell by cell, by the values at their corners",
        };
        omit("macrocells", why);
    }
    if let Method::March(march) = &plan.method {
        if march.jitter.is_none() {
            omit("jitter", "integrate.march has none: all rays share one lattice");
        }
        if march.termination_transmittance == 0.0 {
            omit("early ray termination", "termination_transmittance is 0, so that it costs no accuracy");
        }
    }
    for layer in plan.layers.iter().filter(|layer| layer.terms.is_empty()) {
        let why = format!("{} is 0 everywhere in the window and the range of gradient magnitudes", layer.name);
        omissions.push(Omission { what: "layer", why });
    }
    if plan.certify.is_none() {
        omissions.push(Omission { what: "certificate", why: "certify asks for no pixels".to_owned() });
    }
    omissions
}
