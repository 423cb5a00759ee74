//! Cells that cross knots, on their way from piece to piece in lanes of their own.
//!
//! Some have two pieces, some ten. So a cell that has been passed makes room for the next one while its neighbours go on.

use super::function::Function;
use super::pieces::{Runs, load_fields};
use super::queue::{ROOM, Results, Shown};
use crate::integrate::exact::piece::Integral;
use crate::math::powers::Powers;
use crate::simd::{Ints, Lanes, Mask};

/// Fields of cells at the beginning of their ways, a row for each of their numbers.
#[derive(Debug)]
pub(super) struct Beginnings<const F: usize> {
    pub(super) powers: [[[f32; ROOM]; 4]; F],
    pub(super) critical: [[[f32; ROOM]; 2]; F],
    pub(super) interval: [[i32; ROOM]; F],
    pub(super) rounding: [[f32; ROOM]; F],
}

impl<const F: usize> Beginnings<F> {
    pub(super) fn new() -> Self {
        Beginnings {
            powers: [[[0.0; ROOM]; 4]; F],
            critical: [[[0.0; ROOM]; 2]; F],
            interval: [[0; ROOM]; F],
            rounding: [[0.0; ROOM]; F],
        }
    }

    /// Prepares all cells, in full registers.
    #[inline(always)]
    pub(super) fn prepare<L: Lanes>(&mut self, shown: &Shown<F>, function: &impl Function<F>) {
        for first in (0..shown.count).step_by(L::LANES) {
            Runs::new(&load_fields::<L, F>(shown, first), function).store(self, first);
        }
    }
}

/// Lanes that the next cells have taken.
pub(super) struct Taken<L: Lanes> {
    free: L::Mask,
    lanes: L::Mask,
    /// The number of the first of these cells.
    first: usize,
}

impl<L: Lanes> Taken<L> {
    /// The cells' numbers of a row, and in other lanes what was there.
    #[inline(always)]
    pub(super) fn numbers(&self, row: &[f32; ROOM], before: L) -> L {
        L::select(self.lanes, L::load(&row[self.first..]).expand(self.free), before)
    }

    /// The same of integers.
    #[inline(always)]
    pub(super) fn ints(&self, row: &[i32; ROOM], before: L::Ints) -> L::Ints {
        L::Ints::select(self.lanes, L::Ints::load(&row[self.first..]).expand(self.free), before)
    }

    /// The seats of the rays that pass the cells.
    #[inline(always)]
    pub(super) fn seats<const F: usize>(&self, shown: &Shown<F>, before: L::Ints) -> L::Ints {
        L::Ints::select(self.lanes, shown.seats::<L>(self.first).expand(self.free), before)
    }

    /// One number for all of the cells, and in other lanes what was there.
    #[inline(always)]
    pub(super) fn all(&self, x: L, before: L) -> L {
        L::select(self.lanes, x, before)
    }

    /// The numbers of cubics by powers.
    #[inline(always)]
    pub(super) fn powers(&self, rows: &[[f32; ROOM]; 4], powers: &mut Powers<L>) {
        for k in 0..4 {
            powers[k] = self.numbers(&rows[k], powers[k]);
        }
    }

    /// Lanes for which something held, if it no longer does for these cells.
    #[inline(always)]
    pub(super) fn none(&self, before: L::Mask) -> L::Mask {
        before.and_not(self.lanes)
    }
}

/// As many cells as a register has lanes, each at a place of its own.
pub(super) struct Crossing<L: Lanes, const F: usize> {
    pub(super) runs: Runs<L, F>,
    pub(super) slot: L::Ints,
    /// Of the cells.
    pub(super) length_mm: L,
    /// How far each has been passed, in `[0, 1]`, and what it has done to light so far.
    pub(super) from: L,
    pub(super) transmittance: L,
    pub(super) total: Integral<L>,
    pub(super) variance: L,
    pub(super) pieces: L,
    is_seated: L::Mask,
    /// The first cell that waits.
    next: usize,
}

impl<L: Lanes, const F: usize> Crossing<L, F> {
    /// Nobody.
    #[inline(always)]
    pub(super) fn new() -> Self {
        Crossing {
            runs: Runs::nowhere(),
            slot: L::Ints::splat(0),
            length_mm: L::ZERO,
            from: L::ONE,
            transmittance: L::ONE,
            total: Integral::nothing(),
            variance: L::ZERO,
            pieces: L::ZERO,
            is_seated: L::ONE.lt(L::ZERO),
            next: 0,
        }
    }

    /// Sees to it that enough lanes have a cell to pass, and says which have; `seated` is told who has come. What has been passed
    /// goes to the results, with its variance if errors are estimated.
    #[inline(always)]
    pub(super) fn attend(
        &mut self,
        shown: &Shown<F>,
        beginnings: &Beginnings<F>,
        are_estimated: bool,
        results: &mut Results,
        seated: impl FnOnce(&Taken<L>),
    ) -> L::Mask {
        let open = self.is_seated.and(self.from.lt(L::ONE));
        let idle = L::LANES - open.bits().count_ones() as usize;
        let waiting = shown.count - self.next;
        // Few idle lanes cost less than looking after them.
        if if waiting > 0 { idle <= L::LANES / 4 } else { open.any() } {
            return open;
        }
        self.put(self.is_seated.and_not(open), are_estimated, results);
        self.is_seated = open;
        if waiting > 0 {
            let free = <L::Mask as Mask>::ALL.and_not(open);
            let rank = L::Ints::count().expand(free);
            let lanes = free.and(rank.lt(L::Ints::splat(waiting as i32)));
            let taken = Taken { free, lanes, first: self.next };
            self.runs.seat(beginnings, &taken);
            self.slot = taken.ints(&shown.slot, self.slot);
            self.length_mm = taken.numbers(&shown.length_mm, self.length_mm);
            self.from = taken.all(L::ZERO, self.from);
            self.transmittance = taken.all(L::ONE, self.transmittance);
            for sum in self.total.radiance.iter_mut().chain([
                &mut self.total.absorbed,
                &mut self.total.error,
                &mut self.variance,
                &mut self.pieces,
            ]) {
                *sum = taken.all(L::ZERO, *sum);
            }
            self.is_seated = open.or(lanes);
            self.next += idle.min(waiting);
            seated(&taken);
        }
        self.is_seated
    }

    /// Goes on by a piece that ends at `to`, where lanes are open.
    #[inline(always)]
    pub(super) fn pass(&mut self, piece: &Integral<L>, open: L::Mask, to: L) {
        let t = self.transmittance;
        self.total.absorbed = t.mul_plus(piece.absorbed, self.total.absorbed);
        self.transmittance = t.minus_product(t, piece.absorbed);
        self.pieces += L::select(open, L::ONE, L::ZERO);
        self.from = to;
    }

    /// Adds a piece's light, as bright as it is behind `transmittance`.
    #[inline(always)]
    pub(super) fn add(&mut self, piece: &Integral<L>, transmittance: L) {
        for c in 0..3 {
            self.total.radiance[c] = transmittance.mul_plus(piece.radiance[c], self.total.radiance[c]);
        }
        self.total.error = transmittance.mul_plus(piece.error, self.total.error);
    }

    #[inline(always)]
    fn put(&self, ended: L::Mask, are_estimated: bool, results: &mut Results) {
        if !ended.any() {
            return;
        }
        let integral = Integral { error: self.runs.checked(self.total.error), ..self.total };
        let mut slots = [0; crate::simd::BATCH];
        self.slot.store(&mut slots);
        results.put(ended, &slots, &integral, are_estimated.then_some(self.variance), Some(self.pieces));
    }
}
