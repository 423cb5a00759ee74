//! Positions of samples in lanes, in fixed point: where a sample is depends on its number alone, however rays come to it.

use super::pieces::Pieces;
use crate::simd::{Ints, Lanes, Mask};

/// Samples of as many rays as a register has lanes, each with the step to the next, as [`Pieces`] has them.
#[derive(Clone, Copy)]
pub(super) struct Place<L: Lanes> {
    pub(super) corner: [L::Ints; 3],
    pub(super) fraction: [L::Ints; 3],
    pub(super) step: [L::Ints; 3],
    step_fraction: [L::Ints; 3],
}

impl<L: Lanes> Place<L> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        let none = [L::Ints::splat(0); 3];
        Place { corner: none, fraction: none, step: none, step_fraction: none }
    }

    /// The first samples of pieces from number `first` on.
    #[inline(always)]
    pub(super) fn load(pieces: &Pieces, first: usize) -> Self {
        let mut place = Place::new();
        for a in 0..3 {
            place.corner[a] = L::Ints::load(&pieces.corner[a][first..]);
            place.fraction[a] = L::Ints::load(&pieces.fraction[a][first..]);
            place.step[a] = L::Ints::load(&pieces.step[a][first..]);
            place.step_fraction[a] = L::Ints::load(&pieces.step_fraction[a][first..]);
        }
        place
    }

    /// These lanes in order, at the front, as pieces from number `first` on.
    #[inline(always)]
    pub(super) fn compress(&self, lanes: L::Mask, pieces: &mut Pieces, first: usize) {
        for a in 0..3 {
            self.corner[a].compress(lanes).store(&mut pieces.corner[a][first..]);
            self.fraction[a].compress(lanes).store(&mut pieces.fraction[a][first..]);
            self.step[a].compress(lanes).store(&mut pieces.step[a][first..]);
            self.step_fraction[a].compress(lanes).store(&mut pieces.step_fraction[a][first..]);
        }
    }

    /// The first lanes of another, in order, where seats are free; those that are taken change.
    #[inline(always)]
    pub(super) fn expand(&mut self, from: &Self, free: L::Mask, taken: L::Mask) {
        for a in 0..3 {
            self.corner[a] = L::Ints::select(taken, from.corner[a].expand(free), self.corner[a]);
            self.fraction[a] = L::Ints::select(taken, from.fraction[a].expand(free), self.fraction[a]);
            self.step[a] = L::Ints::select(taken, from.step[a].expand(free), self.step[a]);
            self.step_fraction[a] = L::Ints::select(taken, from.step_fraction[a].expand(free), self.step_fraction[a]);
        }
    }

    /// These lanes of another.
    #[inline(always)]
    pub(super) fn set(&mut self, lanes: L::Mask, to: &Self) {
        for a in 0..3 {
            self.corner[a] = L::Ints::select(lanes, to.corner[a], self.corner[a]);
            self.fraction[a] = L::Ints::select(lanes, to.fraction[a], self.fraction[a]);
        }
    }

    /// Where in the cell along an axis, 0 to 1.
    #[inline(always)]
    pub(super) fn fraction(&self, a: usize) -> L {
        L::from_ints(self.fraction[a]) * L::from_f64(1.0 / (1u64 << 32) as f64) + L::from_f64(0.5)
    }

    /// Goes to the next sample.
    #[inline(always)]
    pub(super) fn advance(&mut self, moving: L::Mask) {
        for a in 0..3 {
            let fraction = self.fraction[a] + self.step_fraction[a];
            let carries = moving.and(fraction.lt(self.fraction[a]));
            let corner = self.corner[a] + self.step[a];
            self.fraction[a] = L::Ints::select(moving, fraction, self.fraction[a]);
            self.corner[a] = L::Ints::select(moving, corner, self.corner[a]);
            self.corner[a] = L::Ints::select(carries, self.corner[a] + L::Ints::splat(1), self.corner[a]);
        }
    }

    /// Goes so many samples further, fewer than 2¹⁶: exactly where single steps lead.
    #[inline(always)]
    pub(super) fn leap(&mut self, samples: L::Ints) {
        let (half, one) = (L::Ints::splat(0xffff), L::Ints::splat(1));
        for a in 0..3 {
            // samples · step_fraction has 48 bits: in two parts of 32 bits, 16 apart.
            let upper = samples * self.step_fraction[a].shifted_right(16).and(half);
            let first = self.fraction[a] + samples * self.step_fraction[a].and(half);
            let both = first + upper * L::Ints::splat(1 << 16);
            let mut corner = self.corner[a] + samples * self.step[a] + upper.shifted_right(16).and(half);
            corner = L::Ints::select(first.lt(self.fraction[a]), corner + one, corner);
            corner = L::Ints::select(both.lt(first), corner + one, corner);
            self.corner[a] = corner;
            self.fraction[a] = both;
        }
    }
}
