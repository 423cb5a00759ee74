//! Pieces of rays, prepared for lanes: samples at equal steps, all of which stand for the same length.

use crate::field::Chord;
use crate::integrate::march::lattice::Stretch;
use crate::integrate::tiles::TILE_PIXELS;
use crate::math::each;
use crate::simd::BATCH;

/// Pieces of a ray whose samples stand for an interval each: the first interval, the last one, and those between.
const PER_RAY: usize = 3;

/// Room for the pieces of a tile, and a whole register behind the last one.
const ROOM: usize = PER_RAY * TILE_PIXELS + BATCH;

/// Runs of a piece; the last one takes all samples that are left.
pub(super) const RUNS: usize = 16;

/// Most samples of a piece: 2⁻³² voxels of rounding, so many times, are 10⁻⁵ voxels.
pub(super) const MOST_SAMPLES: f64 = 65_000.0;

/// Added to a fraction, so that comparing signed integers compares fractions.
const BIAS: u32 = 1 << 31;

/// The pieces of a tile's rays. Positions are in fixed point, a lower corner and a fraction in units of 2⁻³² voxels, so that where
/// a sample is depends on its number alone.
pub(super) struct Pieces {
    pub(super) count: usize,
    /// The first sample: lower corner of its cell.
    pub(super) corner: [[i32; ROOM]; 3],
    /// Where in the cell, biased: 2⁻³² voxels, less one half.
    pub(super) fraction: [[i32; ROOM]; 3],
    /// A step, rounded down to whole voxels.
    pub(super) step: [[i32; ROOM]; 3],
    /// What was rounded off, 2⁻³² voxels, unsigned.
    pub(super) step_fraction: [[i32; ROOM]; 3],
    /// Samples; after a look around, of its first run.
    pub(super) samples: [i32; ROOM],
    /// The length that each sample stands for.
    pub(super) delta_mm: [f32; ROOM],
    /// Its number in the order of the rays.
    pub(super) number: [i32; ROOM],
    /// By number, the runs behind the first one: see [`runs`](super::runs).
    pub(super) runs: [i32; ROOM * RUNS],
    ends: Ends,
}

/// Of the pieces of a batch, the first and the last sample, continuous indices, and 1 by the number of steps between them, 0 if there
/// are none.
struct Ends {
    first: [[f64; BATCH]; 3],
    last: [[f64; BATCH]; 3],
    per_interval: [f64; BATCH],
}

impl Pieces {
    pub(super) fn new() -> Self {
        Pieces {
            count: 0,
            corner: [[0; ROOM]; 3],
            fraction: [[0; ROOM]; 3],
            step: [[0; ROOM]; 3],
            step_fraction: [[0; ROOM]; 3],
            samples: [0; ROOM],
            delta_mm: [0.0; ROOM],
            number: [0; ROOM],
            runs: [0; ROOM * RUNS],
            ends: Ends { first: [[0.0; BATCH]; 3], last: [[0.0; BATCH]; 3], per_interval: [0.0; BATCH] },
        }
    }

    /// No pieces.
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a stretch of a chord through a lattice of `dims` voxels. Its place and its steps are there after [`Pieces::finish`].
    #[inline(always)]
    pub(super) fn add(&mut self, chord: &Chord, stretch: &Stretch, dims: [usize; 3]) {
        let at = self.count;
        let first = chord.index_at(stretch.first_mm);
        let (last, per_interval) = match stretch.samples {
            0 | 1 => (first, 0.0),
            samples => (chord.index_at(stretch.last_mm), 1.0 / (samples - 1) as f64),
        };
        let Ends { first: firsts, last: lasts, per_interval: all_per_interval } = &mut self.ends;
        for a in 0..3 {
            firsts[a][at % BATCH] = first[a];
            lasts[a][at % BATCH] = last[a];
        }
        all_per_interval[at % BATCH] = per_interval;
        self.samples[at] = stretch.samples as i32;
        self.delta_mm[at] = stretch.delta_mm as f32;
        self.number[at] = at as i32;
        self.count += 1;
        if self.count.is_multiple_of(BATCH) {
            self.place(self.count - BATCH, dims);
        }
    }

    /// Places those that are not placed yet.
    #[inline(always)]
    pub(super) fn finish(&mut self, dims: [usize; 3]) {
        let left = self.count % BATCH;
        if left > 0 {
            self.place(self.count - left, dims);
        }
    }

    /// Places a batch of pieces. Without branches: compilers fill registers with them.
    #[inline(always)]
    fn place(&mut self, from: usize, dims: [usize; 3]) {
        let Ends { first, last, per_interval } = &self.ends;
        for a in 0..3 {
            let (corner, fraction) = (&mut self.corner[a][from..][..BATCH], &mut self.fraction[a][from..][..BATCH]);
            let (whole, rest) = (&mut self.step[a][from..][..BATCH], &mut self.step_fraction[a][from..][..BATCH]);
            for k in 0..BATCH {
                let (first, last) = (fixed(first[a][k], dims[a]), fixed(last[a][k], dims[a]));
                let step = step((last - first) as f64, per_interval[k]);
                (corner[k], fraction[k]) = ((first >> 32) as i32, (first as u32 ^ BIAS) as i32);
                (whole[k], rest[k]) = ((step >> 32) as i32, step as u32 as i32);
            }
        }
    }
}

/// The lower corner of the cell of a stretch's first sample, as [`Pieces::add`] has it.
#[inline(always)]
pub(super) fn corner(chord: &Chord, stretch: &Stretch, dims: [usize; 3]) -> [i32; 3] {
    let first = chord.index_at(stretch.first_mm);
    each(|a| (first[a] as i32).min(dims[a] as i32 - 2).max(0))
}

/// A continuous index in units of 2⁻³² voxels, clamped to the cells of an axis of so many voxels; on an axis of one voxel, 0.
#[inline(always)]
fn fixed(index: f64, voxels: usize) -> i64 {
    let end = (voxels as i64 - 1) << 32;
    ((index * (1u64 << 32) as f64) as i64).min(end - 1).max(0)
}

/// A part of a distance, rounded towards 0 so that no number of steps leads beyond the end.
#[inline(always)]
fn step(distance: f64, part: f64) -> i64 {
    // The product is off by 2⁻⁵² of itself, which is less than a thousandth where steps are shorter than 10⁶ voxels.
    let whole = (distance.abs() * part - 1e-3).max(0.0) as i64;
    if distance < 0.0 { -whole } else { whole }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn the_last_sample_is_where_it_should_be_and_never_beyond() {
        let dims = [700, 300, 1];
        let mut pieces = Pieces::new();
        for n in 0..300 {
            let u = |k: f64| (f64::from(n) * k).fract();
            let from = DVec3::new(699.0 * u(0.618), 299.0 * u(0.414), 0.0);
            let to = DVec3::new(699.0 * u(0.271).round(), 299.0 * u(0.828), 0.0);
            let chord = Chord { entry_mm: 3.0, length_mm: 1.0, entry_index: from, index_per_mm: to - from };
            let samples = [1, 2, 3, 977, 65_000][n as usize % 5];
            pieces.clear();
            pieces.add(&chord, &Stretch { first_mm: 0.0, last_mm: 1.0, samples, delta_mm: 0.5 }, dims);
            pieces.finish(dims);
            for a in 0..3 {
                let first = i64::from(pieces.corner[a][0]) << 32 | i64::from(pieces.fraction[a][0] as u32 ^ BIAS);
                let step = i64::from(pieces.step[a][0]) << 32 | i64::from(pieces.step_fraction[a][0] as u32);
                let last = first + step * (samples as i64 - 1);
                let end = ((dims[a] as i64 - 1) << 32).max(1);
                assert!((0..end).contains(&last), "axis {a}: {last:x} is outside");
                let expected = if samples == 1 { from[a] } else { to[a] };
                let apart = (last as f64 / 2f64.powi(32) - expected).abs();
                assert!(apart < 2e-5, "axis {a}, {samples} samples: {apart:e} voxels from the end");
            }
        }
    }
}
