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
    rest: [f64; RAYS],
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
        self.get(seat).ended(self.rest[seat])
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
        let splat = L::Doubles::splat;
        let [by_absorption, by_length] = Budget::of_pieces(self.tolerance);
        let by_absorption = splat(by_absorption);
        let by_length_per_mm = splat(by_length) * L::Doubles::load(&walks.per_lengths_mm()[first..]);
        let most = splat(self.most_at_end);
        let (per_absorbed, per_mm) = (splat(self.brightest.per_absorbed), splat(self.brightest.per_mm));
        let length_mm = L::Doubles::load(&walks.lengths_mm()[first..]);
        let nothing = L::Ints::splat(0);
        let mut goes_on = nothing.lt(L::Ints::load(&self.goes_on[first..]));
        let mut sums = Sums::<L>::load(self, first);
        for slot in (first..first + STEPS * RAYS).step_by(RAYS) {
            let pieces = L::load(&results.pieces[slot..]);
            let shows = goes_on.and(L::ZERO.lt(pieces));
            if !shows.any() {
                continue;
            }
            let [red, green, blue, absorbed] = L::load_vectors(&results.light[slot..]);
            let error = L::load(&results.error[slot..]);
            let exit_mm = L::load(&passed.exit_mm[slot..]).to_doubles();
            let t = sums.transmittance;
            let absorbed = t * absorbed.to_doubles();
            let next = t - absorbed;
            let error = t * error.to_doubles();
            let allowed = by_absorption * (splat(1.0) - next) + by_length_per_mm * exit_mm;
            // Nor does NaN fit.
            let fits = shows.and(error.le(allowed - sums.spent));
            for (c, radiance) in [red, green, blue].into_iter().enumerate() {
                let more = sums.radiance[c] + t * radiance.to_doubles();
                sums.radiance[c] = L::Doubles::select(fits, more, sums.radiance[c]);
            }
            sums.transmittance = L::Doubles::select(fits, next, t);
            sums.opacity = L::Doubles::select(fits, sums.opacity + absorbed, sums.opacity);
            sums.spent = L::Doubles::select(fits, sums.spent + error, sums.spent);
            if are_estimated {
                let variance = t * t * L::load(&results.variance[slot..]).to_doubles();
                sums.variance = L::Doubles::select(fits, sums.variance + variance, sums.variance);
            }
            sums.pieces = L::select(fits, sums.pieces + pieces, sums.pieces);
            let fails = shows.and_not(fits);
            if fails.any() {
                sums.store(self, first);
                for lane in (0..L::LANES).filter(|lane| fails.bits() >> lane & 1 == 1) {
                    let mut light = self.get(first + lane);
                    again(first + lane, slot + lane, &mut light);
                    self.set(first + lane, &light);
                }
                sums = Sums::load(self, first);
            }
            let is_faint = shows.and(sums.transmittance.le(most));
            if is_faint.any() {
                // What the rest of each ray may bring at most.
                let rest = per_absorbed.min(per_mm * (length_mm - exit_mm)).max(splat(1.0));
                let rest = sums.transmittance * rest;
                let ends = is_faint.and((sums.spent + rest).le(most));
                sums.rest = L::Doubles::select(ends, rest, sums.rest);
                goes_on = goes_on.and_not(ends);
            }
        }
        sums.store(self, first);
        L::Ints::select(goes_on, L::Ints::splat(1), nothing).store(&mut self.goes_on[first..]);
    }
}

/// The sums of as many rays as a register has lanes.
struct Sums<L: Lanes> {
    radiance: [L::Doubles; 3],
    transmittance: L::Doubles,
    opacity: L::Doubles,
    spent: L::Doubles,
    variance: L::Doubles,
    pieces: L,
    rest: L::Doubles,
}

impl<L: Lanes> Sums<L> {
    #[inline(always)]
    fn load(fronts: &Fronts, first: usize) -> Self {
        let [r, g, b] = &fronts.radiance;
        Sums {
            radiance: [L::Doubles::load(&r[first..]), L::Doubles::load(&g[first..]), L::Doubles::load(&b[first..])],
            transmittance: L::Doubles::load(&fronts.transmittance[first..]),
            opacity: L::Doubles::load(&fronts.opacity[first..]),
            spent: L::Doubles::load(&fronts.spent[first..]),
            variance: L::Doubles::load(&fronts.variance[first..]),
            pieces: L::load(&fronts.pieces[first..]),
            rest: L::Doubles::load(&fronts.rest[first..]),
        }
    }

    #[inline(always)]
    fn store(&self, fronts: &mut Fronts, first: usize) {
        for c in 0..3 {
            self.radiance[c].store(&mut fronts.radiance[c][first..]);
        }
        self.transmittance.store(&mut fronts.transmittance[first..]);
        self.opacity.store(&mut fronts.opacity[first..]);
        self.spent.store(&mut fronts.spent[first..]);
        self.variance.store(&mut fronts.variance[first..]);
        self.pieces.store(&mut fronts.pieces[first..]);
        self.rest.store(&mut fronts.rest[first..]);
    }
}
