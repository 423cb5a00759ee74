//! Where a segment is cut: at the knots of the transfer function, so that each piece has one polynomial.

use crate::classify::Axis;
use crate::math::Real;
use crate::math::bernstein::{Cubic, critical_points, crossing, range, slope, value};

/// Positions in `[0, 1]` at which a segment is cut, sorted on demand.
#[derive(Debug, Default)]
pub(super) struct Splits<R> {
    positions: Vec<R>,
    /// Whether a cut was made, or not made, that rounding might have misplaced by a length that matters.
    pub(super) ill_conditioned: bool,
    /// The optical depth per unit of the segment's parameter that one part in one of a misplaced cut may cost, over what a
    /// cut may cost.
    harm: R,
}

/// Roundings that a value of a cubic may have suffered.
const ROUNDINGS: f64 = 8.0;

impl<R: Real> Splits<R> {
    /// Only the ends 0 and 1. A cut across a jump that is misplaced by `u` does `harm · u` of what may be tolerated.
    pub(super) fn restart(&mut self, harm: R) {
        self.positions.clear();
        self.positions.push(R::ZERO);
        self.positions.push(R::ONE);
        self.harm = harm;
    }

    /// Adds a place.
    pub(super) fn add(&mut self, position: R) {
        self.positions.push(position);
    }

    /// Adds the places where a cubic takes one of the levels of an axis, as [`Splits::cut_at`], and notes where rounding
    /// might matter: near a jump, a cubic that is nearly flat crosses at an uncertain place, or not at all.
    #[inline]
    pub(super) fn cut(&mut self, cubic: &Cubic<R>, axis: &Axis<R>) {
        let [low, high] = range(cubic);
        let rounding = R::from_f64(ROUNDINGS) * R::EPSILON * low.abs().max(high.abs());
        let knots = axis.knots();
        let first = knots.partition_point(|&x| x < low - rounding);
        let last = knots.partition_point(|&x| x <= high + rounding);
        if first == last {
            return;
        }
        let cuts_before = self.positions.len();
        self.cut_at(cubic, &knots[first..last]);
        let (critical, count) = critical_points(cubic);
        // Where a level is only touched there is a piece on either side, whose middle says on which side of it they are.
        let touching = critical.into_iter().take(count).filter(|&u| {
            let touched = value(cubic, u);
            knots[first..last].iter().any(|&x| (touched - x).abs() <= rounding)
        });
        self.positions.extend(touching);
        for knot in (first..last).filter(|&k| axis.is_steep(k)) {
            let near = |u: R| (value(cubic, u) - knots[knot]).abs() <= rounding;
            let touches = critical.into_iter().take(count).any(near);
            let grazes =
                self.positions[cuts_before..].iter().any(|&u| near(u) && slope(cubic, u).abs() < self.harm * rounding);
            // A plateau is not touched but exactly on the level, or off it.
            self.ill_conditioned |= (touches || grazes) && high > low;
        }
    }

    /// Adds the places where a cubic takes one of the ascending `levels`. The cubic's critical points are found first, and
    /// between them it is monotone, so that no pair of crossings is missed, however close.
    pub(super) fn cut_at(&mut self, cubic: &Cubic<R>, levels: &[R]) {
        let (critical, count) = critical_points(cubic);
        let mut from = R::ZERO;
        for to in critical.into_iter().take(count).chain([R::ONE]) {
            let (a, b) = (value(cubic, from), value(cubic, to));
            let (bottom, top) = (a.min(b), a.max(b));
            for &level in levels.iter().filter(|&&x| bottom < x && x < top) {
                self.positions.push(crossing(cubic, level, from, to));
            }
            from = to;
        }
    }

    /// The positions, ascending, from 0 to 1.
    pub(super) fn sorted(&mut self) -> &[R] {
        self.positions.sort_by(|a, b| a.partial_cmp(b).expect("positions are never NaN"));
        &self.positions
    }

    /// Number of positions.
    pub(super) fn len(&self) -> usize {
        self.positions.len()
    }

    /// Position by index; sorted before.
    pub(super) fn get(&self, index: usize) -> R {
        self.positions[index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_cut_at_every_crossing() {
        let mut splits = Splits::<f64>::default();
        splits.restart(1.0);
        // Up to about 4.6 and down again, twice across 3 and 4; levels at the ends do not cut.
        let cubic = [0.0, 9.0, 5.0, 0.0];
        splits.cut_at(&cubic, &[-1.0, 0.0, 3.0, 4.0, 90.0]);
        let positions = splits.sorted();
        assert_eq!(positions.len(), 6, "{positions:?}");
        for &u in &positions[1..5] {
            let v = value(&cubic, u);
            assert!((v - 3.0).abs() < 1e-12 || (v - 4.0).abs() < 1e-12, "cut at {u}, where the value is {v}");
        }
    }
}
