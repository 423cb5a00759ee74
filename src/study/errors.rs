//! How far pixels are from the truth.

use serde::Serialize;

/// Errors of some pixels: of each, the largest difference to the truth over its channels, linear and premultiplied.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Errors {
    /// How many pixels.
    pub pixels: usize,
    /// Largest error.
    pub largest: f64,
    /// The error that 99.9 % of the pixels do not exceed.
    pub of_999_in_1000: f64,
    /// Root of the mean square.
    pub rms: f64,
}

impl Errors {
    /// Sums up the errors of pixels; of none they are 0.
    pub fn of(mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let pixels = errors.len();
        let rank = (0.999 * pixels as f64).ceil() as usize;
        let square = errors.iter().map(|error| error * error).sum::<f64>();
        Errors {
            pixels,
            largest: errors.last().copied().unwrap_or(0.0),
            of_999_in_1000: rank.checked_sub(1).map_or(0.0, |index| errors[index]),
            rms: (square / pixels.max(1) as f64).sqrt(),
        }
    }
}

/// The share of all pixels that may be wrong although none of `pixels` random ones is, at `1 - risk` confidence: if a share
/// `p` were, all of them would be right with the chance `(1 - p)^pixels`. About `3 / pixels` for a risk of 0.05.
pub fn share_unseen(pixels: usize, risk: f64) -> f64 {
    if pixels == 0 { 1.0 } else { 1.0 - risk.powf(1.0 / pixels as f64) }
}

/// Largest difference over the channels of a pixel; a NaN counts as infinite.
pub fn difference(found: [f32; 4], truth: [f64; 4]) -> f64 {
    let channels = found.iter().zip(truth).map(|(&found, truth)| (f64::from(found) - truth).abs());
    channels.map(|d| if d.is_nan() { f64::INFINITY } else { d }).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pixel_in_a_thousand_is_the_largest_error_and_no_more() {
        let mut errors = vec![0.001; 999];
        errors.push(0.5);
        let found = Errors::of(errors);
        assert_eq!((found.pixels, found.largest, found.of_999_in_1000), (1000, 0.5, 0.001));
        let rms = ((999.0 * 1e-6 + 0.25) / 1000.0f64).sqrt();
        assert!((found.rms - rms).abs() < 1e-12, "found {}, expected {rms}", found.rms);
        assert_eq!(Errors::of(Vec::new()).largest, 0.0, "of no pixels");
    }

    #[test]
    fn what_a_sample_does_not_see_is_three_over_its_size() {
        let found = share_unseen(1000, 0.05);
        assert!((found - 0.003).abs() < 1e-5, "found {found}, expected about 3 in 1000");
        assert_eq!(share_unseen(0, 0.05), 1.0, "no pixel was looked at");
    }

    #[test]
    fn a_pixel_that_is_no_number_is_infinitely_wrong() {
        assert_eq!(difference([f32::NAN, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]), f64::INFINITY);
        assert_eq!(difference([0.0, 0.25, 0.0, 1.0], [0.0, 0.5, 0.125, 1.0]), 0.25);
    }
}
