//! Checks on lights and on the effects of light.

use super::{Check, join};
use crate::error::Result;
use crate::spec::{
    EffectsSpec, EmissionName, FogSpec, IntegrateSpec, LightSpec, Pipeline, ScatteringSpec, ShadingSpec,
};

pub(super) fn check_effects_of_light(check: Check<'_>, effects: &EffectsSpec) -> Result<()> {
    if let Some(cue) = &effects.depth_cue {
        check.above_zero("effects.depth_cue.constant", cue.constant)?;
        check.at_least("effects.depth_cue.per_mm", Some(cue.per_mm), 0.0)?;
    }
    if let Some(fog) = &effects.fog {
        check_fog(check, fog)?;
    }
    if let Some(haze) = &effects.haze {
        check.at_least("effects.haze.extinction_per_mm", Some(haze.extinction_per_mm), 0.0)?;
        check.above_zero("effects.haze.end_mm", haze.end_mm)?;
    }
    if let Some(shadows) = &effects.shadows {
        let within = shadows.strength.is_none_or(|s| (0.0..=1.0).contains(&s));
        check.require("effects.shadows.strength", within, "0 to 1")?;
    }
    match &effects.scattering {
        Some(scattering) => check_scattering(check, scattering, effects.shading.as_ref()),
        None => Ok(()),
    }
}

/// A medium without samples has nothing to count by.
pub(super) fn check_emission(check: Check<'_>, pipeline: &Pipeline) -> Result<()> {
    let hazy = pipeline.effects.as_ref().is_some_and(|effects| effects.haze.is_some());
    let per_sample = match &pipeline.integrate {
        Some(IntegrateSpec::March(march)) => march.emission == Some(EmissionName::PerSample),
        _ => false,
    };
    check.unread("effects.haze", hazy && per_sample, "emission: per-sample has no meaning for a medium without samples")
}

fn check_fog(check: Check<'_>, fog: &FogSpec) -> Result<()> {
    let path = |key: &str| join("effects.fog", key);
    let laws = [("linear", fog.linear.is_some()), ("exp", fog.exp.is_some()), ("exp2", fog.exp2.is_some())];
    check.exactly_one("effects.fog", &laws)?;
    if let Some(linear) = &fog.linear {
        let ahead = linear.start_mm < linear.end_mm;
        check.require(&path("linear.end_mm"), ahead, "a distance beyond start_mm")?;
    }
    let density = |law: &Option<crate::spec::ExpFogSpec>| law.as_ref().map(|law| law.density_per_mm);
    check.at_least(&path("exp.density_per_mm"), density(&fog.exp), 0.0)?;
    check.at_least(&path("exp2.density_per_mm"), density(&fog.exp2), 0.0)
}

fn check_scattering(check: Check<'_>, scattering: &ScatteringSpec, shading: Option<&ShadingSpec>) -> Result<()> {
    let path = |key: &str| join("effects.scattering", key);
    check.require(&path("albedo"), (0.0..=1.0).contains(&scattering.albedo), "0 to 1")?;
    let anisotropy = scattering.anisotropy.is_none_or(|g| -1.0 < g && g < 1.0);
    check.require(&path("anisotropy"), anisotropy, "a number above -1 and below 1")?;
    let Some(lights) = &scattering.lights else {
        let shared = shading.and_then(|shading| shading.lights.as_ref());
        let directional = shared.is_some_and(|l| l.iter().any(|l| matches!(l, LightSpec::Directional { .. })));
        let known = directional || scattering.albedo == 0.0;
        return check.needed(&path("lights"), known, "a directional light, here or in effects.shading.lights");
    };
    check.require(
        &path("lights"),
        !lights.is_empty(),
        "at least one light; without the key they are those of shading",
    )?;
    for (i, light) in lights.iter().enumerate() {
        let directional = matches!(light, LightSpec::Directional { .. });
        check.require(&path(&format!("lights.{i}")), directional, "a directional light")?;
    }
    check_directions(check, &path("lights"), lights)
}

/// Directions are of any length but 0.
pub(super) fn check_directions(check: Check<'_>, path: &str, lights: &[LightSpec]) -> Result<()> {
    for (i, light) in lights.iter().enumerate() {
        if let LightSpec::Directional { towards, .. } = light {
            let path = join(path, &format!("{i}.directional.towards"));
            check.require(&path, towards.iter().any(|x| *x != 0.0), "a direction of any length but 0")?;
        }
    }
    Ok(())
}
