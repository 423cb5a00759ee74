//! A transfer function of the value alone.

use super::{Axis, Classifier, Rgbs, rgbs};
use crate::math::{Real, each};
use crate::transfer::{Side, TransferFunction};
use crate::volume::Rescale;

/// A transfer function of the value alone: per interval of the value axis, a linear function.
#[derive(Debug, Clone)]
pub struct OneD<R> {
    axis: Axis<R>,
    pieces: Vec<Linear<R>>,
    /// `lit_before[i]` is the number of intervals below `i` in which something absorbs or emits.
    lit_before: Vec<u32>,
    /// Values below the first one, and those from the second one on, neither absorb nor emit.
    lit: [R; 2],
}

/// A linear function of the stored value: `low + slope · (x − x_i)`, component by component.
#[derive(Debug, Clone, Copy)]
pub struct Linear<R> {
    /// At the lower knot `x_i` of the interval, from inside.
    pub low: Rgbs<R>,
    /// Per stored unit.
    pub slope: Rgbs<R>,
}

impl<R: Real> OneD<R> {
    pub(super) fn bake(transfer_function: &TransferFunction, rescale: Rescale) -> Self {
        let (mut axis, ends) = Axis::bake(&transfer_function.value_knots(), |v| rescale.stored(v));
        let pieces: Vec<Linear<R>> = ends
            .iter()
            .map(|e| {
                let at = |v, side| rgbs(transfer_function.evaluate_side(v, side, 0.0, Side::Right));
                let (low, high) = (at(e.low, e.low_side), at(e.high, e.high_side));
                let width = rescale.stored(e.high) - rescale.stored(e.low);
                Linear { low: low.map(R::from_f64), slope: each(|c| R::from_f64((high[c] - low[c]) / width)) }
            })
            .collect();
        axis.mark_steep(|k| {
            0 < k && k < ends.len() && {
                let (below, above) = (ends[k - 1], ends[k]);
                let at = |v, side| transfer_function.evaluate_side(v, side, 0.0, Side::Right);
                at(below.high, below.high_side) != at(above.low, above.low_side)
            }
        });
        let mut lit_before = vec![0];
        for piece in &pieces {
            let lit = piece.low.iter().chain(&piece.slope).any(|&x| x != R::ZERO);
            lit_before.push(lit_before[lit_before.len() - 1] + u32::from(lit));
        }
        // Beyond the ends of the axis the function is that of its ends.
        let far = R::from_f64(f64::INFINITY);
        let is_lit = |i: &usize| lit_before[i + 1] > lit_before[*i];
        let ends = (0..pieces.len()).find(is_lit).zip((0..pieces.len()).rfind(is_lit));
        let lit = ends.map_or([far, -far], |(first, last)| {
            let low = if first == 0 { -far } else { axis.knots()[first] };
            [low, if last + 1 == pieces.len() { far } else { axis.knots()[last + 1] }]
        });
        OneD { axis, pieces, lit_before, lit }
    }

    /// The knots along the value axis, in stored units.
    #[inline(always)]
    pub fn axis(&self) -> &Axis<R> {
        &self.axis
    }

    /// The function on an interval of the axis.
    #[inline(always)]
    pub fn piece(&self, interval: usize) -> &Linear<R> {
        &self.pieces[interval]
    }

    /// True if nothing absorbs or emits in the intervals from `first` to `last`.
    #[inline(always)]
    pub fn are_empty(&self, first: usize, last: usize) -> bool {
        self.lit_before[last + 1] == self.lit_before[first]
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        self.axis.bytes() + size_of_val(self.pieces.as_slice()) + size_of_val(self.lit_before.as_slice())
    }
}

impl<R: Real> Classifier<R> for OneD<R> {
    const READS_GRADIENT: bool = false;

    #[inline(always)]
    fn classify(&self, stored: R, _gradient_per_mm: R) -> Rgbs<R> {
        let x = self.axis.clamp(stored);
        let i = self.axis.interval(x);
        let Linear { low, slope } = self.pieces[i];
        let dx = x - self.axis.knots()[i];
        each(|c| slope[c].mul_plus(dx, low[c]))
    }

    #[inline(always)]
    fn is_empty(&self, stored: [R; 2], _gradient_per_mm: [R; 2]) -> bool {
        // Most ranges that are asked about: no need to look for their intervals.
        if stored[1] < self.lit[0] || self.lit[1] <= stored[0] {
            return true;
        }
        let [first, last] = stored.map(|x| self.axis.interval(self.axis.clamp(x)));
        self.are_empty(first, last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::{Curve, Knot, Optics, Term};

    fn tent_with_jump() -> TransferFunction {
        let knot = |value, s| Knot { value, optics: Optics::colored(s, [0.25, 0.5, 1.0]) };
        let tent = Curve::new(vec![knot(-100.0, 0.0), knot(0.0, 2.0), knot(50.0, 0.0)]).unwrap();
        let step = Curve::new(vec![knot(500.0, 0.0), knot(500.0, 1.5)]).unwrap();
        let terms = vec![Term { curve: tent, weight: None }, Term { curve: step, weight: None }];
        TransferFunction::new([-1024.0, 3071.0], 1000.0, terms).unwrap()
    }

    #[test]
    fn it_equals_the_definition_for_any_rescale() {
        let tf = tent_with_jump();
        for rescale in [
            Rescale::IDENTITY,
            Rescale { slope: 1.0, intercept: -1024.0 },
            Rescale { slope: 0.5, intercept: -3.0 },
            Rescale { slope: -1.0, intercept: 0.0 },
        ] {
            let baked = OneD::<f64>::bake(&tf, rescale);
            for i in -30_000..30_000 {
                // Never on a knot with a jump, where a falling rescale takes the other side.
                let v = f64::from(i) * 0.13 + 0.017;
                let [r, _, _, s] = baked.classify(rescale.stored(v), 0.0);
                let truth = tf.evaluate(v, 0.0);
                assert!(
                    (s - truth.extinction_per_mm).abs() < 1e-12 && (r - truth.emission_per_mm[0]).abs() < 1e-12,
                    "at {v} with {rescale:?}: found {s}, expected {}",
                    truth.extinction_per_mm
                );
            }
        }
    }

    #[test]
    fn emptiness_is_of_the_closed_range() {
        let baked = OneD::<f32>::bake(&tent_with_jump(), Rescale::IDENTITY);
        assert!(baked.is_empty([60.0, 499.0], [0.0, 0.0]));
        assert!(baked.is_empty([-2000.0, -101.0], [0.0, 0.0]));
        assert!(!baked.is_empty([60.0, 500.0], [0.0, 0.0]), "the jump's upper side is lit");
        assert!(!baked.is_empty([-5.0, -4.0], [0.0, 0.0]));
        assert!(!baked.is_empty([4000.0, 5000.0], [0.0, 0.0]), "beyond the window as at its end");
    }
}
