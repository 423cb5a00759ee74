//! What a careful user should know of a plan before the first ray.

use crate::scene::{Background, Effects, Model, Scene};
use crate::spec::{Spec, ValuesName};
use crate::transfer::{Optics, Side, TransferFunction};
use crate::volume::Quantity;

use super::model::reads_transfer_function;
use super::{Exact, Format, Method, Plan, VolumeInfo};
use super::{clip, mask};

pub(super) fn of(plan: &Plan, spec: &Spec, volume: &VolumeInfo) -> Vec<String> {
    let mut warnings = Vec::new();
    let tf = &plan.scene.transfer_function;
    let [low, high] = tf.window();
    let [least, most] = volume.value_range;
    if plan.colors.is_some() && most == 0.0 {
        warnings.push("nothing in this volume absorbs or emits: the picture will show the background alone".to_owned());
    }
    let is_read = plan.colors.is_none() && reads_transfer_function(&plan.scene);
    if is_read && (least < low || most > high) {
        warnings.push(format!(
            "values from {least} to {most} go beyond the window {low} to {high} and look like its ends; \
             normalise.hu widens it"
        ));
    }
    let is_dark = |tf| reads_transfer_function(&plan.scene) && shows_nothing(tf, volume.value_range);
    if plan.colors.is_none() && shown(plan, volume).all(is_dark) {
        warnings.push("nothing in this volume absorbs or emits: the picture will show the background alone".to_owned());
    }
    for label in mask::without_voxels(spec, volume) {
        warnings.push(format!("no voxel has the label {label} of effects.mask"));
    }
    if plan.colors.is_none() && is_black(&plan.scene) {
        let why = "nothing emits and the background is black, so the picture will be black";
        warnings.push(format!("{why}; image.background lights the volume from behind"));
    }
    if plan.colors.is_none() && adds_light_without_alpha(&plan.scene) && plan.output.format != Format::Exr {
        let why = "emission alone has no alpha, and a PNG cannot hold light without alpha";
        warnings.push(format!("{why}; write image.background: black, or an OpenEXR picture"));
    }
    if plan.scene.model == Model::Surfaces(Vec::new()) {
        warnings.push("no surface has any opacity: the picture will show the background alone".to_owned());
    }
    if clip::leaves_nothing(&plan.scene.effects.clip, &volume.grid) {
        warnings
            .push("effects.clip leaves nothing of this volume: the picture will show the background alone".to_owned());
    }
    for (_, preset) in spec.layers() {
        let Some(preset) = preset.map(|loaded| &loaded.preset) else { continue };
        if preset.values == Some(ValuesName::Arbitrary) && volume.quantity == Quantity::Hu {
            warnings.push(format!("preset {} is not in HU, and the volume's values are", preset.name));
        }
    }
    for layer in plan.layers.iter().filter(|layer| layer.max_deviation > 0.0) {
        warnings.push(format!(
            "{} is rendered by terms within {:.4} of the height of its shapes; max_deviation lowers it",
            layer.name, layer.max_deviation
        ));
    }
    match plan.method {
        // Below this, rounding in f32 is most of the error.
        Method::Exact(Exact { tolerance, .. }) if tolerance < 1e-5 => {
            warnings.push(format!(
                "a tolerance of {tolerance:.1e} is near the rounding of f32; integrate: reference is exact in f64"
            ));
        }
        Method::Reference if plan.certify.is_some() => {
            warnings.push("certify compares the reference with itself".to_owned());
        }
        _ => {}
    }
    warnings
}

/// True if light is only absorbed, and there is none to absorb.
fn is_black(scene: &Scene) -> bool {
    let Scene { model, transfer_function, shading, background, effects, .. } = scene;
    let terms = transfer_function.terms();
    let mut knots = terms.iter().flat_map(|term| term.curve.knots());
    *model == Model::Light
        && !terms.is_empty()
        && knots.all(|knot| knot.optics.emission_per_mm == [0.0; 3])
        // A highlight is of what absorbs.
        && shading.is_none()
        && *background == Background::Color([0.0; 3])
        && *effects == Effects::default()
}

/// True if light is emitted, nothing is absorbed and the picture keeps its alpha of 0.
fn adds_light_without_alpha(scene: &Scene) -> bool {
    let terms = scene.transfer_function.terms();
    let mut knots = terms.iter().flat_map(|term| term.curve.knots());
    scene.model == Model::Light
        && !terms.is_empty()
        && knots.all(|knot| knot.optics.extinction_per_mm == 0.0)
        && scene.background == Background::Transparent
}

/// The transfer functions by which some voxel shows.
fn shown<'a>(plan: &'a Plan, volume: &'a VolumeInfo) -> impl Iterator<Item = &'a TransferFunction> {
    let scene = &plan.scene;
    let masked = scene.effects.mask.as_ref().zip(plan.label_classes.as_ref()).zip(volume.labels.as_ref());
    let plain = masked.is_none().then_some(&scene.transfer_function);
    let by_label = masked.into_iter().flat_map(|((mask, classes), labels)| {
        let functions = labels.counts.keys().map(|&label| usize::from(classes.class(label)));
        functions.filter_map(|class| mask.function(class, &scene.transfer_function))
    });
    plain.into_iter().chain(by_label)
}

/// True if the transfer function is 0 at all values of the volume, at any gradient magnitude.
fn shows_nothing(tf: &TransferFunction, [least, most]: [f64; 2]) -> bool {
    let [low, high] = tf.window();
    let (least, most) = (least.clamp(low, high), most.clamp(low, high));
    let inner = tf.value_knots().into_iter().filter(|&v| least <= v && v <= most);
    let values: Vec<f64> = inner.chain([least, most]).collect();
    let gradients = tf.gradient_knots();
    let sides = [Side::Left, Side::Right];
    let limits = values.iter().flat_map(|&v| {
        // Beyond the volume's own values a jump shows nothing.
        sides
            .into_iter()
            .filter(move |side| match side {
                Side::Left => v > least || least == most,
                Side::Right => v < most || least == most,
            })
            .map(move |side| (v, side))
    });
    limits
        .flat_map(|v| gradients.iter().flat_map(move |&g| sides.map(|side| (v, (g, side)))))
        .all(|((v, v_side), (g, g_side))| tf.evaluate_side(v, v_side, g, g_side) == Optics::NOTHING)
}
