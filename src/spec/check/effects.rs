//! Checks on effects, and on what they leave for others to read.

use super::pipeline::is_nrrd;
use super::{Check, join};
use crate::error::Result;
use crate::spec::{EffectsSpec, IntegrateSpec, LightSpec, PhantomSpec, Pipeline, VolumeSpec};

/// Light needs a transfer function; numbers of the values, and surfaces, have no use for one, nor numbers for shading.
pub(super) fn check_what_shows(check: Check<'_>, pipeline: &Pipeline) -> Result<()> {
    let effects = pipeline.effects.clone().unwrap_or_default();
    let (project, surfaces) = (effects.project.is_some(), effects.surfaces.is_some());
    check.unread("effects.surfaces", project && surfaces, "effects.project shows a number of the values instead")?;
    let written = !pipeline.transfer_function.is_empty();
    let why = if project { "effects.project shows a number of the values" } else { "effects.surfaces shows surfaces" };
    check.unread("transfer_function", written && (project || surfaces), why)?;
    check.unread("effects.shading", effects.shading.is_some() && project, "a number of the values has no light")?;
    let marched = matches!(pipeline.integrate, Some(IntegrateSpec::March(_)));
    check.unread("integrate.march", marched && (project || surfaces), "they are exact, and take no steps")?;
    let classify = "effects.classify";
    check.unread(classify, effects.classify.is_some() && (project || surfaces), "there is no transfer function")?;
    if project || surfaces || may_have_colors(&pipeline.volume) {
        return Ok(());
    }
    check.require("transfer_function", written, "at least one layer")
}

/// True if the volume may have colours of its own in place of values; what it has is known once it is read.
fn may_have_colors(volume: &VolumeSpec) -> bool {
    match (&volume.phantom, volume.source.as_deref()) {
        (Some(phantom), _) => matches!(phantom, PhantomSpec::Rings(_)),
        (None, source) => source.is_some_and(is_nrrd),
    }
}

pub(super) fn check_effects(check: Check<'_>, effects: &EffectsSpec) -> Result<()> {
    if let Some([low, high]) = effects.project.as_ref().and_then(|project| project.window_hu) {
        check.require("effects.project.window_hu", low < high, "[lowest, highest], the lower first")?;
    }
    if let Some(surfaces) = &effects.surfaces {
        check.require("effects.surfaces", !surfaces.is_empty(), "at least one surface")?;
        for (i, surface) in surfaces.iter().enumerate() {
            let within = surface.opacity.is_none_or(|a| (0.0..=1.0).contains(&a));
            check.require(&format!("effects.surfaces.{i}.opacity"), within, "0 to 1")?;
        }
    }
    let Some(shading) = &effects.shading else { return Ok(()) };
    let path = |key: &str| join("effects.shading", key);
    check.at_least(&path("ambient"), shading.ambient, 0.0)?;
    check.at_least(&path("diffuse"), shading.diffuse, 0.0)?;
    check.at_least(&path("specular"), shading.specular, 0.0)?;
    check.at_least(&path("shininess"), shading.shininess, 1.0)?;
    check.at_least(&path("soft_gradient_hu_per_mm"), shading.soft_gradient_hu_per_mm, 0.0)?;
    let Some(lights) = &shading.lights else { return Ok(()) };
    check.require(&path("lights"), !lights.is_empty(), "at least one light; without the key it is a headlight")?;
    for (i, light) in lights.iter().enumerate() {
        if let LightSpec::Directional { towards, .. } = light {
            let path = path(&format!("lights.{i}.directional.towards"));
            check.require(&path, towards.iter().any(|x| *x != 0.0), "a direction of any length but 0")?;
        }
    }
    Ok(())
}
