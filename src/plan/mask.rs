//! Label masks, resolved: which class the voxels of each label have, and what each class shows.

use std::collections::BTreeMap;

use crate::error::{Error, Fault, Result};
use crate::scene::{Class, Mask};
use crate::spec::{LabelSpec, MaskSpec, OtherLabels, Spec};
use crate::transfer::TransferFunction;

use super::layers::{self, Layer};
use super::light::Scales;
use super::{LabelInfo, VolumeInfo};

/// The classes of shown and of hidden voxels; labels with a look of their own follow.
const SHOWN: u8 = 0;
const HIDDEN: u8 = 1;

/// Which class the voxels of each label have.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelClasses {
    listed: BTreeMap<u16, u8>,
    others: u8,
    /// What is hidden and what has a look of its own, in words.
    pub(super) description: String,
}

impl LabelClasses {
    /// The class of a label's voxels.
    pub fn class(&self, label: u16) -> u8 {
        self.listed.get(&label).copied().unwrap_or(self.others)
    }
}

/// A mask that tells something apart.
pub(super) struct ResolvedMask {
    pub(super) mask: Mask,
    pub(super) classes: LabelClasses,
}

/// What the pipeline says of a mask.
pub(super) fn written(spec: &Spec) -> Option<&MaskSpec> {
    spec.pipeline.effects.as_ref()?.mask.as_ref()
}

/// The mask of a spec; `None` if there is none, or if all labels that occur show what the transfer function says. `domain` is
/// that of the scene's transfer function.
pub(super) fn resolve(
    spec: &Spec,
    volume: &VolumeInfo,
    domain: ([f64; 2], f64),
    scales: Scales,
) -> Result<Option<ResolvedMask>> {
    let Some(written) = written(spec) else { return Ok(None) };
    let labels = volume
        .labels
        .as_ref()
        .ok_or_else(|| Error::new(Fault::Spec, "the labels of the mask were not read").element("effects.mask"))?;
    let (window, gradient_range_per_mm) = domain;
    let others = if written.default == Some(OtherLabels::Hide) { HIDDEN } else { SHOWN };
    let mut classes = vec![Class::Shown, Class::Hidden];
    let mut listed = BTreeMap::new();
    let mut own = Vec::new();
    for (key, look) in &written.labels {
        let key_path = format!("effects.mask.labels.{key}");
        let label = number(spec, labels, key, &key_path)?;
        let class = match look {
            LabelSpec::Show => SHOWN,
            LabelSpec::Hide => HIDDEN,
            LabelSpec::Own(layer) => {
                let preset = spec.label_preset(key);
                let place = layers::Place { key_path: &key_path, name: key };
                let Layer { name, terms, .. } =
                    layers::layer(spec, volume, layer, preset, place, gradient_range_per_mm, scales)?;
                own.push(if preset.is_some() { format!("{key} as {name}") } else { key.clone() });
                classes.push(Class::Own(TransferFunction::new(window, gradient_range_per_mm, terms)?));
                u8::try_from(classes.len() - 1).map_err(|_| too_many(spec))?
            }
        };
        if listed.insert(label, class).is_some() {
            return Err(spec
                .error(&key_path, "a label is listed twice")
                .found(format!("{key}, which is label {label}")));
        }
    }
    let description = describe(written, own, others);
    let resolved = LabelClasses { listed, others, description };
    let has_effect = labels.counts.keys().any(|&label| resolved.class(label) != SHOWN);
    Ok(has_effect.then_some(ResolvedMask { mask: Mask { classes }, classes: resolved }))
}

/// The number of a label that is written by number or by name.
fn number(spec: &Spec, labels: &LabelInfo, key: &str, key_path: &str) -> Result<u16> {
    let known = match key.parse() {
        Ok(number) => Some(number).filter(|n| labels.counts.contains_key(n) || labels.names.values().any(|m| m == n)),
        Err(_) => labels.names.get(key).copied(),
    };
    known.ok_or_else(|| {
        let names = labels.names.iter().map(|(name, number)| format!("{number} ({name})"));
        let unnamed = labels.counts.keys().filter(|n| !labels.names.values().any(|m| m == *n)).map(u16::to_string);
        let all: Vec<String> = unnamed.chain(names).collect();
        let shown = all.iter().take(40).cloned().collect::<Vec<_>>().join(", ");
        let more = if all.len() > 40 { format!(" and {} more", all.len() - 40) } else { String::new() };
        let error = spec.error(key_path, "there is no such label in the label volume").found(key);
        error.expected(format!("one of {shown}{more}"))
    })
}

fn too_many(spec: &Spec) -> Error {
    spec.error("effects.mask.labels", "there are too many labels with a look of their own")
        .expected(format!("at most {}", usize::from(u8::MAX) - 1))
}

fn describe(written: &MaskSpec, own: Vec<String>, others: u8) -> String {
    let named = |look: LabelSpec| {
        let labels = written.labels.iter().filter(|(_, l)| **l == look).map(|(key, _)| key.as_str());
        labels.collect::<Vec<_>>().join(", ")
    };
    let (hidden, shown) = (named(LabelSpec::Hide), named(LabelSpec::Show));
    let rest = if others == HIDDEN { "all else hidden" } else { "all else shown" };
    let parts = [("hidden: ", hidden), ("shown: ", shown), ("", own.join(", "))];
    let parts =
        parts.into_iter().filter(|(_, labels)| !labels.is_empty()).map(|(what, labels)| format!("{what}{labels}"));
    parts.chain([rest.to_owned()]).collect::<Vec<_>>().join("; ")
}

/// Labels that are listed and named, and that no voxel has.
pub(super) fn without_voxels(spec: &Spec, volume: &VolumeInfo) -> Vec<String> {
    let (Some(written), Some(labels)) = (written(spec), volume.labels.as_ref()) else { return Vec::new() };
    let occurs = |key: &&String| {
        let number = key.parse().ok().or_else(|| labels.names.get(key.as_str()).copied());
        number.is_some_and(|n: u16| labels.counts.contains_key(&n))
    };
    written.labels.keys().filter(|key| !occurs(key)).cloned().collect()
}
