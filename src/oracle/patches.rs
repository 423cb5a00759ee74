//! The transfer function cut into patches on which extinction and emission are bilinear.

use crate::transfer::{Side, TransferFunction};

/// σ and q: extinction, then emission in red, green and blue, all 1/mm.
pub(super) type Channels = [f64; 4];

/// σ and q at the corners of a patch: `[value end][gradient end]`.
pub(super) type Corners = [[Channels; 2]; 2];

/// Ascending knots of one axis and the intervals between them; before the first and after the last knot lie two more,
/// on which the function is constant.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    knots: Vec<f64>,
}

impl Axis {
    /// The knots.
    pub(super) fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The interval that holds `x`; at a knot the one to its right.
    pub(super) fn interval(&self, x: f64) -> usize {
        self.knots.partition_point(|k| *k <= x)
    }

    /// Position of `x` in an interval: 0 to 1 from its low to its high end.
    pub(super) fn fraction(&self, interval: usize, x: f64) -> f64 {
        if interval == 0 || interval == self.knots.len() {
            return 0.0;
        }
        let (low, high) = (self.knots[interval - 1], self.knots[interval]);
        (x - low) / (high - low)
    }

    fn intervals(&self) -> usize {
        self.knots.len() + 1
    }

    /// Low and high end of an interval, and the sides from which it is approached from within the interval.
    fn ends(&self, interval: usize) -> [(f64, Side); 2] {
        let last = self.knots.len() - 1;
        match interval {
            0 => [(self.knots[0], Side::Right); 2],
            i if i > last => [(self.knots[last], Side::Left); 2],
            i => [(self.knots[i - 1], Side::Right), (self.knots[i], Side::Left)],
        }
    }
}

/// A transfer function as bilinear patches.
#[derive(Debug, Clone)]
pub(super) struct Patches {
    /// Knots along the value.
    pub(super) value: Axis,
    /// Knots along the gradient magnitude; `None` for a 1D function.
    pub(super) gradient: Option<Axis>,
    corners: Vec<Corners>,
    /// Number of value intervals before each that show anything.
    shown_before: Vec<usize>,
}

impl Patches {
    /// All patches of a transfer function.
    pub(super) fn new(transfer_function: &TransferFunction) -> Self {
        let value = Axis { knots: transfer_function.value_knots() };
        let gradient = transfer_function.reads_gradient().then(|| Axis { knots: transfer_function.gradient_knots() });
        let columns = gradient.as_ref().map_or(1, Axis::intervals);
        let mut corners = Vec::with_capacity(value.intervals() * columns);
        let mut shown_before = vec![0];
        for i in 0..value.intervals() {
            let row = corners.len();
            for j in 0..columns {
                let across = gradient.as_ref().map_or([(0.0, Side::Right); 2], |axis| axis.ends(j));
                corners.push(value.ends(i).map(|(v, v_side)| {
                    across.map(|(g, g_side)| {
                        let optics = transfer_function.evaluate_side(v, v_side, g, g_side);
                        let [r, g, b] = optics.emission_per_mm;
                        [optics.extinction_per_mm, r, g, b]
                    })
                }));
            }
            let shown = corners[row..].iter().any(shows);
            shown_before.push(shown_before[i] + usize::from(shown));
        }
        Patches { value, gradient, corners, shown_before }
    }

    /// True if no value in `[low, high]` shows anything, whatever the gradient.
    pub(super) fn nothing_in(&self, low: f64, high: f64) -> bool {
        let (first, last) = (self.value.interval(low), self.value.interval(high));
        self.shown_before[first] == self.shown_before[last + 1]
    }

    /// The corners of a patch, or `None` if it shows nothing. The gradient interval is 0 for a 1D function.
    pub(super) fn corners(&self, value_interval: usize, gradient_interval: usize) -> Option<&Corners> {
        let columns = self.gradient.as_ref().map_or(1, Axis::intervals);
        Some(&self.corners[value_interval * columns + gradient_interval]).filter(|c| shows(c))
    }
}

fn shows(corners: &Corners) -> bool {
    corners.as_flattened().as_flattened().iter().any(|&x| x != 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::{Curve, Knot, Optics, Term, Weight};

    fn jumping() -> TransferFunction {
        let knots = [(0.0, 0.0), (10.0, 1.0), (10.0, 3.0), (20.0, 0.0)]
            .map(|(value, s)| Knot { value, optics: Optics::colored(s, [1.0, 0.5, 0.0]) });
        let curve = Curve::new(knots.to_vec()).unwrap();
        let weight = Some(Weight::new(vec![[0.0, 1.0], [5.0, 2.0]]).unwrap());
        TransferFunction::new([-10.0, 30.0], 8.0, vec![Term { curve, weight }]).unwrap()
    }

    #[test]
    fn patches_interpolate_to_the_function_itself() {
        let tf = jumping();
        let patches = Patches::new(&tf);
        let axis = patches.gradient.as_ref().unwrap();
        for v in [-20.0, -10.0, -1.0, 0.0, 3.0, 9.999, 10.0, 15.0, 20.0, 29.0, 30.0, 31.0] {
            for g in [0.0, 2.5, 5.0, 7.0, 8.0, 100.0] {
                let (i, j) = (patches.value.interval(v), axis.interval(g));
                let (a, b) = (patches.value.fraction(i, v), axis.fraction(j, g));
                let found = patches.corners(i, j).map_or(0.0, |c| {
                    let along = |e: usize| (1.0 - a) * c[0][e][0] + a * c[1][e][0];
                    (1.0 - b) * along(0) + b * along(1)
                });
                let expected = tf.evaluate(v, g).extinction_per_mm;
                assert!((found - expected).abs() < 1e-14, "at ({v}, {g}): found {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn nothing_is_where_the_function_vanishes() {
        let patches = Patches::new(&jumping());
        assert!(patches.nothing_in(-500.0, -1.0));
        assert!(patches.nothing_in(20.0, 400.0));
        assert!(!patches.nothing_in(-500.0, 0.1));
        assert!(!patches.nothing_in(19.0, 21.0));
    }
}
