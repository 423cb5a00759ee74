//! Rays in flight: what reaches the eye so far, and what cells add to it.

use super::queue::{Passed, Results};
use super::walk::Walk;
use crate::integrate::exact::ray::{Front, Traced};

/// A ray in flight.
#[derive(Debug)]
pub(super) struct InFlight {
    pub(super) walk: Walk,
    pub(super) light: Front,
    /// Which of the rays asked for.
    pub(super) number: usize,
    /// How it ended, once it did.
    pub(super) traced: Option<Traced>,
}

/// Composites what cells do onto their rays. `again` integrates a cell again, with the care that its ray's budget asks for;
/// `rest` bounds what is left of a ray with some transmittance, so many mm before its end.
#[inline(always)]
pub(super) fn composite(
    passed: &Passed,
    results: &Results,
    rays: &mut [Option<InFlight>],
    rest: impl Fn(f64, f64) -> f64,
    mut again: impl FnMut(&Walk, &mut Front, usize),
) {
    for slot in 0..passed.count {
        if results.pieces[slot] == 0.0 {
            continue;
        }
        let Some(ray) = &mut rays[usize::from(passed.ray[slot])] else { continue };
        if ray.traced.is_some() {
            continue;
        }
        let exit_mm = passed.span_mm[slot][1];
        let radiance = [0, 1, 2].map(|c: usize| results.radiance[c][slot]);
        let (absorbed, error) = (results.absorbed[slot], results.error[slot]);
        let fraction = ray.walk.fraction(exit_mm);
        if !ray.light.take(radiance, absorbed, error, fraction, results.pieces[slot] as u64) {
            again(&ray.walk, &mut ray.light, slot);
        }
        let rest = rest(ray.light.transmittance(), ray.walk.exit_mm() - exit_mm);
        ray.traced = ray.light.may_end(rest).then(|| ray.light.ended(rest));
    }
    for ray in rays.iter_mut().flatten() {
        if ray.traced.is_none() && ray.walk.is_over() {
            ray.traced = Some(ray.light.ended(0.0));
        }
    }
}
