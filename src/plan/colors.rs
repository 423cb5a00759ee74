//! RGBA volumes: what a pipeline may ask of them, and what it may ask of volumes of values alone.

use crate::error::{Error, Result};
use crate::spec::Spec;
use crate::volume::RgbaEncoding;

use super::VolumeInfo;

/// How a volume's colours are understood, `None` for a volume of values.
///
/// # Errors
/// `Fault::Spec` for keys that nothing reads in this combination, and for values without a transfer function.
pub(super) fn resolve(spec: &Spec, volume: &VolumeInfo) -> Result<Option<RgbaEncoding>> {
    let encoding = volume.storage.rgba_encoding();
    let pipeline = &spec.pipeline;
    let effects = pipeline.effects.clone().unwrap_or_default();
    let refuse = |given: bool, key_path: &str, why: &str| if given { Err(unread(spec, key_path, why)) } else { Ok(()) };
    if encoding.is_some() {
        let own = "the volume has colours with an opacity of its own";
        let no_values = "the volume has colours with an opacity, and no values";
        refuse(!pipeline.transfer_function.is_empty(), "transfer_function", own)?;
        refuse(effects.classify.is_some(), "effects.classify", own)?;
        refuse(pipeline.normalise.is_some(), "normalise", no_values)?;
        refuse(pipeline.gradient.is_some(), "gradient", no_values)?;
        refuse(pipeline.volume.values.is_some(), "volume.values", no_values)?;
        refuse(pipeline.volume.shift_hu.is_some(), "volume.shift_hu", no_values)?;
        refuse(effects.project.is_some(), "effects.project", no_values)?;
        refuse(effects.surfaces.is_some(), "effects.surfaces", no_values)?;
        refuse(effects.shading.is_some(), "effects.shading", no_values)?;
        let as_it_is = "the volume shows the light it has";
        let changes = [
            ("light", effects.light.is_some()),
            ("depth_cue", effects.depth_cue.is_some()),
            ("shadows", effects.shadows.is_some()),
            ("scattering", effects.scattering.is_some()),
            ("fog", effects.fog.is_some()),
            ("haze", effects.haze.is_some()),
            ("mask", effects.mask.is_some()),
        ];
        for (key, given) in changes {
            refuse(given, &format!("effects.{key}"), as_it_is)?;
        }
    } else {
        let values = "the volume has values, and no colours";
        refuse(pipeline.volume.opacity_length_mm.is_some(), "volume.opacity_length_mm", values)?;
        refuse(pipeline.volume.color_encoding.is_some(), "volume.color_encoding", values)?;
        if pipeline.transfer_function.is_empty() && effects.project.is_none() && effects.surfaces.is_none() {
            return Err(spec
                .error("transfer_function", "a key is missing")
                .expected("at least one layer, since the volume has values and no colours of its own"));
        }
    }
    Ok(encoding)
}

fn unread(spec: &Spec, key_path: &str, why: &str) -> Error {
    spec.error(key_path, format!("nothing would read this key: {why}")).remedy("remove the key")
}
