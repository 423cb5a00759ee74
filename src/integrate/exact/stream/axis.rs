//! The knots of a transfer function along one axis, for lanes.

use super::levels::precision;
use crate::classify;
use crate::simd::{Ints, Lanes, Table};

/// Beyond all numbers that samples or gradients have, and small enough not to overflow when subtracted.
const FAR: f32 = 1e37;

/// More knots than this are looked up by bisection.
const FEW: usize = 16;

/// The `n + 1` knots of an axis cut the line into `n + 2` intervals: number 0 lies below the first knot, number `n + 1` from the
/// last one on.
#[derive(Debug, Clone)]
pub(in crate::integrate::exact) struct Axis {
    knots: Vec<f32>,
    /// Lower ends of the intervals; that of the first is far below.
    ends: Table,
    /// Where each interval's function is anchored: its lower knot, or the first knot.
    anchors: Table,
    /// 1 where the function jumps, or all but jumps, at an interval's lower end.
    steep: Option<Table>,
    /// How long the last step of the search for where a knot is crossed may be.
    precision: f32,
}

impl Axis {
    /// For pictures within a tolerance.
    pub(super) fn new(axis: &classify::Axis<f32>, tolerance: f64) -> Self {
        let knots = axis.knots().to_vec();
        let ends: Vec<f32> = [&[-FAR], knots.as_slice(), &[FAR]].concat();
        let anchors: Vec<f32> = [&knots[..1], knots.as_slice()].concat();
        let is_steep = |end: usize| 0 < end && end <= knots.len() && axis.is_steep(end - 1);
        let steep: Vec<f32> = (0..ends.len()).map(|end| f32::from(u8::from(is_steep(end)))).collect();
        let jumps = steep.contains(&1.0);
        Axis {
            ends: Table::new(&ends),
            anchors: Table::new(&anchors),
            steep: jumps.then(|| Table::new(&steep)),
            precision: precision(jumps, tolerance),
            knots,
        }
    }

    /// An axis with one knot, at which nothing jumps.
    pub(super) fn at(knot: f32) -> Self {
        Axis {
            knots: vec![knot],
            ends: Table::new(&[-FAR, knot, FAR]),
            anchors: Table::new(&[knot, knot]),
            steep: None,
            precision: 1.0 / 128.0,
        }
    }

    /// The lower end of an interval; asked for one more, the upper end of the last.
    pub(super) fn lower_end(&self, interval: usize) -> f32 {
        match interval {
            0 => -FAR,
            i => self.knots.get(i - 1).copied().unwrap_or(FAR),
        }
    }

    /// Where an interval's function is anchored.
    pub(super) fn anchor_of(&self, interval: usize) -> f32 {
        self.knots[interval.saturating_sub(1)]
    }

    /// Number of intervals, those beyond the ends included.
    pub(super) fn intervals(&self) -> usize {
        self.knots.len() + 1
    }

    /// The interval of each number; a knot belongs to the interval above it.
    #[inline(always)]
    pub(super) fn interval<L: Lanes>(&self, x: L) -> L::Ints {
        let [interval] = self.count(
            #[inline(always)]
            |knot: L| [knot.le(x)],
        );
        interval
    }

    /// The intervals of both ends of ranges.
    #[inline(always)]
    pub(super) fn intervals_of<L: Lanes>(&self, [low, high]: [L; 2]) -> [L::Ints; 2] {
        self.count(
            #[inline(always)]
            |knot: L| [knot.le(low), knot.le(high)],
        )
    }

    /// The interval of each number; a knot belongs to the interval below it.
    #[inline(always)]
    pub(super) fn interval_below<L: Lanes>(&self, x: L) -> L::Ints {
        let [interval] = self.count(
            #[inline(always)]
            |knot: L| [knot.lt(x)],
        );
        interval
    }

    /// How many knots lie below each of some numbers, where those that do come first.
    #[inline(always)]
    fn count<L: Lanes, const N: usize>(&self, are_below: impl Fn(L) -> [L::Mask; N]) -> [L::Ints; N] {
        let mut counts = [L::Ints::splat(0); N];
        if self.knots.len() <= FEW {
            for &knot in &self.knots {
                let below = are_below(L::splat(knot));
                for n in 0..N {
                    counts[n] = L::Ints::select(below[n], counts[n] + L::Ints::splat(1), counts[n]);
                }
            }
            return counts;
        }
        // Bisection among the ends, of which the first is always below and those after the last never are.
        let mut width = (self.knots.len() + 1).next_power_of_two() / 2;
        while width > 0 {
            for n in 0..N {
                let tried = counts[n] + L::Ints::splat(width as i32);
                counts[n] = L::Ints::select(are_below(L::pick(&self.ends, tried))[n], tried, counts[n]);
            }
            width /= 2;
        }
        counts
    }

    /// The lower end of each interval; asked for one more, the upper end.
    #[inline(always)]
    pub(super) fn end<L: Lanes>(&self, interval: L::Ints) -> L {
        L::pick(&self.ends, interval)
    }

    /// Where each interval's function is anchored.
    #[inline(always)]
    pub(super) fn anchor<L: Lanes>(&self, interval: L::Ints) -> L {
        L::pick(&self.anchors, interval)
    }

    /// How long the last step of the search for where a knot is crossed may be.
    #[inline(always)]
    pub(super) fn precision(&self) -> f32 {
        self.precision
    }

    /// Which ends are steep; `None` if there are none.
    #[inline(always)]
    pub(super) fn steep(&self) -> Option<&Table> {
        self.steep.as_ref()
    }
}
