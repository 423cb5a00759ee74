//! The error of a finished picture, on random pixels, against the oracle.

use std::collections::BTreeSet;

use rayon::prelude::*;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::image::Image;
use crate::oracle::Oracle;
use crate::plan::Plan;
use crate::study::{Errors, difference, share_unseen};
use crate::volume::Volume;

/// Chance that the statement of a [`Certificate`] is wrong.
const RISK: f64 = 0.05;

/// What random pixels of a picture say of its error: the largest difference to the oracle over the channels, linear and
/// premultiplied.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Certificate {
    /// Pixels that were recomputed, each at most once.
    pub pixels: usize,
    /// Largest error found.
    pub largest_error: f64,
    /// The error that 99.9 % of these pixels do not exceed.
    pub error_of_999_in_1000: f64,
    /// Root of the mean square of these errors.
    pub rms_error: f64,
    /// Pixels whose error is above the tolerance, where one was asked for.
    pub above_tolerance: Option<usize>,
    /// What follows for the whole picture.
    pub statement: String,
}

impl Certificate {
    /// Recomputes `count` pixels of a picture by the oracle, or all if it has no more.
    ///
    /// Which pixels is decided by a hash of the picture's own, so that nobody chooses them and anybody can repeat it.
    pub(super) fn of(image: &Image, pixels_sha256: &str, volume: &Volume, plan: &Plan, count: usize) -> Self {
        let oracle = Oracle::new(volume, &plan.scene);
        let error = |&index: &usize| {
            let (column, row) = (index % image.width(), index / image.width());
            difference(image.pixel(column, row), oracle.pixel(column, row))
        };
        let chosen = chosen(pixels_sha256, image.pixels().len(), count);
        let errors = chosen.par_iter().map(error).collect();
        Certificate::from_errors(errors, image.pixels().len(), plan.tolerance())
    }

    /// Whether a pixel is above the tolerance that was asked for, or is no number at all.
    pub(super) fn fails(&self) -> bool {
        self.above_tolerance.is_some_and(|above| above > 0) || !self.largest_error.is_finite()
    }

    fn from_errors(errors: Vec<f64>, of_pixels: usize, tolerance: Option<f64>) -> Self {
        let above_tolerance = tolerance.map(|t| errors.iter().filter(|error| **error > t).count());
        let Errors { pixels, largest, of_999_in_1000, rms } = Errors::of(errors);
        Certificate {
            pixels,
            largest_error: largest,
            error_of_999_in_1000: of_999_in_1000,
            rms_error: rms,
            above_tolerance,
            statement: statement(pixels, of_pixels, above_tolerance),
        }
    }
}

fn statement(pixels: usize, of_pixels: usize, above_tolerance: Option<usize>) -> String {
    match above_tolerance {
        None => format!("{pixels} of {of_pixels} pixels recomputed; no tolerance was asked for"),
        Some(0) if pixels == of_pixels => format!("all {pixels} pixels are within the tolerance"),
        Some(0) => {
            let share = 100.0 * share_unseen(pixels, RISK);
            let confidence = 100.0 * (1.0 - RISK);
            format!(
                "0 of {pixels} above tolerance: fewer than {share:.2} % of all pixels, at {confidence:.0} % confidence"
            )
        }
        Some(above) => format!("{above} of {pixels} above tolerance"),
    }
}

/// `count` different numbers below `of`, or all of them.
fn chosen(seed: &str, of: usize, count: usize) -> Vec<usize> {
    if count >= of {
        return (0..of).collect();
    }
    let mut chosen = BTreeSet::new();
    for counter in 0_u64.. {
        if chosen.len() == count {
            break;
        }
        let hash = Sha256::new().chain_update(seed).chain_update(counter.to_le_bytes()).finalize();
        let number = hash.iter().take(8).fold(0_u64, |number, byte| number << 8 | u64::from(*byte));
        // 64 bits over at most 2^32 pixels: the share by which some are favoured is below 2^-32.
        chosen.insert((number % of as u64) as usize);
    }
    chosen.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_above_the_tolerance_is_found_and_counted() {
        let mut errors = vec![0.001; 999];
        errors.push(0.5);
        let certificate = Certificate::from_errors(errors, 4000, Some(0.004));
        assert_eq!((certificate.largest_error, certificate.error_of_999_in_1000), (0.5, 0.001));
        assert_eq!(certificate.above_tolerance, Some(1));
        let rms = ((999.0 * 1e-6 + 0.25) / 1000.0f64).sqrt();
        assert!((certificate.rms_error - rms).abs() < 1e-12, "found {}, expected {rms}", certificate.rms_error);
        assert_eq!(certificate.statement, "1 of 1000 above tolerance");
    }

    #[test]
    fn a_broken_tolerance_and_a_pixel_that_is_no_number_are_failures() {
        let judged = |errors: &[f64], tolerance| Certificate::from_errors(errors.to_vec(), 9, tolerance).fails();
        assert!(judged(&[0.0, 0.005], Some(0.004)), "above the tolerance");
        assert!(!judged(&[0.0, 0.003], Some(0.004)), "within it");
        assert!(!judged(&[0.0, 0.3], None), "no tolerance was asked for");
        assert!(judged(&[0.0, f64::INFINITY], None), "a NaN, which counts as infinite, whatever was asked for");
    }

    #[test]
    fn no_error_among_3000_supports_a_tenth_of_a_percent() {
        let certificate = Certificate::from_errors(vec![0.0; 3000], 1 << 20, Some(0.004));
        assert_eq!(
            certificate.statement,
            "0 of 3000 above tolerance: fewer than 0.10 % of all pixels, at 95 % confidence"
        );
    }

    #[test]
    fn pixels_are_chosen_once_each_and_the_same_each_time() {
        let first = chosen("seed", 1000, 600);
        assert_eq!(first.len(), 600);
        assert!(first.windows(2).all(|pair| pair[0] < pair[1]) && first[599] < 1000, "different and in range");
        assert_eq!(first, chosen("seed", 1000, 600));
        assert_ne!(first, chosen("other", 1000, 600));
        assert_eq!(chosen("seed", 3, 10), [0, 1, 2]);
    }
}
