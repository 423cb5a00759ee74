//! Shadows, resolved.

use super::{Absence, Asked, Surroundings};
use crate::scene::{Light, Shadows};
use crate::spec::ShadowsSpec;

pub(super) fn resolve(written: Option<&ShadowsSpec>, surroundings: &Surroundings<'_>) -> Asked<Shadows> {
    let strength = written.ok_or(Absence::NotNamed)?.strength.unwrap_or(1.0);
    if strength == 0.0 {
        return Err(Absence::NoStrength("their strength is 0".to_owned()));
    }
    let lit = surroundings.shading.filter(|shading| shading.is_lit());
    let Some(shading) = lit else {
        return Err(Absence::Idle("they dim the lit terms of shading, and there are none".to_owned()));
    };
    if !shading.lights.iter().any(|light| matches!(light, Light::Directional { .. })) {
        let why = "shading has no directional light, and a headlight's shadows hide behind what casts them";
        return Err(Absence::Idle(why.to_owned()));
    }
    Ok(Shadows { strength })
}
