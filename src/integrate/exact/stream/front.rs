//! Rays in flight: what reaches the eye so far, and what cells add to it.

use super::queue::{Passed, Results};
use super::seats::Walks;
use super::walk::{RAYS, STEPS};
use crate::integrate::exact::budget::Budget;
use crate::integrate::exact::ray::{Brightest, Frame, Front, Traced};
use crate::simd::{Doubles, Ints, Lanes, Mask};

/// The light of the rays in flight, by seat: the [`Front`] of each, side by side.
#[derive(Debug)]
pub(super) struct Fronts {
    tolerance: f64,
    /// What pieces may cost together with the rest of a ray that ends early; none fits where no ray does.
    most_at_end: f64,
    brightest: Brightest,
    radiance: [[f64; RAYS]; 3],
    transmittance: [f64; RAYS],
    opacity: [f64; RAYS],
    spent: [f64; RAYS],
    /// Of errors that are estimated.
    variance: [f64; RAYS],
    pieces: [f32; RAYS],
    /// Bound on what is left of a ray that ended before it left the volume.
    rest: [f32; RAYS],
    /// 1 for a ray that goes on, 0 for one that has ended and for an empty seat.
    goes_on: [i32; RAYS],
}

impl Fronts {
    /// Nobody.
    pub(super) fn new(&Frame { tolerance, brightest, ends_early, .. }: &Frame<'_>) -> Self {
        let most_at_end = if ends_early { Budget::of_pieces_and_rest(tolerance) } else { f64::NEG_INFINITY };
        Fronts {
            tolerance,
            most_at_end,
            brightest,
            radiance: [[0.0; RAYS]; 3],
            transmittance: [0.0; RAYS],
            opacity: [0.0; RAYS],
            spent: [0.0; RAYS],
            variance: [0.0; RAYS],
            pieces: [0.0; RAYS],
            rest: [0.0; RAYS],
            goes_on: [0; RAYS],
        }
    }

    /// Seats a ray.
    #[inline(always)]
    pub(super) fn enter(&mut self, seat: usize) {
        self.set(seat, &Front::new(self.tolerance));
        self.rest[seat] = 0.0;
        self.goes_on[seat] = 1;
    }

    /// The light of a ray.
    #[inline(always)]
    pub(super) fn get(&self, seat: usize) -> Front {
        Front {
            radiance: [self.radiance[0][seat], self.radiance[1][seat], self.radiance[2][seat]],
            transmittance: self.transmittance[seat],
            opacity: self.opacity[seat],
            budget: Budget::resumed(self.tolerance, self.spent[seat]),
            variance: self.variance[seat],
            pieces: self.pieces[seat] as u64,
        }
    }

    #[inline(always)]
    fn set(&mut self, seat: usize, light: &Front) {
        for (channel, x) in self.radiance.iter_mut().zip(light.radiance) {
            channel[seat] = x;
        }
        self.transmittance[seat] = light.transmittance;
        self.opacity[seat] = light.opacity;
        self.spent[seat] = light.budget.spent();
        self.variance[seat] = light.variance;
        self.pieces[seat] = light.pieces as f32;
    }

    /// A bit for each seat whose ray has ended, and for each empty one.
    #[inline(always)]
    pub(super) fn ended<L: Lanes>(&self, walks: &Walks) -> u32 {
        const { assert!(RAYS <= u32::BITS as usize, "a bit each") };
        let mut ended = 0;
        for first in (0..RAYS).step_by(L::LANES) {
            let stopped = L::Ints::load(&self.goes_on[first..]).lt(L::Ints::splat(1));
            ended |= stopped.or(walks.are_over::<L>(first)).bits() << first;
        }
        ended
    }

    /// How the ray in a seat ended.
    #[inline(always)]
    pub(super) fn take(&mut self, seat: usize) -> Traced {
        self.goes_on[seat] = 0;
        self.get(seat).ended(f64::from(self.rest[seat]))
    }

    /// Composites what cells do onto their rays, step by step. `again` integrates the cell of a ray again, by its seat and its
    /// slot, with the care that the ray's budget asks for. Results have variances if their errors are estimated.
    #[inline(always)]
    pub(super) fn composite<L: Lanes>(
        &mut self,
        passed: &Passed,
        results: &Results,
        are_estimated: bool,
        walks: &Walks,
        mut again: impl FnMut(usize, usize, &mut Front),
    ) {
        for first in (0..RAYS).step_by(L::LANES) {
            self.composite_lanes::<L>(first, passed, results, are_estimated, walks, &mut again);
        }
    }

    #[inline(always)]
    fn composite_lanes<L: Lanes>(
        &mut self,
        first: usize,
        passed: &Passed,
        results: &Results,
        are_estimated: bool,
        walks: &Walks,
        again: &mut impl FnMut(usize, usize, &mut Front),
    ) {
        let splat = L::from_f64;
        let [by_absorption, by_length] = Budget::of_pieces(self.tolerance);
        let by_absorption = splat(by_absorption);
        let by_length_per_mm = splat(by_length) * from_doubles(&walks.per_lengths_mm()[first..]);
        let most = splat(self.most_at_end);
        let (per_absorbed, per_mm) = (splat(self.brightest.per_absorbed), splat(self.brightest.per_mm));
        let length_mm: L = from_doubles(&walks.lengths_mm()[first..]);
        let nothing = L::Ints::splat(0);
        let mut goes_on = nothing.lt(L::Ints::load(&self.goes_on[first..]));
        let mut sums = Sums::<L>::new(self, first);
        for slot in (first..first + STEPS * RAYS).step_by(RAYS) {
            let pieces = L::load(&results.pieces[slot..]);
            let shows = goes_on.and(L::ZERO.lt(pieces));
            if !shows.any() {
                continue;
            }
            let [red, green, blue, absorbed] = L::load_vectors(&results.light[slot..]);
            let exit_mm = L::load(&passed.exit_mm[slot..]);
            let t = L::ONE - sums.opacity;
            let opacity = t.mul_plus(absorbed, sums.opacity);
            let transmittance = sums.before * (L::ONE - opacity);
            let error = sums.before * t * L::load(&results.error[slot..]);
            let allowed = by_absorption.mul_plus(L::ONE - transmittance, by_length_per_mm * exit_mm);
            // Nor does NaN fit.
            let fits = shows.and(error.le(allowed - sums.spent));
            for (c, radiance) in [red, green, blue].into_iter().enumerate() {
                let more = t.mul_plus(radiance, sums.radiance[c]);
                sums.radiance[c] = L::select(fits, more, sums.radiance[c]);
            }
            sums.opacity = L::select(fits, opacity, sums.opacity);
            sums.spent = L::select(fits, sums.spent + error, sums.spent);
            if are_estimated {
                let t = sums.before * t;
                let variance = (t * t).mul_plus(L::load(&results.variance[slot..]), sums.variance);
                sums.variance = L::select(fits, variance, sums.variance);
            }
            sums.pieces = L::select(fits, sums.pieces + pieces, sums.pieces);
            let fails = shows.and_not(fits);
            if fails.any() {
                sums.add_to(self, first, fails);
                for lane in (0..L::LANES).filter(|lane| fails.bits() >> lane & 1 == 1) {
                    let mut light = self.get(first + lane);
                    again(first + lane, slot + lane, &mut light);
                    self.set(first + lane, &light);
                }
                sums.begin_again(self, first, fails);
            }
            let transmittance = sums.before * (L::ONE - sums.opacity);
            let is_faint = shows.and(transmittance.le(most));
            if is_faint.any() {
                // What the rest of each ray may bring at most.
                let rest = per_absorbed.min(per_mm * (length_mm - exit_mm)).max(L::ONE);
                let rest = transmittance * rest;
                let ends = is_faint.and((sums.spent + rest).le(most));
                L::select(ends, rest, L::load(&self.rest[first..])).store(&mut self.rest[first..]);
                goes_on = goes_on.and_not(ends);
            }
        }
        sums.add_to(self, first, <L::Mask as Mask>::ALL);
        L::Ints::select(goes_on, L::Ints::splat(1), nothing).store(&mut self.goes_on[first..]);
    }
}

/// What cells of a round add to the light of as many rays as a register has lanes, in f32: of a round's few cells, rounding is
/// that of the cells themselves. What all rounds add up to is kept in f64.
struct Sums<L: Lanes> {
    /// Transmittance before these cells.
    before: L,
    /// As if that were 1. What is left of it follows from the opacity, which has all its digits however small it is.
    radiance: [L; 3],
    opacity: L,
    /// Of all the ray.
    spent: L,
    variance: L,
    pieces: L,
}

impl<L: Lanes> Sums<L> {
    /// Of no cells.
    #[inline(always)]
    fn new(fronts: &Fronts, first: usize) -> Self {
        Sums {
            before: from_doubles(&fronts.transmittance[first..]),
            radiance: [L::ZERO; 3],
            opacity: L::ZERO,
            spent: from_doubles(&fronts.spent[first..]),
            variance: from_doubles(&fronts.variance[first..]),
            pieces: L::load(&fronts.pieces[first..]),
        }
    }

    /// Adds them to the light of the rays of some lanes.
    #[inline(always)]
    fn add_to(&self, fronts: &mut Fronts, first: usize, lanes: L::Mask) {
        let before = L::Doubles::load(&fronts.transmittance[first..]);
        let sums = self.radiance.into_iter().zip(&mut fronts.radiance);
        for (sum, all) in sums.chain([(self.opacity, &mut fronts.opacity)]) {
            let all = &mut all[first..];
            let so_far = L::Doubles::load(all);
            L::Doubles::select(lanes, before.mul_plus(sum.to_doubles(), so_far), so_far).store(all);
        }
        let after = before * (L::Doubles::splat(1.0) - self.opacity.to_doubles());
        L::Doubles::select(lanes, after, before).store(&mut fronts.transmittance[first..]);
        self.spent.to_doubles().store(&mut fronts.spent[first..]);
        self.variance.to_doubles().store(&mut fronts.variance[first..]);
        self.pieces.store(&mut fronts.pieces[first..]);
    }

    /// Forgets those of some lanes, whose rays have been passed on.
    #[inline(always)]
    fn begin_again(&mut self, fronts: &Fronts, first: usize, lanes: L::Mask) {
        let mut again = Sums::new(fronts, first);
        for c in 0..3 {
            again.radiance[c] = L::select(lanes, L::ZERO, self.radiance[c]);
        }
        again.opacity = L::select(lanes, L::ZERO, self.opacity);
        *self = again;
    }
}

/// The nearest f32 to the first numbers of a slice.
#[inline(always)]
fn from_doubles<L: Lanes>(numbers: &[f64]) -> L {
    L::from_doubles(L::Doubles::load(numbers))
}
