//! Checks on a pipeline.

use std::path::Path;

use super::camera::check_camera;
use super::widget::check_widgets;
use super::{Check, join};
use crate::error::Result;
use crate::spec::source::Source;
use crate::spec::{
    CompatibilityName, EffectsSpec, ImageSpec, IntegrateSpec, LatticeName, LayerSpec, LightSpec, MarchSpec, OrderName,
    PhantomSpec, Pipeline, RuleName, ValuesName, VolumeSpec,
};

/// Checks a pipeline as far as that is possible without its presets and its scan.
pub(in crate::spec) fn check_pipeline(source: &Source, pipeline: &Pipeline) -> Result<()> {
    let check = Check { source };
    check.require("version", pipeline.version == 1, "1")?;
    check_volume(check, &pipeline.volume)?;
    if let Some(normalise) = &pipeline.normalise {
        let [low, high] = normalise.hu;
        check.require("normalise.hu", low < high, "[lowest, highest], the lower first")?;
    }
    if let Some(gradient) = &pipeline.gradient {
        let [low, high] = gradient.range_hu_per_mm;
        check.require("gradient.range_hu_per_mm", low == 0.0 && high > 0.0, "[0, highest], the highest above 0")?;
    }
    check_what_shows(check, pipeline)?;
    for (i, layer) in pipeline.transfer_function.iter().enumerate() {
        check_layer(check, &format!("transfer_function.{i}"), layer)?;
    }
    if let Some(effects) = &pipeline.effects {
        check_effects(check, effects)?;
    }
    if let Some(camera) = &pipeline.camera {
        check_camera(check, camera)?;
    }
    if let Some(integrate) = &pipeline.integrate {
        check_integrate(check, integrate)?;
    }
    check.require("certify", pipeline.certify != Some(0), "a number of pixels of at least 1")?;
    check_output(check, pipeline.image.as_ref(), pipeline.output.as_deref())
}

fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

fn check_volume(check: Check<'_>, volume: &VolumeSpec) -> Result<()> {
    check.exactly_one("volume", &[("source", volume.source.is_some()), ("phantom", volume.phantom.is_some())])?;
    if let Some(PhantomSpec::Head(head)) = &volume.phantom {
        let size = head.size.map(f64::from);
        check.require(
            "volume.phantom.head.size",
            size.is_none_or(|n| (2.0..=1024.0).contains(&n)),
            "2 to 1024 voxels",
        )?;
    }
    let has_series = volume.series.is_some();
    check.unread("volume.series", has_series && volume.phantom.is_some(), "a phantom has no series")?;
    let is_file = volume.source.as_deref().is_some_and(|p| matches!(extension(p).as_str(), "nrrd" | "nhdr"));
    check.unread("volume.series", has_series && is_file, "a NRRD file has no series")?;
    let contradiction = volume.values == Some(ValuesName::Arbitrary) && volume.shift_hu.is_some();
    check.unread("volume.shift_hu", contradiction, "the values are said to be arbitrary, not HU")
}

fn check_layer(check: Check<'_>, path: &str, layer: &LayerSpec) -> Result<()> {
    check.exactly_one(path, &[("preset", layer.preset.is_some()), ("widgets", layer.widgets.is_some())])?;
    check.at_least(&join(path, "opacity_scale"), layer.opacity_scale, 0.0)?;
    check.above_zero(&join(path, "scale"), layer.scale)?;
    match &layer.widgets {
        Some(widgets) => check_widgets(check, &join(path, "widgets"), widgets),
        None => Ok(()),
    }
}

/// Light needs a transfer function; numbers of the values, and surfaces, have no use for one, nor numbers for shading.
fn check_what_shows(check: Check<'_>, pipeline: &Pipeline) -> Result<()> {
    let effects = pipeline.effects.clone().unwrap_or_default();
    let (project, surfaces) = (effects.project.is_some(), effects.surfaces.is_some());
    check.unread("effects.surfaces", project && surfaces, "effects.project shows a number of the values instead")?;
    let written = !pipeline.transfer_function.is_empty();
    let why = if project { "effects.project shows a number of the values" } else { "effects.surfaces shows surfaces" };
    check.unread("transfer_function", written && (project || surfaces), why)?;
    check.unread("effects.shading", effects.shading.is_some() && project, "a number of the values has no light")?;
    let marched = matches!(pipeline.integrate, Some(IntegrateSpec::March(_)));
    check.unread("integrate.march", marched && (project || surfaces), "they are exact, and take no steps")?;
    if project || surfaces {
        return Ok(());
    }
    check.require("transfer_function", written, "at least one layer")
}

fn check_effects(check: Check<'_>, effects: &EffectsSpec) -> Result<()> {
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

fn check_integrate(check: Check<'_>, integrate: &IntegrateSpec) -> Result<()> {
    match integrate {
        IntegrateSpec::Exact(exact) => {
            let within = exact.tolerance.is_none_or(|t| t > 0.0 && t < 1.0);
            check.require("integrate.exact.tolerance", within, "a number above 0 and below 1, such as 1/255")
        }
        IntegrateSpec::March(march) => check_march(check, march),
        IntegrateSpec::Reference => Ok(()),
    }
}

fn check_march(check: Check<'_>, march: &MarchSpec) -> Result<()> {
    let path = |key: &str| join("integrate.march", key);
    if march.step_mm.is_some() {
        check.exactly_one("integrate.march", &[("step_mm", true), ("step_voxels", march.step_voxels.is_some())])?;
    }
    check.above_zero(&path("step_mm"), march.step_mm)?;
    check.above_zero(&path("step_voxels"), march.step_voxels)?;
    let termination = march.termination_transmittance;
    let termination_path = path("termination_transmittance");
    check.require(&termination_path, termination.is_none_or(|t| (0.0..1.0).contains(&t)), "at least 0 and below 1")?;
    let vtk = march.compatibility == Some(CompatibilityName::Vtk);
    let whole_steps = march.rule == Some(RuleName::WholeSteps) || (vtk && march.rule.is_none());
    let why = "a table is made for one length of step: set rule: whole-steps";
    check.unread(&path("table"), march.table.is_some() && !whole_steps, why)?;
    let planes = march.lattice == Some(LatticeName::ViewPlanes);
    check.unread(&path("lattice"), planes && whole_steps, "whole steps begin at each ray's entry")?;
    if let Some(table) = &march.table {
        for (key, entries) in [("values", table.values), ("gradients", table.gradients)] {
            let within = entries.is_none_or(|n| (2..=65_536).contains(&n));
            check.require(&path(&format!("table.{key}")), within, "from 2 to 65536 entries")?;
        }
        let within = table.uncorrected_opacity.is_none_or(|a| (0.0..=1.0).contains(&a));
        check.require(&path("table.uncorrected_opacity"), within, "an opacity, 0 to 1")?;
    }
    let backwards = march.order == Some(OrderName::BackToFront);
    check.unread(&termination_path, termination.is_some() && backwards, "only front-to-back rays can stop early")
}

fn check_output(check: Check<'_>, image: Option<&ImageSpec>, output: Option<&Path>) -> Result<()> {
    let extension = output.map(extension);
    let known = extension.as_deref().is_none_or(|e| matches!(e, "png" | "exr"));
    check.require("output", known, "a file name that ends in .png or .exr")?;
    let Some(image) = image else { return Ok(()) };
    let size = image.size.unwrap_or([1, 1]);
    check.require(
        "image.size",
        size.iter().all(|n| (1..=65_535).contains(n)),
        "[width, height], each from 1 to 65535",
    )?;
    let is_exr = extension.as_deref() == Some("exr");
    check.unread("image.bits", image.bits.is_some() && is_exr, "an OpenEXR picture has 32-bit floats")
}
