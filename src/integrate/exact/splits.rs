//! Where a segment is cut: at the knots of the transfer function, so that each piece has one polynomial.

use crate::math::Real;
use crate::math::bernstein::{Cubic, critical_points, crossing, range, value};

/// Positions in `[0, 1]` at which a segment is cut, sorted on demand.
#[derive(Debug, Default)]
pub(super) struct Splits<R> {
    positions: Vec<R>,
}

impl<R: Real> Splits<R> {
    /// Only the ends 0 and 1.
    pub(super) fn clear(&mut self) {
        self.positions.clear();
        self.positions.push(R::ZERO);
        self.positions.push(R::ONE);
    }

    /// Adds the places where a cubic takes one of the ascending `levels`. The cubic's critical points are found first, and
    /// between them it is monotone, so that no pair of crossings is missed, however close.
    pub(super) fn cut(&mut self, cubic: &Cubic<R>, levels: &[R]) {
        let [low, high] = range(cubic);
        let first = levels.partition_point(|&x| x <= low);
        let levels = &levels[first..levels.partition_point(|&x| x < high)];
        if levels.is_empty() {
            return;
        }
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
        splits.clear();
        // Up to about 4.6 and down again, twice across 3 and 4; levels at the ends do not cut.
        let cubic = [0.0, 9.0, 5.0, 0.0];
        splits.cut(&cubic, &[-1.0, 0.0, 3.0, 4.0, 90.0]);
        let positions = splits.sorted();
        assert_eq!(positions.len(), 6, "{positions:?}");
        for &u in &positions[1..5] {
            let v = value(&cubic, u);
            assert!((v - 3.0).abs() < 1e-12 || (v - 4.0).abs() < 1e-12, "cut at {u}, where the value is {v}");
        }
    }
}
