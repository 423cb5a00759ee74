//! Checks on effects, and on what they leave for others to read.

use super::clip::check_clip;
use super::show::{check_marched, check_projection, check_transport, reads_transfer_function};
use super::{Check, join};
use crate::error::Result;
use crate::spec::{EffectsSpec, LightSpec, Pipeline};

/// Light needs a transfer function; numbers of the values, and surfaces, have no use for one, nor numbers for shading.
pub(super) fn check_what_shows(check: Check<'_>, pipeline: &Pipeline) -> Result<()> {
    let effects = pipeline.effects.clone().unwrap_or_default();
    let (project, surfaces) = (effects.project.is_some(), effects.surfaces.is_some());
    check.unread("effects.surfaces", project && surfaces, "effects.project shows a number of the values instead")?;
    let written = !pipeline.transfer_function.is_empty();
    let why = if project { "effects.project shows a number of the values" } else { "effects.surfaces shows surfaces" };
    let read = reads_transfer_function(&effects);
    check.unread("transfer_function", written && !read, why)?;
    check.unread("effects.shading", effects.shading.is_some() && project, "a number of the values has no light")?;
    check_transport(check, &effects)?;
    check_marched(check, pipeline)?;
    check.require("transfer_function", written || !read, "at least one layer")
}

pub(super) fn check_effects(check: Check<'_>, effects: &EffectsSpec) -> Result<()> {
    if let Some(clip) = &effects.clip {
        check_clip(check, clip)?;
    }
    if let Some(project) = &effects.project {
        check_projection(check, project)?;
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
