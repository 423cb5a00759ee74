//! Checks on label masks.

use super::pipeline::check_layer;
use super::{Check, join};
use crate::error::Result;
use crate::spec::{IntegrateSpec, LabelSpec, MaskSpec, OtherLabels, Pipeline};

pub(super) fn check_mask(check: Check<'_>, pipeline: &Pipeline, mask: &MaskSpec) -> Result<()> {
    let path = |key: &str| join("effects.mask", key);
    check.exactly_one("effects.mask", &[("source", mask.source.is_some()), ("phantom", mask.phantom.is_some())])?;
    let made = pipeline.volume.phantom.is_some();
    check.unread(&path("phantom"), mask.phantom.is_some() && !made, "the volume is a scan, not a phantom")?;
    let says_something = !mask.labels.is_empty() || mask.default == Some(OtherLabels::Hide);
    check.needed(&path("labels"), says_something, "labels, such as { 1: hide }")?;
    let effects = pipeline.effects.as_ref();
    let of_values = effects.is_some_and(|e| e.project.is_some() || e.surfaces.is_some());
    for (label, look) in &mask.labels {
        let path = path(&format!("labels.{label}"));
        let is_number = label.bytes().all(|b| b.is_ascii_digit());
        let known = !is_number || label.parse::<u16>().is_ok();
        check.require(&path, known && !label.is_empty(), "a label from 0 to 65535, or a name")?;
        if let LabelSpec::Own(layer) = look {
            check.unread(&path, of_values, "effects.project and effects.surfaces show values, whatever their look")?;
            check_layer(check, &path, layer)?;
        }
    }
    let marched = matches!(pipeline.integrate, Some(IntegrateSpec::March(_)));
    check.unread("integrate.march", marched && of_values, "values under a mask are found exactly, without steps")
}
