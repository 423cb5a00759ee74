//! `1 − e^{−τ}` in f32, accurate relative to itself for every optical depth.
//!
//! With `−τ = k ln 2 + f`, `|f| ≤ ln 2 / 2`: `e^{−τ} − 1 = 2^k (e^f − 1) + (2^k − 1)`, where `e^f − 1` is a polynomial
//! without a constant term, so nothing cancels as τ → 0. Own code rather than the platform's `expm1f`, so that pictures do
//! not depend on the operating system's mathematics library.

use super::Number;

/// `1 − e^{−τ}` for τ ≥ 0; relative error at most 2e-7 (asserted below), 1 for τ beyond 87.
#[inline(always)]
pub fn absorbed_f32(optical_depth: f32) -> f32 {
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
    if optical_depth < 1e-4 {
        // Next term τ²/6 is below 2e-9 here.
        1.0f32.minus_product(0.5, optical_depth)
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
