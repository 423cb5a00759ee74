//! What absorbs and emits along a segment: which pieces there are, and the polynomials on each.

use crate::classify::{Axis, Bilinear, Classifier, Linear, OneD, TwoD};
use crate::field::Voxel;
use crate::math::bernstein::{Cubic, elevate, product, range, restrict};
use crate::math::{Real, each};

use super::cells::Segment;
use super::lattice::{Lattice, along, magnitudes};
use super::piece::{Integral, Optics};
use super::shade::Shader;
use super::splits::Splits;

/// What absorbs and emits along a ray. It reads of a cell what it needs, and nothing else.
pub(super) trait Medium<R: Real>: Sync {
    /// The fields along a segment: cubics.
    type Fields;

    /// The fields along a segment, or `None` if nothing absorbs or emits there.
    fn fields(&self, segment: &Segment) -> Option<Self::Fields>;

    /// The gradient along a segment, HU/mm; asked for by shaders that read it.
    fn gradient(&self, fields: &Self::Fields, segment: &Segment) -> [Cubic<R>; 3];

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

/// A scalar lattice, classified at each point by a baked transfer function.
#[derive(Debug, Clone)]
pub(super) struct Classified<'a, V, C> {
    pub(super) lattice: Lattice<'a, V>,
    pub(super) classifier: C,
}

impl<R: Real, V: Voxel> Medium<R> for Classified<'_, V, OneD<R>> {
    type Fields = Cubic<R>;

    #[inline(always)]
    fn fields(&self, segment: &Segment) -> Option<Cubic<R>> {
        let stored = self.lattice.corners(segment.cell);
        let dark = |r: [R; 2]| self.classifier.is_empty(r, [R::ZERO; 2]);
        if dark(range(&stored)) {
            return None;
        }
        let value = along(&stored, segment);
        (!dark(range(&value))).then_some(value)
    }

    #[inline(always)]
    fn gradient(&self, _: &Cubic<R>, segment: &Segment) -> [Cubic<R>; 3] {
        let corners = self.lattice.gradients(segment.cell);
        each(|axis| along(&corners[axis], segment))
    }

    #[inline(always)]
    fn cut(&self, value: &Cubic<R>, splits: &mut Splits<R>) {
        splits.cut(value, self.classifier.axis());
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
        let (i, dv) = within_interval(self.classifier.axis(), &restrict(value, from, to));
        if self.classifier.are_empty(i, i) {
            return None;
        }
        let Linear { low, slope } = self.classifier.piece(i);
        let channel = |c: usize| dv.map(|d| slope[c].mul_plus(d, low[c]));
        let optics = Optics { emission: [channel(0), channel(1), channel(2)], extinction: channel(3) };
        Some(shader.integrate::<4, 5>(&optics, length_mm, shading, [from, to]))
    }
}

/// What a 2D transfer function reads along a segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct ValueAndMagnitude<R> {
    pub(super) value: Cubic<R>,
    pub(super) magnitude: Cubic<R>,
    /// At the cell's corners: the magnitudes were made of them, and shading reads the same ones.
    gradients: [[R; 8]; 3],
}

impl<R: Real, V: Voxel> Medium<R> for Classified<'_, V, TwoD<R>> {
    type Fields = ValueAndMagnitude<R>;

    #[inline(always)]
    fn fields(&self, segment: &Segment) -> Option<ValueAndMagnitude<R>> {
        let stored = self.lattice.corners(segment.cell);
        let knots = self.classifier.gradients();
        let everything = [R::ZERO, knots.knots()[knots.intervals()]];
        if self.classifier.is_empty(range(&stored), everything) {
            return None;
        }
        let value = along(&stored, segment);
        let gradients = self.lattice.gradients(segment.cell);
        let magnitude = along(&magnitudes(&gradients), segment);
        let fields = ValueAndMagnitude { value, magnitude, gradients };
        (!self.classifier.is_empty(range(&value), range(&magnitude))).then_some(fields)
    }

    #[inline(always)]
    fn gradient(&self, fields: &ValueAndMagnitude<R>, segment: &Segment) -> [Cubic<R>; 3] {
        each(|axis| along(&fields.gradients[axis], segment))
    }

    #[inline(always)]
    fn cut(&self, fields: &ValueAndMagnitude<R>, splits: &mut Splits<R>) {
        splits.cut(&fields.value, self.classifier.values());
        splits.cut(&fields.magnitude, self.classifier.gradients());
    }

    #[inline(always)]
    fn integrate<S: Shader<R>>(
        &self,
        ValueAndMagnitude { value, magnitude, .. }: &ValueAndMagnitude<R>,
        [from, to]: [R; 2],
        length_mm: R,
        shader: &S,
        shading: &S::Cell,
    ) -> Option<Integral<R>> {
        let (i, dv) = within_interval(self.classifier.values(), &restrict(value, from, to));
        let (j, dg) = within_interval(self.classifier.gradients(), &restrict(magnitude, from, to));
        if self.classifier.are_empty([i, i], [j, j]) {
            return None;
        }
        let Bilinear { low, by_value, by_gradient, by_both } = self.classifier.patch(i, j);
        let (v, g, vg) = (elevate(&dv), elevate(&dg), product(&dv, &dg));
        let channel = |c: usize| -> [R; 7] {
            each(|k| by_both[c].mul_plus(vg[k], by_gradient[c].mul_plus(g[k], by_value[c].mul_plus(v[k], low[c]))))
        };
        let optics = Optics { emission: [channel(0), channel(1), channel(2)], extinction: channel(3) };
        Some(shader.integrate::<7, 8>(&optics, length_mm, shading, [from, to]))
    }
}

/// The interval of an axis in which a cubic lies that does not cross a knot, and the cubic less the interval's lower knot.
/// Outside the domain the transfer function is constant, so there the cubic is replaced by the domain's end.
#[inline(always)]
pub(super) fn within_interval<R: Real>(axis: &Axis<R>, cubic: &Cubic<R>) -> (usize, Cubic<R>) {
    // Its value in the middle.
    let eighth = R::from_f64(0.125);
    let middle = eighth * (cubic[0] + R::from_f64(3.0) * (cubic[1] + cubic[2]) + cubic[3]);
    let inside = axis.clamp(middle);
    let i = axis.interval(inside);
    let knot = axis.knots()[i];
    (i, if inside == middle { cubic.map(|x| x - knot) } else { [inside - knot; 4] })
}
