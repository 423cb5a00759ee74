//! A transfer function of value and gradient magnitude.

use super::axis::Ends;
use super::{Axis, Classifier, Rgbs, rgbs};
use crate::math::{Real, each};
use crate::transfer::{Optics, Side, TransferFunction};
use crate::volume::Rescale;

/// A transfer function of value and gradient magnitude: per patch between neighbouring knots of both axes, a bilinear
/// function.
#[derive(Debug, Clone)]
pub struct TwoD<R> {
    values: Axis<R>,
    gradients: Axis<R>,
    /// Patch `(i, j)` at `i + j · values.intervals()`.
    patches: Vec<Bilinear<R>>,
    /// Summed-area table (Crow 1984): entry `(i, j)` counts the lit patches with both indices below.
    lit_below: Vec<u32>,
}

/// A bilinear function of stored value and gradient magnitude:
/// `low + by_value · dv + by_gradient · dg + by_both · dv · dg`, with `dv`, `dg` from the patch's lower corner.
#[derive(Debug, Clone, Copy)]
pub struct Bilinear<R> {
    /// At the lower corner, from inside.
    pub low: Rgbs<R>,
    /// Per stored unit.
    pub by_value: Rgbs<R>,
    /// Per HU/mm.
    pub by_gradient: Rgbs<R>,
    /// Per stored unit and HU/mm.
    pub by_both: Rgbs<R>,
}

impl<R: Real> Bilinear<R> {
    fn is_lit(&self) -> bool {
        [self.low, self.by_value, self.by_gradient, self.by_both].iter().flatten().any(|&x| x != R::ZERO)
    }
}

impl<R: Real> TwoD<R> {
    pub(super) fn bake(transfer_function: &TransferFunction, rescale: Rescale) -> Self {
        let (mut values, value_ends) = Axis::bake(&transfer_function.value_knots(), |v| rescale.stored(v));
        let (mut gradients, gradient_ends) = Axis::bake(&transfer_function.gradient_knots(), |g| g);
        let mut patches = Vec::with_capacity(values.intervals() * gradients.intervals());
        for g in &gradient_ends {
            for v in &value_ends {
                let at = |v, vs, g, gs| rgbs(transfer_function.evaluate_side(v, vs, g, gs));
                let c00 = at(v.low, v.low_side, g.low, g.low_side);
                let c10 = at(v.high, v.high_side, g.low, g.low_side);
                let c01 = at(v.low, v.low_side, g.high, g.high_side);
                let c11 = at(v.high, v.high_side, g.high, g.high_side);
                let (dv, dg) = (rescale.stored(v.high) - rescale.stored(v.low), g.high - g.low);
                let each = |f: &dyn Fn(usize) -> f64| each(|c| R::from_f64(f(c)));
                patches.push(Bilinear {
                    low: each(&|c| c00[c]),
                    by_value: each(&|c| (c10[c] - c00[c]) / dv),
                    by_gradient: each(&|c| (c01[c] - c00[c]) / dg),
                    by_both: each(&|c| ((c11[c] - c01[c]) - (c10[c] - c00[c])) / (dv * dg)),
                });
            }
        }
        let tf = transfer_function;
        let jumps = |k: usize, ends: &[Ends], at: &dyn Fn(f64, Side) -> Vec<Optics>| {
            0 < k && k < ends.len() && at(ends[k - 1].high, ends[k - 1].high_side) != at(ends[k].low, ends[k].low_side)
        };
        values.mark_steep(|k| {
            jumps(k, &value_ends, &|v, side| {
                let ends = gradient_ends.iter().flat_map(|g| [(g.low, g.low_side), (g.high, g.high_side)]);
                ends.map(|(g, g_side)| tf.evaluate_side(v, side, g, g_side)).collect()
            })
        });
        gradients.mark_steep(|k| {
            jumps(k, &gradient_ends, &|g, side| {
                let ends = value_ends.iter().flat_map(|v| [(v.low, v.low_side), (v.high, v.high_side)]);
                ends.map(|(v, v_side)| tf.evaluate_side(v, v_side, g, side)).collect()
            })
        });
        let (nv, ng) = (values.intervals(), gradients.intervals());
        let mut lit_below = vec![0; (nv + 1) * (ng + 1)];
        for j in 0..ng {
            for i in 0..nv {
                let lit = u32::from(patches[i + j * nv].is_lit());
                let at = |i: usize, j: usize| i + j * (nv + 1);
                lit_below[at(i + 1, j + 1)] =
                    lit_below[at(i, j + 1)] + lit_below[at(i + 1, j)] + lit - lit_below[at(i, j)];
            }
        }
        TwoD { values, gradients, patches, lit_below }
    }

    /// The knots along the value axis, in stored units.
    #[inline(always)]
    pub fn values(&self) -> &Axis<R> {
        &self.values
    }

    /// The knots along the gradient axis, in HU/mm.
    #[inline(always)]
    pub fn gradients(&self) -> &Axis<R> {
        &self.gradients
    }

    /// The function on a patch.
    #[inline(always)]
    pub fn patch(&self, value_interval: usize, gradient_interval: usize) -> &Bilinear<R> {
        &self.patches[value_interval + gradient_interval * self.values.intervals()]
    }

    /// True if nothing absorbs or emits in the patches `[first, last]` of either axis.
    #[inline(always)]
    pub fn are_empty(&self, value: [usize; 2], gradient: [usize; 2]) -> bool {
        let at = |i: usize, j: usize| self.lit_below[i + j * (self.values.intervals() + 1)];
        let ([v0, v1], [g0, g1]) = (value, gradient);
        at(v1 + 1, g1 + 1) + at(v0, g0) == at(v0, g1 + 1) + at(v1 + 1, g0)
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        self.values.bytes()
            + self.gradients.bytes()
            + size_of_val(self.patches.as_slice())
            + size_of_val(self.lit_below.as_slice())
    }
}

impl<R: Real> Classifier<R> for TwoD<R> {
    const READS_GRADIENT: bool = true;

    #[inline(always)]
    fn classify(&self, stored: R, gradient_per_mm: R) -> Rgbs<R> {
        let v = self.values.clamp(stored);
        let g = self.gradients.clamp(gradient_per_mm);
        let (i, j) = (self.values.interval(v), self.gradients.interval(g));
        let p = self.patch(i, j);
        let (dv, dg) = (v - self.values.knots()[i], g - self.gradients.knots()[j]);
        each(|c| {
            let across = p.by_value[c].mul_plus(dv, p.low[c]);
            p.by_both[c].mul_plus(dv, p.by_gradient[c]).mul_plus(dg, across)
        })
    }

    #[inline(always)]
    fn is_empty(&self, stored: [R; 2], gradient_per_mm: [R; 2]) -> bool {
        let value = stored.map(|x| self.values.interval(self.values.clamp(x)));
        let gradient = gradient_per_mm.map(|x| self.gradients.interval(self.gradients.clamp(x)));
        self.are_empty(value, gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::{Curve, Knot, Optics, Term, Weight};

    fn two_widgets() -> TransferFunction {
        let knot = |value, s, color| Knot { value, optics: Optics::colored(s, color) };
        let red = [1.0, 0.1, 0.0];
        let blue = [0.0, 0.2, 0.9];
        let a = Term {
            curve: Curve::new(vec![knot(-100.0, 0.0, red), knot(0.0, 2.0, red), knot(50.0, 0.0, red)]).unwrap(),
            weight: Some(Weight::new(vec![[20.0, 0.0], [100.0, 1.0], [300.0, 0.0]]).unwrap()),
        };
        let b = Term {
            curve: Curve::new(vec![knot(30.0, 0.0, blue), knot(30.0, 1.0, blue), knot(200.0, 0.0, blue)]).unwrap(),
            weight: Some(Weight::new(vec![[0.0, 1.0], [150.0, 0.0]]).unwrap()),
        };
        TransferFunction::new([-1024.0, 3071.0], 400.0, vec![a, b]).unwrap()
    }

    #[test]
    fn it_equals_the_definition() {
        let tf = two_widgets();
        let rescale = Rescale { slope: 0.5, intercept: -1024.0 };
        let baked = TwoD::<f64>::bake(&tf, rescale);
        for i in 0..400 {
            for j in 0..200 {
                let (v, g) = (f64::from(i) * 1.0137 - 150.0, f64::from(j) * 2.313);
                let [_, _, b, s] = baked.classify(rescale.stored(v), g);
                let truth = tf.evaluate(v, g);
                assert!(
                    (s - truth.extinction_per_mm).abs() < 1e-12 && (b - truth.emission_per_mm[2]).abs() < 1e-12,
                    "at ({v}, {g}): found {s}, expected {}",
                    truth.extinction_per_mm
                );
            }
        }
    }

    #[test]
    fn emptiness_is_of_the_closed_box() {
        let baked = TwoD::<f32>::bake(&two_widgets(), Rescale::IDENTITY);
        assert!(baked.is_empty([-90.0, 20.0], [0.0, 19.0]), "below the weight of the first widget");
        assert!(!baked.is_empty([-90.0, 20.0], [0.0, 21.0]));
        assert!(!baked.is_empty([-90.0, 40.0], [0.0, 10.0]), "the second widget");
        assert!(baked.is_empty([210.0, 3000.0], [0.0, 400.0]));
        assert!(baked.is_empty([-90.0, 20.0], [350.0, 9999.0]));
    }
}
