//! Scattering, resolved.

use super::{Absence, Asked};
use crate::plan::light;
use crate::scene::{Light, Scattering};
use crate::spec::{EffectsSpec, Spec};

/// Whether light is scattered at all.
pub(in crate::plan) fn scatters(spec: &Spec) -> bool {
    spec.pipeline.effects.as_ref().and_then(|effects| effects.scattering.as_ref()).is_some_and(|s| s.albedo > 0.0)
}

pub(super) fn resolve(written: &EffectsSpec) -> Asked<Scattering> {
    let scattering = written.scattering.as_ref().ok_or(Absence::NotNamed)?;
    if scattering.albedo == 0.0 {
        return Err(Absence::NoStrength("its albedo is 0".to_owned()));
    }
    let shared = || written.shading.as_ref().and_then(|shading| shading.lights.as_ref());
    let lights = scattering.lights.as_ref().or_else(shared).into_iter().flatten();
    let directional = lights.filter_map(|spec| match light::light(spec) {
        Light::Directional { towards, color } => Some((towards, color)),
        Light::Headlight { .. } => None,
    });
    let anisotropy = scattering.anisotropy.unwrap_or(0.0);
    Ok(Scattering { albedo: scattering.albedo, anisotropy, lights: directional.collect() })
}
