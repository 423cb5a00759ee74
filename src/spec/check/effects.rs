//! Checks on effects, and on what they leave for others to read.

use super::clip::check_clip;
use super::light::{check_directions, check_effects_of_light};
use super::pipeline::is_nrrd;
use super::show::{check_marched, check_projection, check_transport, reads_transfer_function};
use super::{Check, join};
use crate::error::Result;
use crate::spec::{ClassifyAtName, EffectsSpec, PhantomSpec, Pipeline, VolumeSpec};

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
    let at_voxels = effects.classify == Some(ClassifyAtName::Voxels);
    let needs_light = [
        ("depth_cue", effects.depth_cue.is_some(), true),
        ("fog", effects.fog.is_some(), true),
        ("haze", effects.haze.is_some(), false),
        ("shadows", effects.shadows.is_some(), false),
        ("scattering", effects.scattering.is_some(), false),
    ];
    for (effect, given, on_surfaces) in needs_light {
        let path = join("effects", effect);
        check.unread(&path, given && project, "a number of the values has no light")?;
        check.unread(&path, given && surfaces && !on_surfaces, "between surfaces nothing absorbs or scatters")?;
        check.unread(&path, given && at_voxels, "effects.classify: voxels shades at the voxels, and nothing else")?;
    }
    let classify = "effects.classify";
    check.unread(classify, effects.classify.is_some() && (project || surfaces), "there is no transfer function")?;
    if may_have_colors(&pipeline.volume) {
        return check_marched(check, pipeline);
    }
    check_marched(check, pipeline)?;
    check.require("transfer_function", written || !read, "at least one layer")
}

/// True if the volume may have colours of its own in place of values; what it has is known once it is read.
fn may_have_colors(volume: &VolumeSpec) -> bool {
    match (&volume.phantom, volume.source.as_deref()) {
        (Some(phantom), _) => matches!(phantom, PhantomSpec::Rings(_)),
        (None, source) => source.is_some_and(is_nrrd),
    }
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
    check_effects_of_light(check, effects)?;
    let Some(shading) = &effects.shading else { return Ok(()) };
    let path = |key: &str| join("effects.shading", key);
    check.at_least(&path("ambient"), shading.ambient, 0.0)?;
    check.at_least(&path("diffuse"), shading.diffuse, 0.0)?;
    check.at_least(&path("specular"), shading.specular, 0.0)?;
    check.at_least(&path("shininess"), shading.shininess, 1.0)?;
    check.at_least(&path("soft_gradient_hu_per_mm"), shading.soft_gradient_hu_per_mm, 0.0)?;
    let Some(lights) = &shading.lights else { return Ok(()) };
    check.require(&path("lights"), !lights.is_empty(), "at least one light; without the key it is a headlight")?;
    check_directions(check, &path("lights"), lights)
}
