//! Knots along one axis, and the interval that a number falls into.

use crate::math::Real;
use crate::transfer::Side;

/// Ascending knots `x₀ < x₁ < … < x_n`: `n` intervals, the last one closed. Numbers outside belong to the end intervals,
/// clamped to the ends.
#[derive(Debug, Clone)]
pub struct Axis<R> {
    knots: Vec<R>,
    /// For each of `buckets` equal parts of the domain, the interval of its lower end.
    first_in_bucket: Vec<u32>,
    buckets_per_unit: R,
    /// Per knot, whether the function jumps there, or all but jumps.
    steep: Vec<bool>,
}

/// An interval no wider than this fraction of the axis is as good as a jump.
const NARROW: f64 = 1e-5;

/// An interval of an axis before baking, with the ends in the units of the transfer function and the side from which each
/// is approached.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    pub(super) low: f64,
    pub(super) low_side: Side,
    pub(super) high: f64,
    pub(super) high_side: Side,
}

impl<R: Real> Axis<R> {
    /// An axis with the given knots, mapped by `map` (affine, possibly falling) to the axis' own units; intervals whose
    /// ends round to the same number vanish. Returns the axis and the ends of the intervals that remain.
    pub(super) fn bake(knots: &[f64], map: impl Fn(f64) -> f64) -> (Self, Vec<Ends>) {
        let falling = map(knots[0]) > map(knots[knots.len() - 1]);
        let mut ordered: Vec<f64> = knots.to_vec();
        if falling {
            ordered.reverse();
        }
        let mut positions = vec![R::from_f64(map(ordered[0]))];
        let mut ends = Vec::new();
        for pair in ordered.windows(2) {
            let high = R::from_f64(map(pair[1]));
            if high > positions[positions.len() - 1] {
                positions.push(high);
                let (low_side, high_side) = if falling { (Side::Left, Side::Right) } else { (Side::Right, Side::Left) };
                ends.push(Ends { low: pair[0], low_side, high: pair[1], high_side });
            }
        }
        assert!(!ends.is_empty(), "the domain {knots:?} is empty at this precision");
        let span = positions[positions.len() - 1] - positions[0];
        // Several buckets per knot: a look-up then rarely moves more than one interval on.
        let buckets = (8 * positions.len()).next_power_of_two().clamp(64, 1 << 16);
        let buckets_per_unit = R::from_f64(buckets as f64) / span;
        let steep = vec![false; positions.len()];
        let mut axis = Axis { knots: positions, first_in_bucket: Vec::new(), buckets_per_unit, steep };
        axis.first_in_bucket = (0..buckets)
            .map(|b| {
                // One bucket lower than its nominal end, since the look-up's product may round up.
                let low = axis.knots[0] + R::from_f64(b as f64 - 1.0) / buckets_per_unit;
                axis.knots.partition_point(|&k| k <= low).saturating_sub(1).min(axis.intervals() - 1) as u32
            })
            .collect();
        (axis, ends)
    }

    /// Marks the knots at which the function jumps by `jumps(knot)`, or that bound a very narrow interval.
    pub(super) fn mark_steep(&mut self, jumps: impl Fn(usize) -> bool) {
        let n = self.knots.len();
        let narrow = R::from_f64(NARROW) * (self.knots[n - 1] - self.knots[0]);
        let is_narrow = |i: usize| i + 1 < n && self.knots[i + 1] - self.knots[i] <= narrow;
        self.steep = (0..n).map(|i| jumps(i) || is_narrow(i) || (i > 0 && is_narrow(i - 1))).collect();
    }

    /// Whether the function jumps at a knot, or all but jumps: where it does, a rounding error of the argument matters.
    #[inline(always)]
    pub fn is_steep(&self, knot: usize) -> bool {
        self.steep[knot]
    }

    /// Width of the narrowest interval over the largest magnitude of a knot.
    pub fn narrowest(&self) -> f64 {
        let largest = self.knots.iter().map(|k| k.to_f64().abs()).fold(0.0, f64::max);
        let widths = self.knots.windows(2).map(|pair| (pair[1] - pair[0]).to_f64());
        widths.fold(f64::INFINITY, f64::min) / largest
    }

    /// Number of intervals.
    #[inline(always)]
    pub fn intervals(&self) -> usize {
        self.knots.len() - 1
    }

    /// The knots, ascending.
    #[inline(always)]
    pub fn knots(&self) -> &[R] {
        &self.knots
    }

    /// `x` moved into the domain.
    #[inline(always)]
    pub fn clamp(&self, x: R) -> R {
        x.max(self.knots[0]).min(self.knots[self.knots.len() - 1])
    }

    /// The interval of a number inside the domain: the last `i` with `x_i ≤ x`, but at most the last interval.
    #[inline(always)]
    pub fn interval(&self, x: R) -> usize {
        let bucket = ((x - self.knots[0]) * self.buckets_per_unit).to_f64() as usize;
        let mut i = self.first_in_bucket[bucket.min(self.first_in_bucket.len() - 1)] as usize;
        while i + 2 < self.knots.len() && self.knots[i + 1] <= x {
            i += 1;
        }
        i
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        size_of_val(self.knots.as_slice())
            + size_of_val(self.first_in_bucket.as_slice())
            + size_of_val(self.steep.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_falls_into_its_interval() {
        let knots = [-1024.0, -1023.99, 0.0, 0.5, 100.0, 3071.0];
        let (axis, ends) = Axis::<f32>::bake(&knots, |x| x);
        assert_eq!(ends.len(), 5);
        for i in 0..200_000 {
            let x = -1024.0 + 4095.0 * i as f32 / 200_000.0;
            let expected = axis.knots().partition_point(|&k| k <= x).saturating_sub(1).min(axis.intervals() - 1);
            assert_eq!(axis.interval(x), expected, "at {x}");
        }
        assert_eq!(axis.interval(3071.0), 4, "the last interval is closed");
    }

    #[test]
    fn a_falling_map_reverses_the_axis() {
        let (axis, ends) = Axis::<f64>::bake(&[0.0, 10.0, 40.0], |x| 100.0 - 2.0 * x);
        assert_eq!(axis.knots(), [20.0, 80.0, 100.0]);
        assert_eq!((ends[0].low, ends[0].high), (40.0, 10.0));
        assert_eq!(ends[0].low_side, Side::Left, "stored numbers above the knot are values below it");
    }

    #[test]
    fn intervals_without_width_vanish() {
        let (axis, ends) = Axis::<f32>::bake(&[0.0, 1.0, 1.0 + 1e-12, 2.0], |x| x);
        assert_eq!(axis.intervals(), 2);
        assert_eq!((ends[1].low, ends[1].high), (1.0 + 1e-12, 2.0));
    }
}
