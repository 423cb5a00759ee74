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
        let is_there = (L::Ints::count() + L::Ints::splat(first as i32)).lt(L::Ints::splat(count as i32));
        let number = L::Ints::load(&pieces.number[first..]);
        let at = number * L::Ints::splat(RUNS as i32);
        Search {
            place,
            start: place,
            per_voxel: place.steps_per_voxel(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::{Baked, bake};
    use crate::field::{BlockRanges, Chord, Trilinear};
    use crate::integrate::march::lattice::Stretch;
    use crate::simd::{self, Level};
    use crate::transfer::{Curve, Knot, Optics, Term, TransferFunction};
    use crate::volume::Rescale;
    use glam::DVec3;

    const DIMS: [usize; 3] = [61, 47, 39];

    /// Something shows around a few voxels.
    fn space() -> EmptySpace {
        let mut samples = vec![0i16; DIMS.iter().product()];
        for n in 0..40 {
            let [i, j, k] = [n * 37 % DIMS[0], n * 53 % DIMS[1], n * 29 % DIMS[2]];
            samples[i + DIMS[0] * (j + DIMS[1] * k)] = 100;
        }
        let knot = |value, extinction| Knot { value, optics: Optics::colored(extinction, [1.0; 3]) };
        let curve = Curve::new(vec![knot(50.0, 0.0), knot(100.0, 1.0)]).unwrap();
        let function = TransferFunction::new([-200.0, 200.0], 1.0, vec![Term { curve, weight: None }]).unwrap();
        let Baked::OneD(classifier) = bake::<f32>(&function, Rescale::IDENTITY) else {
            unreachable!("of the value alone")
        };
        EmptySpace::new(&BlockRanges::<2>::new(&Trilinear::new(&samples, DIMS).unwrap()), None, &classifier)
    }

    fn pieces(count: usize) -> Box<Pieces> {
        let mut pieces = Box::new(Pieces::new());
        for n in 0..count {
            let u = |k: f64| (n as f64 * k + 0.29).fract();
            let end = DVec3::from_array(DIMS.map(|n| (n - 1) as f64));
            let from = end * DVec3::new(u(0.618), u(0.414), u(0.732));
            let to = end * DVec3::new(u(0.271), u(0.828), if n % 3 == 0 { u(0.732) } else { u(0.577) });
            let chord = Chord { entry_mm: 0.0, length_mm: 1.0, entry_index: from, index_per_mm: to - from };
            let samples = [1, 90, 700][n % 3];
            pieces.add(&chord, &Stretch { first_mm: 0.0, last_mm: 1.0, samples, delta_mm: 1.0 }, DIMS);
        }
        pieces.finish(DIMS);
        pieces
    }

    /// Finds the runs of pieces: for each piece, which of its samples are in one.
    struct Found<'s>(&'s EmptySpace, usize);

    impl simd::Kernel for Found<'_> {
        type Output = Vec<Vec<bool>>;

        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let mut pieces = pieces(self.1);
            let samples = pieces.samples;
            let starts = Starts::of(&pieces, self.1);
            let mut found: Vec<Vec<bool>> = (0..self.1).map(|n| vec![false; samples[n] as usize]).collect();
            find::<L>(&mut pieces, Some(self.0));
            for at in 0..pieces.count {
                let number = pieces.number[at] as usize;
                let start = [0, 1, 2].map(|a| (pieces.corner[a][at], pieces.fraction[a][at]));
                let mut sample = starts.number_of(number, start);
                let mut run = pieces.samples[at];
                for next in number * RUNS.. {
                    found[number][sample..][..run as usize].fill(true);
                    sample += run as usize;
                    let word = pieces.runs[next];
                    if word == 0 {
                        break;
                    }
                    sample += (word >> 16 & 0xffff) as usize;
                    run = word & 0xffff;
                }
            }
            found
        }
    }

    /// Where all samples are.
    struct Starts(Vec<Vec<[(i32, i32); 3]>>);

    impl Starts {
        fn of(pieces: &Pieces, count: usize) -> Self {
            let along = |n: usize| {
                let mut place = Place::<f32>::load(pieces, n);
                let here = move |_| {
                    let here = [0, 1, 2].map(|a| (place.corner[a], place.fraction[a]));
                    place.advance(true);
                    here
                };
                (0..pieces.samples[n]).map(here).collect()
            };
            Starts((0..count).map(along).collect())
        }

        fn number_of(&self, piece: usize, start: [(i32, i32); 3]) -> usize {
            self.0[piece].iter().position(|&place| place == start).expect("a run begins at a sample")
        }
    }

    #[test]
    fn every_sample_in_an_active_block_is_in_a_run_and_few_others_are() {
        let space = space();
        let count = 300;
        let starts = Starts::of(&pieces(count), count);
        let expected: Vec<Vec<bool>> = starts
            .0
            .iter()
            .map(|all| all.iter().map(|p| space.is_active(p.map(|(corner, _)| corner))).collect())
            .collect();
        for level in Level::ALL {
            let found = level.run(Found(&space, count));
            let (mut more, mut shown) = (0, 0);
            for (n, (found, expected)) in found.iter().zip(&expected).enumerate() {
                let missed = found.iter().zip(expected).position(|(&found, &expected)| expected && !found);
                assert_eq!(missed, None, "{level}: a sample of piece {n} is in no run");
                more += found.iter().zip(expected).filter(|&(&found, &expected)| found && !expected).count();
                shown += expected.iter().filter(|&&shows| shows).count();
            }
            assert!(shown > 2000 && more * 20 < shown, "{level}: {more} samples in vain beside {shown}");
        }
    }
}
