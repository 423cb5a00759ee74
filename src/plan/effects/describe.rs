//! Effects in words, and as JSON.

use serde_json::{Value, json};

use crate::scene::{Effects, FogLaw};

/// Each effect of light that is computed, in the order in which they apply.
pub(in crate::plan) fn in_words(effects: &Effects) -> Vec<String> {
    let mut words = Vec::new();
    if let Some(cue) = effects.depth_cue {
        words.push(format!("depth cue 1/({} + {} d) of the lit terms, d in mm", cue.constant, cue.per_mm));
    }
    if let Some(shadows) = effects.shadows {
        words.push(format!("shadows of strength {}", shadows.strength));
    }
    if let Some(s) = &effects.scattering {
        let from = match s.lights.len() {
            1 => "1 light".to_owned(),
            n => format!("{n} lights"),
        };
        words.push(format!("scattering of {from}, albedo {}, anisotropy {}", s.albedo, s.anisotropy));
    }
    if let Some(fog) = effects.fog {
        let law = match fog.law {
            FogLaw::Linear { start_mm, end_mm } => format!("linear from {start_mm} to {end_mm} mm"),
            FogLaw::Exp { density_per_mm } => format!("exp({density_per_mm} z)"),
            FogLaw::Exp2 { density_per_mm } => format!("exp2({density_per_mm} z)"),
        };
        words.push(format!("fog {law}"));
    }
    if let Some(haze) = effects.haze {
        words.push(format!("haze of {} per mm to {:.1} mm", haze.extinction_per_mm, haze.end_mm));
    }
    words
}

/// The same as JSON, with all numbers in full; `null` for an effect that is not computed.
pub(in crate::plan) fn effects_json(effects: &Effects) -> Value {
    let fog = effects.fog.map(|fog| {
        let law = match fog.law {
            FogLaw::Linear { start_mm, end_mm } => json!({ "linear": { "start_mm": start_mm, "end_mm": end_mm } }),
            FogLaw::Exp { density_per_mm } => json!({ "exp": { "density_per_mm": density_per_mm } }),
            FogLaw::Exp2 { density_per_mm } => json!({ "exp2": { "density_per_mm": density_per_mm } }),
        };
        json!({ "law": law, "color": fog.color })
    });
    let scattering = effects.scattering.as_ref().map(|s| {
        let light =
            |(towards, color): &(glam::DVec3, [f64; 3])| json!({ "towards": towards.to_array(), "color": color });
        let lights: Vec<Value> = s.lights.iter().map(light).collect();
        json!({ "albedo": s.albedo, "anisotropy": s.anisotropy, "lights": lights })
    });
    json!({
        "depth_cue": effects.depth_cue.map(|cue| json!({ "constant": cue.constant, "per_mm": cue.per_mm })),
        "shadows": effects.shadows.map(|shadows| json!({ "strength": shadows.strength })),
        "scattering": scattering,
        "fog": fog,
        "haze": effects.haze.map(|haze| {
            json!({ "extinction_per_mm": haze.extinction_per_mm, "color": haze.color, "end_mm": haze.end_mm })
        })
    })
}
