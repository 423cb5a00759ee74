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
        }
    }

    /// Adds a stretch of a chord through a lattice of `dims` voxels.
    #[inline(always)]
    pub(super) fn add(&mut self, chord: &Chord, stretch: &Stretch, dims: [usize; 3]) {
        let at = self.count;
        self.count += 1;
        let first = chord.index_at(stretch.first_mm);
        for a in 0..3 {
            let first = fixed(first[a], dims[a]);
            self.corner[a][at] = (first >> 32) as i32;
            self.fraction[a][at] = (first as u32 ^ BIAS) as i32;
            (self.step[a][at], self.step_fraction[a][at]) = (0, 0);
        }
        if stretch.samples > 1 {
            let last = chord.index_at(stretch.last_mm);
            let per_interval = 1.0 / (stretch.samples - 1) as f64;
            for a in 0..3 {
                let step = step((fixed(last[a], dims[a]) - fixed(first[a], dims[a])) as f64, per_interval);
                self.step[a][at] = (step >> 32) as i32;
                self.step_fraction[a][at] = step as u32 as i32;
            }
        }
        self.samples[at] = stretch.samples as i32;
        self.delta_mm[at] = stretch.delta_mm as f32;
        self.number[at] = at as i32;
    }

    /// The corner of the cell of the first sample of the last piece.
    #[inline(always)]
    pub(super) fn last_corner(&self) -> [i32; 3] {
        each(|a| self.corner[a][self.count - 1])
    }

    /// Takes the last piece away.
    #[inline(always)]
    pub(super) fn take_back(&mut self) {
        self.count -= 1;
    }
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
            pieces.count = 0;
            pieces.add(&chord, &Stretch { first_mm: 0.0, last_mm: 1.0, samples, delta_mm: 0.5 }, dims);
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
