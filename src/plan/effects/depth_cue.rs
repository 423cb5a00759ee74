//! The depth cue, resolved.

use super::{Absence, Asked, Surroundings};
use crate::scene::DepthCue;
use crate::spec::DepthCueSpec;

pub(super) fn resolve(written: Option<&DepthCueSpec>, surroundings: &Surroundings<'_>) -> Asked<DepthCue> {
    let &DepthCueSpec { constant, per_mm } = written.ok_or(Absence::NotNamed)?;
    let constant = constant.unwrap_or(1.0);
    if constant == 1.0 && per_mm == 0.0 {
        return Err(Absence::NoStrength("its constant is 1 and per_mm is 0".to_owned()));
    }
    if surroundings.shading.is_none_or(|shading| !shading.is_lit()) {
        return Err(Absence::Idle("it dims the lit terms of shading, and there are none".to_owned()));
    }
    Ok(DepthCue { constant, per_mm })
}
