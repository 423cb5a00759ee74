//! Rays in flight: what reaches the eye so far, and what cells add to it.

use glam::DVec3;

use super::queue::{Passed, Results};
use super::walk::Walks;
use crate::integrate::exact::ray::{Front, Traced};

/// A ray in flight.
#[derive(Debug)]
pub(super) struct InFlight {
    pub(super) light: Front,
    /// The ray's.
    pub(super) direction: DVec3,
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
    walks: &Walks,
    rays: &mut [Option<InFlight>],
    rest: impl Fn(f64, f64) -> f64,
    mut again: impl FnMut(usize, DVec3, &mut Front, [i32; 3]),
) {
    for slot in results.slots() {
        let seat = passed.seat[slot] as usize;
        let Some(ray) = &mut rays[seat] else { continue };
        if ray.traced.is_some() {
            continue;
        }
        let (exit_mm, length_mm) = (f64::from(passed.exit_mm[slot]), walks.length_mm(seat));
        let [r, g, b] = &results.radiance;
        let (absorbed, error) = (results.absorbed[slot], results.error[slot]);
        let pieces = results.pieces[slot] as u64;
        let transmittance = ray.light.transmittance();
        if ray.light.take([r[slot], g[slot], b[slot]], absorbed, error, exit_mm * walks.per_length_mm(seat), pieces) {
            ray.light.vary(transmittance, f64::from(results.variance[slot]));
        } else {
            let [i, j, k] = &passed.cell;
            again(seat, ray.direction, &mut ray.light, [i[slot], j[slot], k[slot]]);
        }
        let rest = rest(ray.light.transmittance(), length_mm - exit_mm);
        ray.traced = ray.light.may_end(rest).then(|| ray.light.ended(rest));
    }
    for (seat, ray) in rays.iter_mut().enumerate() {
        if let Some(ray) = ray
            && ray.traced.is_none()
            && walks.is_over(seat)
        {
            ray.traced = Some(ray.light.ended(0.0));
        }
    }
}
