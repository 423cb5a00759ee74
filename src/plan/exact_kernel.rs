//! Which scenes the exact integrator renders in registers, cells side by side.

use super::VolumeInfo;
use crate::scene::{ClassifyAt, Model, Scene};

/// Whether a scene has a kernel that works many cells off at once; the others are integrated one by one, as by its twin.
pub(super) fn is_in_registers(scene: &Scene, volume: &VolumeInfo) -> bool {
    let effects = &scene.effects;
    let of_values = volume.storage.rgba_encoding().is_none() && effects.classify == ClassifyAt::Samples;
    let plain = scene.model == Model::Light && scene.shading.is_none() && !effects.change_light();
    let even = volume.uneven_slices_mm.is_none() && volume.grid.dims().iter().all(|&n| n >= 2);
    of_values && plain && effects.mask.is_none() && even
}
