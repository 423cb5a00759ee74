//! Optical depth by Gauss-Legendre quadrature on each piece, where extinction is a polynomial of degree 3 or 6.

use super::Oracle;
use super::fields::Fields;
use super::quadrature::Gauss;
use super::splits::Splits;
use crate::scene::Ray;

/// Exact up to degree 7.
const NODES: usize = 4;

/// `∫ σ ds` over a ray, or `None` if it misses the volume.
pub(super) fn optical_depth(oracle: &Oracle<'_>, ray: &Ray) -> Option<f64> {
    let gauss = Gauss::<NODES>::new();
    let path = oracle.path(ray, 0.0, f64::INFINITY)?;
    let mut splits = Splits::default();
    let mut depth = 0.0;
    for (passage, patches) in path.passages().flat_map(|passage| oracle.functions.along(passage)) {
        let Some(patches) = patches else { continue };
        let Some(fields) = Fields::new(oracle.volume, patches, false, &passage) else { continue };
        splits.restart();
        fields.add_knots(patches, &mut splits);
        for [from, to] in splits.pieces() {
            let Some(piece) = fields.piece(patches, [from, to]) else { continue };
            let extinction = |x: f64| fields.optics(patches, &piece, from + x * (to - from))[0];
            let mean: f64 = gauss.nodes.iter().zip(gauss.weights).map(|(&x, w)| w * extinction(x)).sum();
            depth += mean * (to - from) * passage.length_mm;
        }
    }
    Some(depth)
}
