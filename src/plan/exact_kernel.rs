//! Which scenes the exact integrator renders in registers, cells side by side.

use super::VolumeInfo;
use crate::scene::{ClassifyAt, Model, Scene, Shading};

/// Lights that registers have room for.
pub const MOST_LIGHTS: usize = 2;

/// The highest exponent of a highlight that registers raise to: whole ones alone, by products.
const MOST_SHININESS: f64 = 256.0;

/// Whether many cells can be shaded at once.
pub fn shades_in_registers(shading: &Shading) -> bool {
    let p = shading.shininess;
    let is_power = p.fract() == 0.0 && (2.0..=MOST_SHININESS).contains(&p);
    shading.lights.len() <= MOST_LIGHTS && (is_power || shading.specular == 0.0)
}

/// Whether a scene has a kernel that works many cells off at once; the others are integrated one by one, as by its twin.
pub(super) fn is_in_registers(scene: &Scene, volume: &VolumeInfo) -> bool {
    let effects = &scene.effects;
    let of_values = volume.storage.rgba_encoding().is_none() && effects.classify == ClassifyAt::Samples;
    let lit = scene.shading.as_ref().is_none_or(shades_in_registers);
    let plain = scene.model == Model::Light && lit && !effects.change_light();
    let even = volume.uneven_slices_mm.is_none() && volume.grid.dims().iter().all(|&n| n >= 2);
    of_values && plain && effects.mask.is_none() && even
}
