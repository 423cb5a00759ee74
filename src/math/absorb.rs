//! `1 − e^{−τ}` and `(1 − e^{−τ})/τ` in f32, accurate relative to themselves for every optical depth.
//!
//! Up to `τ = 2`, as nearly all steps and cells have it, the second one is a polynomial, and the first one τ times that: no exponential, no
//! division, nothing that cancels. Beyond, with `−τ = k ln 2 + f`, `|f| ≤ ln 2 / 2`: `e^{−τ} − 1 = 2^k (e^f − 1) + (2^k − 1)`, where
//! `e^f − 1` is a polynomial without a constant term. Own code rather than the platform's `expm1f`, so that pictures do
//! not depend on the operating system's mathematics library.

use super::Number;

/// Optical depths for which [`mean_transmittance_of_thin`] holds.
pub const THIN: f32 = 2.0;

/// `(1 − e^{−τ})/τ` for `τ = 1 + t`, by powers of `t`: least largest relative error over `[0, 2]`, by Lawson's iteration. The last
/// one is moved a little, so that all of them, as f32, give 1 at 0.
const OF_THIN: [f64; 8] = [
    0.632_120_549_678_802_5,
    -0.264_241_129_159_927_37,
    0.080_301_672_220_230_1,
    -0.018_988_028_168_678_284,
    0.003_658_453_468_233_347,
    -0.000_594_361_161_347_478_6,
    8.549_525_955_459_103e-5,
    -1.030_164_003_168_465_6e-5,
];

/// `(1 − e^{−τ})/τ` for τ from 0 to [`THIN`].
#[inline(always)]
pub fn mean_transmittance_of_thin<R: Number>(optical_depth: R) -> R {
    let c = |k: usize| R::from_f64(OF_THIN[k]);
    let t = optical_depth - R::ONE;
    let square = t * t;
    let even = c(6).mul_plus(square, c(4)).mul_plus(square, c(2)).mul_plus(square, c(0));
    let odd = c(7).mul_plus(square, c(5)).mul_plus(square, c(3)).mul_plus(square, c(1));
    odd.mul_plus(t, even)
}

/// `1 − e^{−τ}` for τ ≥ 0; relative error at most 2e-7 (asserted below), 1 for τ beyond 87.
#[inline(always)]
pub fn absorbed_f32(optical_depth: f32) -> f32 {
    if optical_depth <= THIN {
        return optical_depth * mean_transmittance_of_thin(optical_depth);
    }
    // Beyond this e^{-τ} is below the smallest normal number, and 1 − e^{−τ} rounds to 1 long before.
    let x = -(if optical_depth < 87.0 { optical_depth } else { 87.0 });
    let k = (x * std::f32::consts::LOG2_E).round_ties_even();
    // ln 2 in two parts, so that k · LN2_HIGH is exact.
    const LN2_HIGH: f32 = 0.693_359_4;
    const LN2_LOW: f32 = -2.121_944_4e-4;
    let f = x.minus_product(k, LN2_HIGH).minus_product(k, LN2_LOW);
    let p = (1.0f32 / 5040.0).mul_plus(f, 1.0 / 720.0);
    let p = p.mul_plus(f, 1.0 / 120.0);
    let p = p.mul_plus(f, 1.0 / 24.0);
    let p = p.mul_plus(f, 1.0 / 6.0);
    let p = p.mul_plus(f, 0.5);
    let expm1 = (p * f).mul_plus(f, f);
    // 2^k for k in [-126, 0] by its exponent bits.
    let scale = f32::from_bits(((k as i32 + 127) as u32) << 23);
    (1.0 - scale).minus_product(scale, expm1)
}

/// `(1 − e^{−τ}) / τ` for τ ≥ 0; relative error at most 3e-7 (asserted below), 1 at 0.
#[inline(always)]
pub fn mean_transmittance_f32(optical_depth: f32) -> f32 {
    if optical_depth <= THIN {
        mean_transmittance_of_thin(optical_depth)
    } else {
        absorbed_f32(optical_depth) / optical_depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Geometric sweep of optical depths from 1e-12 to 1e4, 2 million of them.
    fn sweep(worst_of: impl Fn(f32) -> f64) -> f64 {
        (0..2_000_000)
            .map(|i| 1e-12 * 10f64.powf(16.0 * f64::from(i) / 2e6))
            .map(|t| worst_of(t as f32))
            .fold(0.0, f64::max)
    }

    #[test]
    fn absorbed_is_within_its_stated_relative_error() {
        let worst = sweep(|t| {
            let truth = -(-f64::from(t)).exp_m1();
            (f64::from(absorbed_f32(t)) / truth - 1.0).abs()
        });
        assert!(worst <= 2e-7, "largest relative error {worst:e}");
        assert_eq!(absorbed_f32(0.0), 0.0);
        assert_eq!(absorbed_f32(f32::INFINITY), 1.0);
    }

    #[test]
    fn mean_transmittance_is_within_its_stated_relative_error() {
        let worst = sweep(|t| {
            let t64 = f64::from(t);
            (f64::from(mean_transmittance_f32(t)) / (-(-t64).exp_m1() / t64) - 1.0).abs()
        });
        assert!(worst <= 3e-7, "largest relative error {worst:e}");
        assert_eq!(mean_transmittance_f32(0.0), 1.0);
    }

    #[test]
    fn the_naive_form_would_fail() {
        let t = 1e-6f32;
        let naive = 1.0 - (-t).exp();
        assert!((f64::from(naive) / 1e-6 - 1.0).abs() > 1e-2, "cancellation is what this module is for");
    }
}
