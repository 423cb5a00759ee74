//! Haze, resolved.

use super::{Absence, Asked, Surroundings};
use crate::error::Result;
use crate::scene::Haze;
use crate::spec::{HazeSpec, Spec};

pub(super) fn resolve(spec: &Spec, written: Option<&HazeSpec>, surroundings: &Surroundings<'_>) -> Result<Asked<Haze>> {
    let Some(&HazeSpec { extinction_per_mm, color, end_mm }) = written else { return Ok(Err(Absence::NotNamed)) };
    let farthest_mm = surroundings.farthest_mm();
    if let Some(end_mm) = end_mm.filter(|&end_mm| end_mm < farthest_mm) {
        return Err(spec
            .error("effects.haze.end_mm", "the haze ends within the volume")
            .found(format!("{end_mm} mm"))
            .expected(format!("at least {farthest_mm:.1} mm, the distance of the volume's farthest corner"))
            .remedy("leave the key out, and it ends there"));
    }
    if extinction_per_mm == 0.0 {
        return Ok(Err(Absence::NoStrength("its extinction is 0".to_owned())));
    }
    let color = surroundings.color(color);
    Ok(Ok(Haze { extinction_per_mm, color, end_mm: end_mm.unwrap_or(farthest_mm) }))
}
