//! Fog, resolved.

use super::{Absence, Asked, Surroundings};
use crate::scene::{Fog, FogLaw};
use crate::spec::FogSpec;

pub(super) fn resolve(written: Option<&FogSpec>, surroundings: &Surroundings<'_>) -> Asked<Fog> {
    let written = written.ok_or(Absence::NotNamed)?;
    let law = match (&written.linear, &written.exp, &written.exp2) {
        (Some(linear), ..) => FogLaw::Linear { start_mm: linear.start_mm, end_mm: linear.end_mm },
        (_, Some(exp), _) => FogLaw::Exp { density_per_mm: exp.density_per_mm },
        (.., exp2) => FogLaw::Exp2 { density_per_mm: exp2.as_ref().map_or(0.0, |exp2| exp2.density_per_mm) },
    };
    let farthest_mm = surroundings.farthest_mm();
    match law {
        _ if !law.is_clear_until(farthest_mm) => Ok(Fog { law, color: surroundings.color(written.color) }),
        FogLaw::Linear { start_mm, .. } => Err(Absence::Idle(format!(
            "it begins at {start_mm} mm, behind the volume, which ends at {farthest_mm:.1} mm"
        ))),
        FogLaw::Exp { .. } | FogLaw::Exp2 { .. } => Err(Absence::NoStrength("its density is 0".to_owned())),
    }
}
