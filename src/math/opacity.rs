//! Opacity of a length, and extinction.

/// Extinction (1/mm) of what has this opacity over `length_mm`: `-ln(1 - α) / length`, with α at most 1 − 2⁻²⁴ so that
/// what is said to be opaque absorbs all that 24 bits can show and the extinction stays finite.
pub fn extinction_per_mm(opacity: f64, length_mm: f64) -> f64 {
    const MOST: f64 = 1.0 - 1.0 / (1 << 24) as f64;
    -(-opacity.clamp(0.0, MOST)).ln_1p() / length_mm
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opacity_becomes_extinction_and_full_opacity_stays_finite() {
        assert_eq!(extinction_per_mm(0.0, 1.0), 0.0);
        let half = extinction_per_mm(0.5, 2.0);
        assert!((half - 0.5 * std::f64::consts::LN_2).abs() < 1e-16, "found {half}");
        let opaque = extinction_per_mm(1.0, 1.0);
        assert!((opaque - 24.0 * std::f64::consts::LN_2).abs() < 1e-6, "24 bits of it: found {opaque}");
        let tiny = extinction_per_mm(1e-18, 1.0);
        assert_eq!(tiny, 1e-18, "no cancellation");
    }
}
