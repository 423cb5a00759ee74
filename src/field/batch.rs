//! Samples of a ray by the batch, as the lanes of registers take them.
//!
//! The first sample of a batch has a [`Position`] with 24 bits of fraction, and the others are offsets from it in units of 2⁻²⁴
//! voxels, which fit 32 bits. Where a sample is depends on its number alone: on the batch that the number falls into, and its
//! place in that batch.

use super::{Position, Step};
use crate::math::each;
use crate::simd::BATCH;

/// Samples in a batch.
pub const SAMPLES: usize = BATCH;

/// Most voxels along an axis between two samples of a batch whose offsets fit 32 bits.
pub const MOST_VOXELS_PER_STEP: f64 = 7.0;

/// From the first sample of a batch to each, along each axis, in units of 2⁻²⁴ voxels.
pub type Offsets = [[i32; SAMPLES]; 3];

/// Up to sixteen samples of a ray, equal steps apart but for the last one.
#[derive(Debug, Clone, Copy)]
pub struct Batch<'o> {
    /// The first one.
    pub first: Position,
    /// From each to the next.
    pub step: Step,
    /// The last one, if it is not a step behind the one before.
    pub last: Option<Position>,
    /// To each sample; those that there are not lie where the last one lies. Only where steps are short enough.
    pub offsets: &'o Offsets,
    /// Number of samples, at least 1.
    pub samples: usize,
}

/// The offsets of equal steps, of at most [`MOST_VOXELS_PER_STEP`].
#[inline(always)]
pub fn offsets(step: Step) -> Offsets {
    let mut all = [[0; SAMPLES]; 3];
    for k in 0..SAMPLES {
        let units = step.units(k);
        for (axis, units) in all.iter_mut().zip(units) {
            axis[k] = units;
        }
    }
    all
}

impl Batch<'_> {
    /// Most samples in a batch.
    pub const MOST: usize = SAMPLES;

    /// The position of a sample, by its number in the batch.
    #[inline(always)]
    pub fn position(&self, sample: usize) -> Position {
        match self.last {
            Some(last) if sample + 1 == self.samples => last,
            _ => self.first.advanced_rounded(self.step, sample),
        }
    }

    /// The offsets of these samples, given those of equal steps: the last sample is put in its place, and what is behind it too.
    #[inline(always)]
    pub fn place(&self, all: &Offsets) -> Offsets {
        let mut offsets = *all;
        let at = self.position(self.samples - 1).units_from(self.first);
        for (axis, at) in offsets.iter_mut().zip(at) {
            axis[self.samples - 1..].fill(at);
        }
        offsets
    }

    /// The cells of the first sample and of the last, by their lower corners. All others lie between, since a ray is straight.
    #[inline(always)]
    pub(super) fn ends(&self) -> [[i64; 3]; 2] {
        let (corner, fraction) = self.first.corner_and_fraction();
        [0, SAMPLES - 1].map(|k| each(|a| corner[a] + i64::from((fraction[a] + self.offsets[a][k]) >> 24)))
    }
}
