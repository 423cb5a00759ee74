//! Rays in lanes, each at a sample of its own.

use super::pieces::{Pieces, RUNS};
use super::place::Place;
use crate::simd::{Ints, Lanes, Mask};

/// As many pieces of rays as a register has lanes.
pub(super) struct Walk<L: Lanes> {
    /// The next sample.
    place: Place<L>,
    /// Samples that are left of the run.
    left: L::Ints,
    /// Where the next run is found; -1 if there is none.
    next_run: L::Ints,
    /// Samples of runs so far.
    taken: L::Ints,
    /// The length that each sample stands for.
    delta_mm: L,
    /// Number of the piece; -1 in an empty seat.
    number: L::Ints,
}

impl<L: Lanes> Walk<L> {
    /// Nobody.
    #[inline(always)]
    pub(super) fn new() -> Self {
        let none = L::Ints::splat(0);
        Walk {
            place: Place::new(),
            left: none,
            next_run: L::Ints::splat(-1),
            taken: none,
            delta_mm: L::ZERO,
            number: L::Ints::splat(-1),
        }
    }

    /// Who is at a sample to take.
    #[inline(always)]
    pub(super) fn active(&self) -> L::Mask {
        L::Ints::splat(0).lt(self.left)
    }

    /// Where somebody is.
    #[inline(always)]
    pub(super) fn seated(&self) -> L::Mask {
        L::Ints::splat(-1).lt(self.number)
    }

    /// Number of each one's piece, -1 in an empty seat.
    #[inline(always)]
    pub(super) fn number(&self) -> L::Ints {
        self.number
    }

    /// Samples that each has taken, once it has ended.
    #[inline(always)]
    pub(super) fn taken(&self) -> L::Ints {
        self.taken
    }

    /// The length that the samples stand for, mm.
    #[inline(always)]
    pub(super) fn delta_mm(&self) -> L {
        self.delta_mm
    }

    /// Where the next samples are: lower corners of their cells, and where in them, 0 to 1.
    #[inline(always)]
    pub(super) fn place(&self) -> ([L::Ints; 3], [L; 3]) {
        let mut fraction = [L::ZERO; 3];
        for a in 0..3 {
            fraction[a] = self.place.fraction(a);
        }
        (self.place.corner, fraction)
    }

    /// Goes to the next sample.
    #[inline(always)]
    pub(super) fn advance(&mut self, moving: L::Mask) {
        self.place.advance(moving);
        self.left = L::Ints::select(moving, self.left - L::Ints::splat(1), self.left);
    }

    /// Ends pieces early.
    #[inline(always)]
    pub(super) fn stop(&mut self, spent: L::Mask) {
        let none = L::Ints::splat(0);
        self.taken = L::Ints::select(spent, self.taken - self.left, self.taken);
        self.left = L::Ints::select(spent, none, self.left);
        self.next_run = L::Ints::select(spent, L::Ints::splat(-1), self.next_run);
    }

    /// Goes to the next runs of those who are at the end of one; says who has none.
    #[inline(always)]
    pub(super) fn go_on(&mut self, pieces: &Pieces, waiting: L::Mask) -> L::Mask {
        let none = L::Ints::splat(0);
        let run = L::Ints::gather(&pieces.runs, self.next_run);
        let run = L::Ints::select(waiting.and_not(self.next_run.lt(none)), run, none);
        let gap = run.shifted_right(16).and(L::Ints::splat(0xffff));
        self.place.leap(gap);
        self.run(waiting, run.and(L::Ints::splat(0xffff)));
        self.next_run = L::Ints::select(run.eq(none), self.next_run, self.next_run + L::Ints::splat(1));
        waiting.and(run.eq(none))
    }

    #[inline(always)]
    fn run(&mut self, lanes: L::Mask, samples: L::Ints) {
        self.left = L::Ints::select(lanes, samples, self.left);
        self.taken = L::Ints::select(lanes, self.taken + samples, self.taken);
    }

    /// Seats the pieces from number `next` on where nobody is left; says where.
    #[inline(always)]
    pub(super) fn seat(&mut self, pieces: &Pieces, next: &mut usize, free: L::Mask) -> L::Mask {
        let none = L::Ints::splat(0);
        let rank = L::Ints::count().expand(free);
        let taken = free.and(rank.lt(L::Ints::splat((pieces.count - *next) as i32)));
        self.place.expand(&Place::load(pieces, *next), free, taken);
        let samples = L::Ints::load(&pieces.samples[*next..]).expand(free);
        let number = L::Ints::load(&pieces.number[*next..]).expand(free);
        self.taken = L::Ints::select(free, none, self.taken);
        self.run(free, L::Ints::select(taken, samples, none));
        self.delta_mm = L::select(taken, L::load(&pieces.delta_mm[*next..]).expand(free), self.delta_mm);
        self.number = L::Ints::select(free, L::Ints::select(taken, number, L::Ints::splat(-1)), self.number);
        let first = L::Ints::select(taken, number * L::Ints::splat(RUNS as i32), L::Ints::splat(-1));
        self.next_run = L::Ints::select(free, first, self.next_run);
        *next += taken.bits().count_ones() as usize;
        taken
    }
}
