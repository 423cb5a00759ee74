//! A scene with one thing changed.

use crate::error::Result;
use crate::plan::{Exact, Method};
use crate::scene::{ClassifyAt, Effects, Light, Model, Scene, Shading};
use crate::transfer::{Term, TransferFunction, Weight};
use crate::volume::{Samples, Volume};

/// The exact integrator.
pub(super) fn exact(tolerance: f64) -> Method {
    Method::Exact(Exact::within(tolerance))
}

/// What a scene that is not shaded is shaded by for comparison: a headlight, with the shares that a pipeline has by default.
fn headlight() -> Shading {
    Shading {
        ambient: 0.2,
        diffuse: 0.7,
        specular: 0.2,
        shininess: 20.0,
        two_sided: true,
        soft_gradient_per_mm: 20.0,
        lights: vec![Light::Headlight { color: [1.0; 3] }],
    }
}

/// The scene unshaded and shaded; `None` where it shows no light, where colours have no gradient, and where what scatters or
/// casts shadows needs the lights.
pub(super) fn by_shading(volume: &Volume, scene: &Scene) -> Option<[Scene; 2]> {
    let lit_otherwise = scene.effects.scattering.is_some() || scene.effects.shadows.is_some();
    if scene.model != Model::Light || volume.rgba_encoding().is_some() || lit_otherwise {
        return None;
    }
    let shading = scene.shading.clone().unwrap_or_else(headlight);
    Some([None, Some(shading)].map(|shading| Scene { shading, ..scene.clone() }))
}

/// The scene by a transfer function of the value alone, and by one of value and gradient magnitude: that of the scene is one
/// of them; the other has no weights, or weights of 1. `None` where no transfer function is evaluated along rays.
pub(super) fn by_dimensions(volume: &Volume, scene: &Scene) -> Result<Option<[Scene; 2]>> {
    let given = volume.rgba_encoding().is_some() || scene.effects.classify == ClassifyAt::Voxels;
    if scene.model != Model::Light || given || scene.effects.mask.is_some() {
        return Ok(None);
    }
    let function = &scene.transfer_function;
    let with = |weight: Option<Weight>| -> Result<Scene> {
        let term = |term: &Term| Term { weight: weight.clone(), ..term.clone() };
        let terms = function.terms().iter().map(term).collect();
        let transfer_function = TransferFunction::new(function.window(), function.gradient_range_per_mm(), terms)?;
        Ok(Scene { transfer_function, ..scene.clone() })
    };
    let everywhere = Weight::new(vec![[0.0, 1.0], [function.gradient_range_per_mm(), 1.0]])?;
    Ok(Some(match function.reads_gradient() {
        true => [with(None)?, scene.clone()],
        false => [scene.clone(), with(Some(everywhere))?],
    }))
}

/// The scene with colours interpolated between classified voxels, in place of values between voxels.
pub(super) fn classified_at_voxels(scene: &Scene) -> Scene {
    let effects = Effects { classify: ClassifyAt::Voxels, ..scene.effects.clone() };
    Scene { effects, ..scene.clone() }
}

/// The same view in a picture of half the width and height.
pub(super) fn at_half_size(scene: &Scene) -> Scene {
    Scene { camera: scene.camera.with_size(scene.camera.size().map(|n| n / 2)), ..scene.clone() }
}

/// The same volume with its samples as floats; `None` if they are not 16-bit numbers.
pub(super) fn as_f32(volume: &Volume) -> Result<Option<Volume>> {
    let Samples::I16(stored) = volume.samples() else { return Ok(None) };
    let samples = Samples::F32(stored.iter().map(|&sample| f32::from(sample)).collect());
    let mut copy = Volume::new(*volume.grid(), samples, volume.rescale(), volume.quantity())?;
    if let Some(slices) = volume.slices() {
        copy = copy.with_slices(slices.clone())?;
    }
    if let Some(classes) = volume.classes() {
        copy = copy.with_classes(classes.values().to_vec())?;
    }
    Ok(Some(copy))
}
