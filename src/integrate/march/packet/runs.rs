//! Where along its pieces a ray meets something: runs of samples in active blocks, and how many samples lie between them.
//!
//! All pieces of a tile look around before any sample is taken, as many at once as a register has lanes. A run is an integer: the samples
//! to leap over before it, times 2¹⁶, and the samples that it has; 0 behind the last one.

use super::pieces::{Pieces, RUNS};
use super::place::Place;
use crate::integrate::empty_space::EmptySpace;
use crate::simd::{BATCH, Ints, Lanes, Mask};

/// Voxels that rounding may add to the distance from a face.
const ROUNDING: f64 = 1.0 / (1 << 23) as f64;

/// Finds the runs of all pieces. Those that have one remain, and begin with the first.
#[inline(always)]
pub(super) fn find<L: Lanes>(pieces: &mut Pieces, space: Option<&EmptySpace>) {
    let count = pieces.count;
    let Some(space) = space else {
        for piece in 0..count {
            pieces.runs[piece * RUNS] = 0;
        }
        return;
    };
    pieces.count = 0;
    for first in (0..count).step_by(L::LANES) {
        Search::<L>::new(pieces, first, count).run(pieces, space);
    }
}

/// As many pieces as a register has lanes.
struct Search<L: Lanes> {
    place: Place<L>,
    /// Where the first run begins.
    start: Place<L>,
    per_voxel: [L; 3],
    /// Samples that are not looked at yet.
    rest: L::Ints,
    /// Samples that are empty, behind the last run written down.
    gap: L::Ints,
    /// Samples behind those that are not.
    run: L::Ints,
    /// Samples of the first run; 0 as long as there is none.
    first: L::Ints,
    /// Where the next run but the first one is written down, and the last place for that.
    at: L::Ints,
    last: L::Ints,
    delta_mm: L,
    number: L::Ints,
}

impl<L: Lanes> Search<L> {
    #[inline(always)]
    fn new(pieces: &Pieces, first: usize, count: usize) -> Self {
        let none = L::Ints::splat(0);
        let place = Place::load(pieces, first);
        let mut per_voxel = [L::ZERO; 3];
        for a in 0..3 {
            per_voxel[a] = L::load(&pieces.per_voxel[a][first..]);
        }
        let is_there = (L::Ints::count() + L::Ints::splat(first as i32)).lt(L::Ints::splat(count as i32));
        let number = L::Ints::load(&pieces.number[first..]);
        let at = number * L::Ints::splat(RUNS as i32);
        Search {
            place,
            start: place,
            per_voxel,
            rest: L::Ints::select(is_there, L::Ints::load(&pieces.samples[first..]), none),
            gap: none,
            run: none,
            first: none,
            at,
            last: at + L::Ints::splat(RUNS as i32 - 2),
            delta_mm: L::load(&pieces.delta_mm[first..]),
            number,
        }
    }

    #[inline(always)]
    fn run(mut self, pieces: &mut Pieces, space: &EmptySpace) {
        let none = L::Ints::splat(0);
        loop {
            let looking = none.lt(self.rest);
            if !looking.any() {
                break;
            }
            let (samples, active) = self.look(space);
            let active = looking.and(active);
            let ends = looking.and_not(active).and(none.lt(self.run));
            if ends.any() {
                self.end(ends, &mut pieces.runs);
            }
            let begins = active.and(self.run.eq(none));
            // The last run that there is room for takes all that is left.
            let samples = L::Ints::select(begins.and(self.at.eq(self.last)), self.rest, samples);
            let samples = L::Ints::select(looking, samples, none);
            self.start.set(begins.and(self.first.eq(none)), &self.place);
            self.run = L::Ints::select(active, self.run + samples, self.run);
            self.gap = L::Ints::select(active, self.gap, self.gap + samples);
            self.rest = self.rest - samples;
            self.place.leap(samples);
        }
        self.end(none.lt(self.run), &mut pieces.runs);
        let shows = none.lt(self.first);
        let mut at = [0; BATCH];
        self.at.store(&mut at);
        for_each(
            shows,
            #[inline(always)]
            |k| pieces.runs[at[k] as usize] = 0,
        );
        let to = pieces.count;
        pieces.count += shows.bits().count_ones() as usize;
        self.start.compress(shows, pieces, to);
        self.first.compress(shows).store(&mut pieces.samples[to..]);
        self.delta_mm.compress(shows).store(&mut pieces.delta_mm[to..]);
        self.number.compress(shows).store(&mut pieces.number[to..]);
    }

    /// How many samples from here on are in active blocks, or surely in empty ones; and whether in active ones.
    #[inline(always)]
    fn look(&self, space: &EmptySpace) -> (L::Ints, L::Mask) {
        let none = L::Ints::splat(0);
        let (log2_cells, reach, active) = space.beside::<L>(self.place.corner);
        let cells = L::Ints::splat(1 << log2_cells);
        let above = reach * cells;
        let below = cells - above;
        let mut steps = L::from_f64(65_535.0);
        for a in 0..3 {
            let corner = self.place.corner[a];
            let low = corner.and(L::Ints::splat(-1 << log2_cells));
            let face = low + L::Ints::select(self.place.step[a].lt(none), below, above);
            let distance = (L::from_ints(face - corner) - self.place.fraction(a)).abs();
            let surely = (distance - L::from_f64(ROUNDING)).max(L::from_f64(1e-20));
            steps = steps.min(surely * self.per_voxel[a]);
        }
        // The n-th step is inside if n < distance / step; the product above exceeds that by less than 3e-7 of itself.
        let samples = (steps * L::from_f64(1.0 - 1e-6)).to_ints() + L::Ints::splat(1);
        (samples.min(self.rest), active)
    }

    /// Writes runs down.
    #[inline(always)]
    fn end(&mut self, ends: L::Mask, runs: &mut [i32]) {
        let none = L::Ints::splat(0);
        let later = ends.and(none.lt(self.first));
        self.first = L::Ints::select(ends.and_not(later), self.run, self.first);
        if later.any() {
            let (mut at, mut run) = ([0; BATCH], [0; BATCH]);
            self.at.store(&mut at);
            (self.gap * L::Ints::splat(1 << 16) + self.run).store(&mut run);
            for_each(
                later,
                #[inline(always)]
                |k| runs[at[k] as usize] = run[k],
            );
            self.at = L::Ints::select(later, self.at + L::Ints::splat(1), self.at);
        }
        self.gap = L::Ints::select(ends, none, self.gap);
        self.run = L::Ints::select(ends, none, self.run);
    }
}

/// Calls with the number of each lane for which a mask is true.
#[inline(always)]
pub(super) fn for_each(mask: impl Mask, mut call: impl FnMut(usize)) {
    let mut bits = mask.bits();
    while bits != 0 {
        call(bits.trailing_zeros() as usize);
        bits &= bits - 1;
    }
}
