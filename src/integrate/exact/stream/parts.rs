//! Pieces of lit cells that wait to be halved, side by side.

use std::array::from_fn;

use crate::math::each;
use crate::math::powers::Powers;
use crate::simd::{BATCH, Ints, Lanes, Mask};

/// Pieces, as many as a register has lanes.
#[derive(Clone, Copy)]
pub(super) struct Part<L: Lanes, const F: usize> {
    /// Which of the cells passed, and which ray, by its seat.
    pub(super) slot: L::Ints,
    pub(super) seat: L::Ints,
    /// The fields along the cell, and their intervals in the piece.
    pub(super) fields: [Powers<L>; F],
    pub(super) interval: [L::Ints; F],
    /// The gradient along the cell, HU/mm.
    pub(super) gradient: [Powers<L>; 3],
    /// Of the cell.
    pub(super) length_mm: L,
    /// Front and back of the piece, in `[0, 1]` of the cell.
    pub(super) ends: [L; 2],
    /// From the front of the cell to that of the piece.
    pub(super) transmittance: L,
    /// What may be missed.
    pub(super) allowed: L,
}

/// Any number of pieces, a row for each of their numbers.
#[derive(Debug)]
pub(super) struct Parts<const F: usize> {
    count: usize,
    slot: Vec<i32>,
    seat: Vec<i32>,
    fields: [[Vec<f32>; 4]; F],
    interval: [Vec<i32>; F],
    gradient: [[Vec<f32>; 4]; 3],
    /// Length of the cell, front, back, transmittance, what may be missed.
    numbers: [Vec<f32>; 5],
}

impl<const F: usize> Parts<F> {
    pub(super) fn new() -> Self {
        Parts {
            count: 0,
            slot: Vec::new(),
            seat: Vec::new(),
            fields: from_fn(|_| from_fn(|_| Vec::new())),
            interval: from_fn(|_| Vec::new()),
            gradient: from_fn(|_| from_fn(|_| Vec::new())),
            numbers: from_fn(|_| Vec::new()),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    fn floats(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        let fields = self.fields.iter_mut().flatten();
        fields.chain(self.gradient.iter_mut().flatten()).chain(&mut self.numbers)
    }

    fn ints(&mut self) -> impl Iterator<Item = &mut Vec<i32>> {
        [&mut self.slot, &mut self.seat].into_iter().chain(&mut self.interval)
    }

    /// Makes room for whole registers.
    #[cold]
    #[inline(never)]
    fn grow(&mut self, count: usize) {
        let room = count.next_multiple_of(BATCH).max(2 * self.slot.len());
        self.floats().for_each(|row| row.resize(room, 0.0));
        self.ints().for_each(|row| row.resize(room, 0));
    }

    /// Appends the chosen ones of a register's pieces.
    #[inline(always)]
    pub(super) fn append<L: Lanes>(&mut self, chosen: L::Mask, part: &Part<L, F>) {
        let at = self.count;
        if at + BATCH > self.slot.len() {
            self.grow(at + BATCH);
        }
        part.slot.compress(chosen).store(&mut self.slot[at..]);
        part.seat.compress(chosen).store(&mut self.seat[at..]);
        for f in 0..F {
            part.interval[f].compress(chosen).store(&mut self.interval[f][at..]);
            for k in 0..4 {
                part.fields[f][k].compress(chosen).store(&mut self.fields[f][k][at..]);
            }
        }
        for a in 0..3 {
            for k in 0..4 {
                part.gradient[a][k].compress(chosen).store(&mut self.gradient[a][k][at..]);
            }
        }
        let numbers = [part.length_mm, part.ends[0], part.ends[1], part.transmittance, part.allowed];
        for (row, x) in self.numbers.iter_mut().zip(numbers) {
            x.compress(chosen).store(&mut row[at..]);
        }
        self.count += chosen.bits().count_ones() as usize;
    }

    /// Moves all pieces of others behind these.
    #[inline(always)]
    pub(super) fn take<L: Lanes>(&mut self, others: &mut Parts<F>) {
        for first in (0..others.count).step_by(L::LANES) {
            self.append(others.are_parts::<L>(first), &others.load::<L>(first));
        }
        others.count = 0;
    }

    /// Which lanes have pieces, from one on.
    #[inline(always)]
    pub(super) fn are_parts<L: Lanes>(&self, first: usize) -> L::Mask {
        (L::Ints::count() + L::Ints::splat(first as i32)).lt(L::Ints::splat(self.count as i32))
    }

    /// As many as a register has lanes, or as there are.
    #[inline(always)]
    pub(super) fn load<L: Lanes>(&self, first: usize) -> Part<L, F> {
        let [length_mm, front, back, transmittance, allowed] = each(
            #[inline(always)]
            |n| L::load(&self.numbers[n][first..]),
        );
        Part {
            slot: L::Ints::load(&self.slot[first..]),
            seat: L::Ints::load(&self.seat[first..]),
            fields: each(
                #[inline(always)]
                |f| {
                    each(
                        #[inline(always)]
                        |k| L::load(&self.fields[f][k][first..]),
                    )
                },
            ),
            interval: each(
                #[inline(always)]
                |f| L::Ints::load(&self.interval[f][first..]),
            ),
            gradient: each(
                #[inline(always)]
                |a| {
                    each(
                        #[inline(always)]
                        |k| L::load(&self.gradient[a][k][first..]),
                    )
                },
            ),
            length_mm,
            ends: [front, back],
            transmittance,
            allowed,
        }
    }

    /// The slots of as many.
    #[inline(always)]
    pub(super) fn slots(&self, first: usize, most: usize) -> &[i32] {
        &self.slot[first..self.count.min(first + most)]
    }
}
