//! Checks on a pipeline.

use std::path::Path;

use super::analytic::check_analytic;
use super::camera::{check_camera, check_views};
use super::clean::check_clean;
use super::effects::{check_effects, check_what_shows};
use super::light::check_emission;
use super::mask::check_mask;
use super::widget::check_widgets;
use super::{Check, join};
use crate::error::Result;
use crate::spec::source::Source;
use crate::spec::{
    AttenuationSpec, AutoSpec, Bits, CompatibilityName, ImageSpec, IntegrateSpec, LatticeName, LayerSpec, MarchSpec,
    OrderName, PhantomSpec, Pipeline, RuleName, ValuesName, VolumeSpec,
};
use crate::transfer::attenuation::ENERGIES_KEV;

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
    check_clean(check, &pipeline.clean)?;
    if let Some(effects) = &pipeline.effects {
        check_effects(check, effects)?;
        if let Some(mask) = &effects.mask {
            check_mask(check, pipeline, mask)?;
        }
    }
    if let Some(camera) = &pipeline.camera {
        check_camera(check, "camera", camera)?;
    }
    if let Some(views) = &pipeline.views {
        check_views(check, pipeline.camera.as_ref(), views)?;
    }
    if let Some(integrate) = &pipeline.integrate {
        check_integrate(check, integrate)?;
    }
    check_emission(check, pipeline)?;
    check.require("certify", pipeline.certify != Some(0), "a number of pixels of at least 1")?;
    check_output(check, pipeline.image.as_ref(), pipeline.output.as_deref())
}

pub(super) fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// True for the name of a NRRD file.
pub(super) fn is_nrrd(path: &Path) -> bool {
    matches!(extension(path).as_str(), "nrrd" | "nhdr")
}

fn check_volume(check: Check<'_>, volume: &VolumeSpec) -> Result<()> {
    let sources = [
        ("source", volume.source.is_some()),
        ("phantom", volume.phantom.is_some()),
        ("analytic", volume.analytic.is_some()),
    ];
    check.exactly_one("volume", &sources)?;
    if let Some(analytic) = &volume.analytic {
        check_analytic(check, "volume.analytic", analytic)?;
    }
    let (path, size) = match &volume.phantom {
        Some(PhantomSpec::Head(head)) => ("volume.phantom.head.size", head.size),
        Some(PhantomSpec::Chest(chest)) => ("volume.phantom.chest.size", chest.size),
        Some(PhantomSpec::Rings(rings)) => ("volume.phantom.rings.size", rings.size),
        None => ("volume.phantom", None),
    };
    check.require(path, size.is_none_or(|n| (2..=1024).contains(&n)), "2 to 1024 voxels")?;
    check.above_zero("volume.opacity_length_mm", volume.opacity_length_mm)?;
    let has_series = volume.series.is_some();
    check.unread("volume.series", has_series && volume.phantom.is_some(), "a phantom has no series")?;
    check.unread("volume.series", has_series && volume.analytic.is_some(), "a formula has no series")?;
    let is_file = volume.source.as_deref().is_some_and(is_nrrd);
    check.unread("volume.series", has_series && is_file, "a NRRD file has no series")?;
    let is_made = volume.phantom.is_some() || volume.analytic.is_some();
    let has_slices = volume.slices.is_some();
    check.unread("volume.slices", has_slices && is_made, "only DICOM slices may lie where they were not asked to")?;
    check.unread("volume.slices", has_slices && is_file, "the slices of a NRRD file are even")?;
    let contradiction = volume.values == Some(ValuesName::Arbitrary) && volume.shift_hu.is_some();
    check.unread("volume.shift_hu", contradiction, "the values are said to be arbitrary, not HU")
}

pub(super) fn check_layer(check: Check<'_>, path: &str, layer: &LayerSpec) -> Result<()> {
    let (preset, widgets) = (layer.preset.is_some(), layer.widgets.is_some());
    let attenuation = layer.attenuation.as_ref();
    let kinds = [("preset", preset), ("widgets", widgets), ("attenuation", attenuation.is_some())];
    check.exactly_one(path, &kinds)?;
    check_attenuation(check, path, layer)?;
    check.at_least(&join(path, "opacity_scale"), layer.opacity_scale, 0.0)?;
    check.above_zero(&join(path, "scale"), layer.scale)?;
    match &layer.widgets {
        Some(widgets) => check_widgets(check, &join(path, "widgets"), widgets),
        None => Ok(()),
    }
}

fn check_attenuation(check: Check<'_>, path: &str, layer: &LayerSpec) -> Result<()> {
    let Some(AttenuationSpec { kev, scanned_at_kev }) = &layer.attenuation else { return Ok(()) };
    let [low, high] = ENERGIES_KEV;
    for (key, kev) in [("kev", Some(*kev)), ("scanned_at_kev", *scanned_at_kev)] {
        let within = kev.is_none_or(|kev| (low..=high).contains(&kev));
        check.require(&format!("{path}.attenuation.{key}"), within, &format!("{low} to {high} keV, as tabulated"))?;
    }
    check.unread(&join(path, "color"), layer.color.is_some(), "attenuation emits no light, so it has no colour")
}

fn check_integrate(check: Check<'_>, integrate: &IntegrateSpec) -> Result<()> {
    match integrate {
        IntegrateSpec::Exact(exact) => {
            let within = exact.tolerance.is_none_or(|t| t > 0.0 && t < 1.0);
            check.require("integrate.exact.tolerance", within, "a number above 0 and below 1, such as 1/255")
        }
        IntegrateSpec::March(march) => check_march(check, march),
        IntegrateSpec::Reference => Ok(()),
        IntegrateSpec::Auto(auto) => check_auto(check, auto),
    }
}

fn check_auto(check: Check<'_>, auto: &AutoSpec) -> Result<()> {
    if auto.tolerance.is_some() {
        check.exactly_one("integrate.auto", &[("tolerance", true), ("budget_ms", auto.budget_ms.is_some())])?;
    }
    let within = auto.tolerance.is_none_or(|t| t > 0.0 && t < 1.0);
    check.require("integrate.auto.tolerance", within, "a number above 0 and below 1, such as 1/255")?;
    check.above_zero("integrate.auto.budget_ms", auto.budget_ms)
}

fn check_march(check: Check<'_>, march: &MarchSpec) -> Result<()> {
    let path = |key: &str| join("integrate.march", key);
    if march.step_mm.is_some() {
        check.exactly_one("integrate.march", &[("step_mm", true), ("step_voxels", march.step_voxels.is_some())])?;
    }
    check.above_zero(&path("step_mm"), march.step_mm)?;
    check.above_zero(&path("step_voxels"), march.step_voxels)?;
    check.require(&path("bisections"), march.bisections.is_none_or(|n| n <= 32), "at most 32")?;
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
    check_bits(check, image.and_then(|image| image.bits), output)?;
    let Some(image) = image else { return Ok(()) };
    let size = image.size.unwrap_or([1, 1]);
    check.require("image.size", size.iter().all(|n| (1..=65_535).contains(n)), "[width, height], each from 1 to 65535")
}

/// Checks the name of a picture, and that its format reads the number of bits.
pub(super) fn check_bits(check: Check<'_>, bits: Option<Bits>, output: Option<&Path>) -> Result<()> {
    let extension = output.map(extension);
    let known = extension.as_deref().is_none_or(|e| matches!(e, "png" | "exr"));
    check.require("output", known, "a file name that ends in .png or .exr")?;
    let is_exr = extension.as_deref() == Some("exr");
    check.unread("image.bits", bits.is_some() && is_exr, "an OpenEXR picture has 32-bit floats")
}
