//! Optical depth along a ray: between knots the extinction is a polynomial, so its integral is exact. In f64.

use crate::classify::{Bilinear, Linear, OneD, TwoD};
use crate::field::Voxel;
use crate::math::bernstein::{elevate, product, restrict, sum};

use super::cells::Segment;
use super::masked::Masked;
use super::medium::{Classified, Medium, ValueAndMagnitude, within_interval};
use super::splits::Splits;

/// What absorbs along a ray.
pub(super) trait Extinction: Medium<f64> + Sync {
    /// Mean extinction, 1/mm, over the part `[from, to]` of a segment, which lies between neighbouring cuts.
    fn mean_per_mm(&self, fields: &Self::Fields, part: [f64; 2]) -> f64;
}

/// Index of the extinction among the channels of a baked transfer function.
const EXTINCTION: usize = 3;

impl<V: Voxel> Extinction for Classified<'_, V, OneD<f64>> {
    fn mean_per_mm(&self, value: &Self::Fields, [from, to]: [f64; 2]) -> f64 {
        let (i, dv) = within_interval(self.classifier.axis(), &restrict(value, from, to));
        let Linear { low, slope } = self.classifier.piece(i);
        low[EXTINCTION] + slope[EXTINCTION] * (0.25 * sum(&dv))
    }
}

impl<V: Voxel> Extinction for Classified<'_, V, TwoD<f64>> {
    fn mean_per_mm(&self, ValueAndMagnitude { value, magnitude, .. }: &Self::Fields, [from, to]: [f64; 2]) -> f64 {
        let (i, dv) = within_interval(self.classifier.values(), &restrict(value, from, to));
        let (j, dg) = within_interval(self.classifier.gradients(), &restrict(magnitude, from, to));
        let Bilinear { low, by_value, by_gradient, by_both } = self.classifier.patch(i, j);
        let mean = |coefficients: &[f64; 7]| sum(coefficients) / 7.0;
        low[EXTINCTION]
            + by_value[EXTINCTION] * mean(&elevate(&dv))
            + by_gradient[EXTINCTION] * mean(&elevate(&dg))
            + by_both[EXTINCTION] * mean(&product(&dv, &dg))
    }
}

impl<M: Extinction> Extinction for Masked<'_, M> {
    fn mean_per_mm(&self, fields: &Self::Fields, part: [f64; 2]) -> f64 {
        let class = fields.class_at(0.5 * (part[0] + part[1]));
        self.media[class].mean_per_mm(fields.within_class(), part)
    }
}

/// The optical depth along the segments of a ray.
pub(super) fn optical_depth<M: Extinction>(medium: &M, segments: impl Iterator<Item = Segment>) -> f64 {
    let mut splits = Splits::<f64>::default();
    let mut depth = 0.0;
    for segment in segments {
        let Some(fields) = medium.fields(&segment) else { continue };
        // In f64 no cut is uncertain enough to matter.
        splits.restart(0.0);
        medium.cut(&fields, &mut splits);
        for ends in splits.sorted().windows(2) {
            let part = [ends[0], ends[1]];
            // Rounding may take a vanishing extinction below 0.
            depth += medium.mean_per_mm(&fields, part).max(0.0) * (part[1] - part[0]) * segment.length_mm;
        }
    }
    depth
}
