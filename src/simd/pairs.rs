//! Samples with their neighbours along i, in lanes.

use std::ops::Sub;

use super::{Ints, Lanes};
use crate::math::each;

/// Samples that are read two neighbours at a time.
pub(crate) trait Pairs: Sized {
    /// Samples in lanes as they are stored, so that differences are rounded once at most.
    type Stored<L: Lanes>: Copy + Sub<Output = Self::Stored<L>>;

    /// As f32.
    fn to_lanes<L: Lanes>(stored: Self::Stored<L>) -> L;
    /// The samples at these distances from `at`, and the next ones. Indices at which no pair begins give another pair of the slice,
    /// which has at least two samples and at most 2³¹.
    fn pairs<L: Lanes, const N: usize>(samples: &[Self], at: L::Ints, away: &Away<N>) -> [[Self::Stored<L>; 2]; N];
    /// The samples at these distances, and how much more the next ones are, as f32.
    fn rises<L: Lanes, const N: usize>(samples: &[Self], at: L::Ints, away: &Away<N>) -> [[L; 2]; N];
    /// The samples from each of these distances from `at` to three further on; likewise, of a slice of at least four.
    fn quads<L: Lanes, const N: usize>(samples: &[Self], at: L::Ints, away: &Away<N>) -> [[Self::Stored<L>; 4]; N];
    /// The lines through cells with their lower corners at `at`, and those beside them.
    #[inline(always)]
    fn around<L: Lanes>(samples: &[Self], at: L::Ints, stencil: &Stencil) -> Around<Self, L> {
        Around {
            lines: Self::quads::<L, 4>(samples, at, &stencil.lines),
            rows: Self::pairs::<L, 4>(samples, at, &stencil.rows),
            slabs: Self::pairs::<L, 4>(samples, at, &stencil.slabs),
        }
    }
}

impl Pairs for i16 {
    type Stored<L: Lanes> = L::Ints;

    #[inline(always)]
    fn to_lanes<L: Lanes>(stored: L::Ints) -> L {
        L::from_ints(stored)
    }
    #[inline(always)]
    fn pairs<L: Lanes, const N: usize>(samples: &[i16], at: L::Ints, away: &Away<N>) -> [[L::Ints; 2]; N] {
        let both = L::pairs_i16(samples, at, away);
        each(
            #[inline(always)]
            |n| two_of(both[n]),
        )
    }
    #[inline(always)]
    fn rises<L: Lanes, const N: usize>(samples: &[i16], at: L::Ints, away: &Away<N>) -> [[L; 2]; N] {
        let both = L::pairs_i16(samples, at, away);
        each(
            #[inline(always)]
            |n| [L::from_ints(both[n].low_half()), L::from_ints(both[n].rise())],
        )
    }
    #[inline(always)]
    fn quads<L: Lanes, const N: usize>(samples: &[i16], at: L::Ints, away: &Away<N>) -> [[L::Ints; 4]; N] {
        let both = L::quads_i16(samples, at, away);
        each(
            #[inline(always)]
            |n| four_of(both[n]),
        )
    }
}

#[inline(always)]
fn two_of<I: Ints>(both: I) -> [I; 2] {
    [both.low_half(), both.high_half()]
}

#[inline(always)]
fn four_of<I: Ints>([first, last]: [I; 2]) -> [I; 4] {
    [first.low_half(), first.high_half(), last.low_half(), last.high_half()]
}

impl Pairs for f32 {
    type Stored<L: Lanes> = L;

    #[inline(always)]
    fn to_lanes<L: Lanes>(stored: L) -> L {
        stored
    }
    #[inline(always)]
    fn pairs<L: Lanes, const N: usize>(samples: &[f32], at: L::Ints, away: &Away<N>) -> [[L; 2]; N] {
        each(
            #[inline(always)]
            |n| L::pairs_f32(samples, at + L::Ints::splat(away.distance(n))),
        )
    }
    #[inline(always)]
    fn rises<L: Lanes, const N: usize>(samples: &[f32], at: L::Ints, away: &Away<N>) -> [[L; 2]; N] {
        let pairs = Self::pairs::<L, N>(samples, at, away);
        each(
            #[inline(always)]
            |n| [pairs[n][0], pairs[n][1] - pairs[n][0]],
        )
    }
    #[inline(always)]
    fn quads<L: Lanes, const N: usize>(samples: &[f32], at: L::Ints, away: &Away<N>) -> [[L; 4]; N] {
        each(
            #[inline(always)]
            |n| L::quads_f32(samples, at + L::Ints::splat(away.distance(n))),
        )
    }
}

/// Distances in memory at which samples are read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Away<const N: usize> {
    least: i32,
    /// Of each, the distance from the least.
    beyond: [u32; N],
    /// The largest of these.
    reach: u32,
}

impl Away<1> {
    /// No distance.
    pub(crate) const HERE: Self = Away::new([0]);
}

impl<const N: usize> Away<N> {
    /// These distances.
    pub(crate) const fn new(distances: [i32; N]) -> Self {
        let (mut least, mut most, mut n) = (distances[0], distances[0], 1);
        while n < N {
            least = if distances[n] < least { distances[n] } else { least };
            most = if distances[n] > most { distances[n] } else { most };
            n += 1;
        }
        let mut beyond = [0; N];
        n = 0;
        while n < N {
            beyond[n] = distances[n].wrapping_sub(least) as u32;
            n += 1;
        }
        Away { least, beyond, reach: most.wrapping_sub(least) as u32 }
    }

    #[inline(always)]
    pub(super) fn distance(&self, n: usize) -> i32 {
        self.least.wrapping_add(self.beyond[n] as i32)
    }

    /// The least distance.
    #[inline(always)]
    pub(super) fn least(&self) -> i32 {
        self.least
    }

    /// The distances from the least one, at most [`Away::reach`].
    #[inline(always)]
    pub(super) fn beyond(&self, n: usize) -> usize {
        self.beyond[n] as usize
    }

    /// How far the largest distance is from the least one.
    #[inline(always)]
    pub(super) fn reach(&self) -> u32 {
        self.reach
    }
}

/// Where the lines along i lie in memory that values and central differences read: distances from a cell's lower corner.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stencil {
    /// The edges of the cell: `(j, k), (j + 1, k), (j, k + 1), (j + 1, k + 1)`.
    pub(crate) edges: Away<4>,
    lines: Away<4>,
    rows: Away<4>,
    slabs: Away<4>,
}

impl Stencil {
    /// Given the distances to the next line along j and along k; those that an i32 holds.
    pub(crate) const fn new(down: usize, back: usize) -> Self {
        let (down, back) = (down as i32, back as i32);
        let both = down.wrapping_add(back);
        let (two_down, two_back) = (down.wrapping_mul(2), back.wrapping_mul(2));
        Stencil {
            edges: Away::new([0, down, back, both]),
            lines: Away::new([-1, down.wrapping_sub(1), back.wrapping_sub(1), both.wrapping_sub(1)]),
            rows: Away::new([-down, back.wrapping_sub(down), two_down, back.wrapping_add(two_down)]),
            slabs: Away::new([-back, down.wrapping_sub(back), two_back, down.wrapping_add(two_back)]),
        }
    }
}

/// The samples that central differences at the corners of a cell read, as they are stored.
#[derive(Clone, Copy)]
pub(crate) struct Around<V: Pairs, L: Lanes> {
    /// Four samples of each line through the cell, the two in the middle those at its corners: `(j, k), (j + 1, k), (j, k + 1),
    /// (j + 1, k + 1)`.
    pub(crate) lines: [[V::Stored<L>; 4]; 4],
    /// The two in the middle of the lines beside them along j: `(j - 1, k), (j - 1, k + 1), (j + 2, k), (j + 2, k + 1)`.
    pub(crate) rows: [[V::Stored<L>; 2]; 4],
    /// Of those beside them along k: `(j, k - 1), (j + 1, k - 1), (j, k + 2), (j + 1, k + 2)`.
    pub(crate) slabs: [[V::Stored<L>; 2]; 4],
}
