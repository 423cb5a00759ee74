//! Optical depth along a ray: between knots the extinction is a polynomial, so its integral is exact. In f64.

use std::cell::OnceCell;

use crate::classify::{Bilinear, Linear, OneD, TwoD};
use crate::field::Voxel;
use crate::math::bernstein::{elevate, product, restrict, sum};
use crate::scene::Ray;
use crate::volume::Grid;

use super::cells::IndexRay;
use super::lattice::Lattice;
use super::medium::{Medium, within_interval};
use super::splits::Splits;

/// What absorbs along a ray.
pub(super) trait Extinction: Medium<f64> + Sync {
    /// Mean extinction, 1/mm, over the part `[from, to]` of a segment, which lies between neighbouring cuts.
    fn mean_per_mm(&self, fields: &Self::Fields, part: [f64; 2]) -> f64;
}

/// Index of the extinction among the channels of a baked transfer function.
const EXTINCTION: usize = 3;

impl Extinction for OneD<f64> {
    fn mean_per_mm(&self, value: &Self::Fields, [from, to]: [f64; 2]) -> f64 {
        let (i, dv) = within_interval(self.axis(), &restrict(value, from, to));
        let Linear { low, slope } = self.piece(i);
        low[EXTINCTION] + slope[EXTINCTION] * (0.25 * sum(&dv))
    }
}

impl Extinction for TwoD<f64> {
    fn mean_per_mm(&self, [value, magnitude]: &Self::Fields, [from, to]: [f64; 2]) -> f64 {
        let (i, dv) = within_interval(self.values(), &restrict(value, from, to));
        let (j, dg) = within_interval(self.gradients(), &restrict(magnitude, from, to));
        let Bilinear { low, by_value, by_gradient, by_both } = self.patch(i, j);
        let mean = |coefficients: &[f64; 7]| sum(coefficients) / 7.0;
        low[EXTINCTION]
            + by_value[EXTINCTION] * mean(&elevate(&dv))
            + by_gradient[EXTINCTION] * mean(&elevate(&dg))
            + by_both[EXTINCTION] * mean(&product(&dv, &dg))
    }
}

/// The optical depth along a ray, or `None` if it misses the volume.
pub(super) fn optical_depth<V: Voxel, M: Extinction>(
    lattice: &Lattice<'_, V>,
    grid: &Grid,
    medium: &M,
    ray: &Ray,
) -> Option<f64> {
    let mut splits = Splits::<f64>::default();
    let mut depth = 0.0;
    for segment in IndexRay::clip(ray, grid)?.segments(grid) {
        let stored = lattice.corners(segment.cell);
        let at_corners = OnceCell::new();
        let gradients = || *at_corners.get_or_init(|| lattice.gradients(segment.cell));
        let Some(fields) = medium.fields(&stored, &segment, gradients) else { continue };
        // In f64 no cut is uncertain enough to matter.
        splits.restart(0.0);
        medium.cut(&fields, &mut splits);
        for ends in splits.sorted().windows(2) {
            let part = [ends[0], ends[1]];
            // Rounding may take a vanishing extinction below 0.
            depth += medium.mean_per_mm(&fields, part).max(0.0) * (part[1] - part[0]) * segment.length_mm;
        }
    }
    Some(depth)
}
