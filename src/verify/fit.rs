//! Norms and orders.

/// Largest difference of a channel of a pixel; infinite if any is not a number, or the pictures differ in size.
pub fn largest_difference(found: &[[f64; 4]], expected: &[[f64; 4]]) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    let channels = found.iter().flatten().zip(expected.iter().flatten()).map(|(x, y)| (x - y).abs());
    channels.map(|d| if d.is_nan() { f64::INFINITY } else { d }).fold(0.0, f64::max)
}

/// Order of convergence of `[size, error]` pairs: the slope of log error over log size by least squares. Not a number for
/// fewer than two pairs or an error of 0 or NaN.
pub fn order(series: &[[f64; 2]]) -> f64 {
    let n = series.len() as f64;
    let mean = |a: usize| series.iter().map(|pair| pair[a].ln()).sum::<f64>() / n;
    let (x0, y0) = (mean(0), mean(1));
    let (mut xx, mut xy) = (0.0, 0.0);
    for [size, error] in series {
        let (x, y) = (size.ln() - x0, error.ln() - y0);
        xx += x * x;
        xy += x * y;
    }
    xy / xx
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_have_their_exponent_as_order() {
        for exponent in [0.0, 1.0, 2.0, 4.0] {
            let series: Vec<_> = (0..5).map(|i| 0.5f64.powi(i)).map(|h| [h, 3.0 * h.powf(exponent)]).collect();
            assert!((order(&series) - exponent).abs() < 1e-12, "found {}, expected {exponent}", order(&series));
        }
        assert!(order(&[[1.0, 1.0]]).is_nan(), "one point has no slope");
        assert!(order(&[[1.0, 1.0], [0.5, 0.0]]).is_nan(), "no error has no logarithm");
    }

    #[test]
    fn a_picture_with_a_nan_or_of_another_size_is_infinitely_far() {
        assert_eq!(largest_difference(&[[0.0, f64::NAN, 0.0, 0.0]], &[[0.0; 4]]), f64::INFINITY);
        assert_eq!(largest_difference(&[[0.0; 4]], &[]), f64::INFINITY);
        assert_eq!(largest_difference(&[[0.0, 0.5, 0.0, -1.0]], &[[0.0; 4]]), 1.0);
    }
}
