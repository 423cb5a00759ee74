//! The best that any transfer function could do on a scan whose labels are known.

use serde::Serialize;

use super::Mask;
use super::histogram::{Bin, Histogram};
use crate::error::Result;
use crate::volume::Volume;

/// Highest Dice that any function could reach on a scan, labels known: a preset is judged against what is possible.
///
/// Functions are constant on bins of 10 HU ([`BIN_VALUE`](super::BIN_VALUE)) and 5 HU/mm
/// ([`BIN_GRADIENT_PER_MM`](super::BIN_GRADIENT_PER_MM)): finer bins would follow the noise of the scan. A preset's knots need
/// not lie on the bins, so on few voxels it may be a little above the bound of this binning.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bound {
    /// By a function of the value.
    pub by_value: f64,
    /// By a function of value and gradient magnitude.
    pub by_value_and_gradient: f64,
}

/// The bounds for a mask; 0 for an empty one.
///
/// # Errors
/// `Fault::Geometry` if mask and volume differ in their number of voxels.
pub fn bound(volume: &Volume, mask: &Mask) -> Result<Bound> {
    let histogram = Histogram::new(volume, mask)?;
    let total = histogram.of_tissue();
    let joint = histogram.bins().map(|(_, bin)| bin).collect();
    Ok(Bound { by_value: best_dice(histogram.by_value(), total), by_value_and_gradient: best_dice(joint, total) })
}

/// The highest Dice of any set of bins. Adding a bin raises Dice `2P / (C + L)` exactly if its share of the tissue is above
/// half of it, so the best set holds the bins above some share, and taking bins by descending share passes it.
fn best_dice(mut bins: Vec<Bin>, of_tissue: u64) -> f64 {
    // Shares a/b < c/d as products of whole numbers: no rounding, so the order is the same everywhere.
    let product = |a: &Bin, b: &Bin| u128::from(a.of_tissue) * u128::from(b.voxels);
    bins.sort_by(|a, b| product(b, a).cmp(&product(a, b)));
    let (mut inside, mut taken, mut best) = (0, 0, 0.0_f64);
    for bin in bins.iter().filter(|bin| bin.of_tissue > 0) {
        inside += bin.of_tissue;
        taken += bin.voxels;
        best = best.max(2.0 * inside as f64 / (taken + of_tissue) as f64);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_set_of_bins_is_better() {
        let mut state = 7_u64;
        let mut next = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        for case in 0..50 {
            let mut bin = || {
                let voxels = 1 + next(20);
                Bin { voxels, of_tissue: next(voxels + 1) }
            };
            let bins: Vec<Bin> = (0..9).map(|_| bin()).collect();
            let total: u64 = bins.iter().map(|bin| bin.of_tissue).sum();
            let dice = |set: u32| {
                let chosen = || bins.iter().enumerate().filter(|(n, _)| set >> n & 1 == 1).map(|(_, bin)| bin);
                let (inside, taken): (u64, u64) =
                    (chosen().map(|b| b.of_tissue).sum(), chosen().map(|b| b.voxels).sum());
                2.0 * inside as f64 / ((taken + total) as f64).max(1.0)
            };
            let expected = (0..1 << 9).map(dice).fold(0.0, f64::max);
            let found = best_dice(bins.clone(), total);
            assert!((found - expected).abs() < 1e-12, "case {case}: found {found}, expected {expected} for {bins:?}");
        }
    }
}
