//! A transfer function along a segment: which pieces there are, and the polynomials on each.

use crate::classify::{Axis, Bilinear, Classifier, Linear, OneD, TwoD};
use crate::math::bernstein::{Cubic, elevate, product, range, restrict};
use crate::math::{Real, each};

use super::cells::Segment;
use super::lattice::{along, magnitudes};
use super::piece::{Integral, Optics};
use super::shade::Shader;
use super::splits::Splits;

/// What absorbs and emits along a ray, by a baked transfer function.
pub(super) trait Medium<R: Real>: Sync {
    /// The scalar fields along a segment: cubics.
    type Fields;

    /// The fields along a segment, or `None` if nothing absorbs or emits there. `gradients` gives those at the corners.
    fn fields(&self, stored: &[R; 8], segment: &Segment, gradients: impl Fn() -> [[R; 8]; 3]) -> Option<Self::Fields>;

    /// Cuts the segment where a field crosses a knot.
    fn cut(&self, fields: &Self::Fields, splits: &mut Splits<R>);

    /// The integral over the part `[from, to]` of the segment, which lies between neighbouring cuts; `None` if nothing
    /// absorbs or emits there.
    fn integrate<S: Shader<R>>(
        &self,
        fields: &Self::Fields,
        part: [R; 2],
        length_mm: R,
        shader: &S,
        shading: &S::Cell,
    ) -> Option<Integral<R>>;
}

impl<R: Real> Medium<R> for OneD<R> {
    type Fields = Cubic<R>;

    #[inline(always)]
    fn fields(&self, stored: &[R; 8], segment: &Segment, _: impl Fn() -> [[R; 8]; 3]) -> Option<Cubic<R>> {
        let dark = |r: [R; 2]| self.is_empty(r, [R::ZERO; 2]);
        if dark(range(stored)) {
            return None;
        }
        let value = along(stored, segment);
        (!dark(range(&value))).then_some(value)
    }

    #[inline(always)]
    fn cut(&self, value: &Cubic<R>, splits: &mut Splits<R>) {
        splits.cut(value, self.axis());
    }

    #[inline(always)]
    fn integrate<S: Shader<R>>(
        &self,
        value: &Cubic<R>,
        [from, to]: [R; 2],
        length_mm: R,
        shader: &S,
        shading: &S::Cell,
    ) -> Option<Integral<R>> {
        let (i, dv) = within_interval(self.axis(), &restrict(value, from, to));
        if self.are_empty(i, i) {
            return None;
        }
        let Linear { low, slope } = self.piece(i);
        let channel = |c: usize| dv.map(|d| slope[c].mul_plus(d, low[c]));
        let optics = Optics { emission: [channel(0), channel(1), channel(2)], extinction: channel(3) };
        Some(if S::LIT {
            optics.integrate_shaded::<5>(length_mm, &shader.factors(shading, from, to), shader.largest_color())
        } else {
            optics.integrate(length_mm)
        })
    }
}

impl<R: Real> Medium<R> for TwoD<R> {
    /// Value and gradient magnitude.
    type Fields = [Cubic<R>; 2];

    #[inline(always)]
    fn fields(&self, stored: &[R; 8], segment: &Segment, gradients: impl Fn() -> [[R; 8]; 3]) -> Option<[Cubic<R>; 2]> {
        let everything = [R::ZERO, self.gradients().knots()[self.gradients().intervals()]];
        if self.is_empty(range(stored), everything) {
            return None;
        }
        let value = along(stored, segment);
        let magnitude = along(&magnitudes(&gradients()), segment);
        (!self.is_empty(range(&value), range(&magnitude))).then_some([value, magnitude])
    }

    #[inline(always)]
    fn cut(&self, [value, magnitude]: &[Cubic<R>; 2], splits: &mut Splits<R>) {
        splits.cut(value, self.values());
        splits.cut(magnitude, self.gradients());
    }

    #[inline(always)]
    fn integrate<S: Shader<R>>(
        &self,
        [value, magnitude]: &[Cubic<R>; 2],
        [from, to]: [R; 2],
        length_mm: R,
        shader: &S,
        shading: &S::Cell,
    ) -> Option<Integral<R>> {
        let (i, dv) = within_interval(self.values(), &restrict(value, from, to));
        let (j, dg) = within_interval(self.gradients(), &restrict(magnitude, from, to));
        if self.are_empty([i, i], [j, j]) {
            return None;
        }
        let Bilinear { low, by_value, by_gradient, by_both } = self.patch(i, j);
        let (v, g, vg) = (elevate(&dv), elevate(&dg), product(&dv, &dg));
        let channel = |c: usize| -> [R; 7] {
            each(|k| by_both[c].mul_plus(vg[k], by_gradient[c].mul_plus(g[k], by_value[c].mul_plus(v[k], low[c]))))
        };
        let optics = Optics { emission: [channel(0), channel(1), channel(2)], extinction: channel(3) };
        Some(if S::LIT {
            optics.integrate_shaded::<8>(length_mm, &shader.factors(shading, from, to), shader.largest_color())
        } else {
            optics.integrate(length_mm)
        })
    }
}

/// The interval of an axis in which a cubic lies that does not cross a knot, and the cubic less the interval's lower knot.
/// Outside the domain the transfer function is constant, so there the cubic is replaced by the domain's end.
#[inline(always)]
fn within_interval<R: Real>(axis: &Axis<R>, cubic: &Cubic<R>) -> (usize, Cubic<R>) {
    // Its value in the middle.
    let eighth = R::from_f64(0.125);
    let middle = eighth * (cubic[0] + R::from_f64(3.0) * (cubic[1] + cubic[2]) + cubic[3]);
    let inside = axis.clamp(middle);
    let i = axis.interval(inside);
    let knot = axis.knots()[i];
    (i, if inside == middle { cubic.map(|x| x - knot) } else { [inside - knot; 4] })
}
