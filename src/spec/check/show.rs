//! Checks on what shows: light, a number of what lies along a ray, or surfaces; and on keys that only some of them read.

use super::{Check, join};
use crate::error::Result;
use crate::spec::{
    EffectsSpec, IntegrateSpec, MarchSpec, Pipeline, ProjectSpec, ProjectionOf, RuleName, TransportName,
};

/// Whether what shows is by the transfer function.
pub(super) fn reads_transfer_function(effects: &EffectsSpec) -> bool {
    match &effects.project {
        Some(project) => project.show == ProjectionOf::OpticalDepth,
        None => effects.surfaces.is_none(),
    }
}

/// A window goes with the unit of what it shows.
pub(super) fn check_projection(check: Check<'_>, project: &ProjectSpec) -> Result<()> {
    let path = |key| join("effects.project", key);
    let unit = match project.show {
        ProjectionOf::Sum => "window_hu_mm",
        ProjectionOf::OpticalDepth => "window_optical_depth",
        _ => "window_hu",
    };
    let windows = [
        ("window_hu", project.window_hu),
        ("window_hu_mm", project.window_hu_mm),
        ("window_optical_depth", project.window_optical_depth),
    ];
    for (key, window) in windows {
        let why = format!("what is shown is in other units, and its window is {unit}");
        check.unread(&path(key), window.is_some() && key != unit, &why)?;
        let rises = window.is_none_or(|[low, high]| low < high);
        check.require(&path(key), rises, "[lowest, highest], the lower first")?;
        // No number of the pipeline says how long rays are or how dense the patient is.
        let needed = key == unit && key != "window_hu";
        check.needed(
            &path(key),
            window.is_some() || !needed,
            &format!("{key}: [black, white], which has no default"),
        )?;
    }
    let local = project.show == ProjectionOf::LocalMaximum;
    let threshold = project.threshold_hu.is_some();
    check.unread(&path("threshold_hu"), threshold && !local, "only local-maximum has a threshold")?;
    check.needed(&path("threshold_hu"), threshold || !local, "threshold_hu, the least value that counts as a maximum")
}

/// Absorption and emission are of light.
pub(super) fn check_transport(check: Check<'_>, effects: &EffectsSpec) -> Result<()> {
    let EffectsSpec { light, shading, project, surfaces, .. } = effects;
    check.unread("effects.light", light.is_some() && project.is_some(), "effects.project shows no light")?;
    check.unread("effects.light", light.is_some() && surfaces.is_some(), "effects.surfaces shows surfaces")?;
    let absorbs_only = *light == Some(TransportName::Absorption);
    check.unread("effects.shading", shading.is_some() && absorbs_only, "what only absorbs has no light to shade")?;
    let Some(shading) = shading.as_ref().filter(|_| *light == Some(TransportName::Emission)) else { return Ok(()) };
    let why = "a highlight is of what absorbs, and effects.light shows emission alone";
    check.unread("effects.shading.specular", shading.specular.is_some(), why)?;
    check.unread("effects.shading.shininess", shading.shininess.is_some(), why)
}

/// What marching reads depends on what it shows: numbers are not composited, and surfaces lie between samples.
pub(super) fn check_marched(check: Check<'_>, pipeline: &Pipeline) -> Result<()> {
    let Some(IntegrateSpec::March(march)) = &pipeline.integrate else { return Ok(()) };
    let effects = pipeline.effects.as_ref();
    let (project, surfaces) =
        (effects.is_some_and(|e| e.project.is_some()), effects.is_some_and(|e| e.surfaces.is_some()));
    let MarchSpec {
        rule, bisections, order, colors, emission, termination_transmittance, compatibility, table, ..
    } = march;
    let unread = |key: &str, given: bool, why: &str| check.unread(&join("integrate.march", key), given, why);
    let whole_steps = *rule == Some(RuleName::WholeSteps) || (compatibility.is_some() && rule.is_none());
    unread("bisections", bisections.is_some() && !surfaces, "only surfaces are refined")?;
    unread("bisections", bisections.is_some() && whole_steps, "whole steps show surfaces at their samples")?;
    let between = surfaces && !whole_steps;
    unread("rule", rule.is_some() && between, "surfaces are looked for between the ends of each interval")?;
    let masked = effects.is_some_and(|e| e.mask.is_some());
    unread("table", table.is_some() && (project || surfaces || masked), "a table is of one transfer function")?;
    if project || surfaces {
        let why = if project { "a number is not composited" } else { "surfaces are composited in their order" };
        unread("order", order.is_some(), why)?;
        unread("colors", colors.is_some(), why)?;
        unread("emission", emission.is_some(), "only light is emitted")?;
    }
    unread("termination_transmittance", termination_transmittance.is_some() && project, "a number is not composited")
}
