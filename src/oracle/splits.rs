//! Where the passage of a ray through a cell must be cut so that every piece is smooth.

use super::bernstein::Cubic;
use super::patches::Axis;
use super::roots::{critical_points, crossing};

/// Cuts of a passage, its ends 0 and 1 among them.
#[derive(Debug, Clone, Default)]
pub(super) struct Splits {
    at: Vec<f64>,
}

impl Splits {
    /// A passage without cuts.
    pub(super) fn restart(&mut self) {
        self.at.clear();
        self.at.extend([0.0, 1.0]);
    }

    /// Cuts at these points.
    pub(super) fn add(&mut self, points: &[f64]) {
        self.at.extend_from_slice(points);
    }

    /// Cuts where the field turns, and where it crosses a knot of the transfer function.
    ///
    /// The turns are cuts themselves, so a knot that the field only touches needs no root finding.
    pub(super) fn add_knots(&mut self, field: &Cubic, axis: &Axis) {
        let knots = axis.knots();
        let (low, high) = field.0.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &c| (l.min(c), h.max(c)));
        if axis.interval(low) == axis.interval(high) {
            // The field lies in the hull of its coefficients, and no knot does.
            return;
        }
        let turns = critical_points(&field.0);
        self.add(turns.as_slice());
        for [from, to] in turns.stretches() {
            let (a, b) = (field.at(from), field.at(to));
            let first = knots.partition_point(|&k| k <= a.min(b));
            let ahead = &knots[first..];
            for &knot in ahead.iter().take_while(|&&k| k < a.max(b)) {
                self.at.extend(crossing(|t| field.at(t) - knot, from, to));
            }
        }
    }

    /// The pieces `[from, to]` between neighbouring cuts, ascending.
    pub(super) fn pieces(&mut self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.at.sort_unstable_by(f64::total_cmp);
        self.at.dedup();
        self.at.windows(2).map(|w| [w[0], w[1]])
    }
}
