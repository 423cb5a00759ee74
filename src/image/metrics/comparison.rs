//! Everything that is said of two pictures at once.

use serde::Serialize;

use super::{Difference, PIXELS_PER_DEGREE, compare, delta_e_2000, flip, ssim};
use crate::error::Result;
use crate::image::Image;

/// How two pictures differ: in numbers, and as people see them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Linear premultiplied values, alpha included.
    #[serde(flatten)]
    pub difference: Difference,
    /// Largest of the largest differences of all channels.
    pub max_abs_all: f64,
    /// Root mean square over all channels.
    pub rms_all: f64,
    /// The difference that 99.9 % of the pixels do not exceed in any channel.
    pub error_of_999_in_1000: f64,
    /// Peak signal-to-noise ratio, dB; `None`, null in JSON, for equal pictures, of which it is infinite.
    pub psnr_db: Option<f64>,
    /// Mean structural similarity of red, green, blue and alpha; `None` for pictures of fewer than 11 pixels a side.
    pub ssim: Option<[f64; 4]>,
    /// CIEDE2000 of what a display shows in front of black.
    pub delta_e_2000: Spread,
    /// ꟻLIP, from 0 to 1.
    pub flip: Spread,
}

/// Mean and largest of a number per pixel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Mean over the pixels.
    pub mean: f64,
    /// Largest.
    pub max: f64,
}

impl Spread {
    fn of(values: &[f64]) -> Self {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        Spread { mean, max: values.iter().copied().fold(0.0, f64::max) }
    }
}

/// Compares a picture with a reference by every metric; `tolerance` as for [`compare`].
///
/// # Errors
/// As [`compare`].
pub fn compare_as_seen(reference: &Image, test: &Image, tolerance: f64) -> Result<Comparison> {
    let difference = compare(reference, test, tolerance)?;
    let psnr_db = difference.psnr_db();
    Ok(Comparison {
        max_abs_all: difference.max_abs_all(),
        rms_all: difference.rms_all(),
        error_of_999_in_1000: exceeded_by_one_in_1000(reference, test),
        psnr_db: (psnr_db != f64::INFINITY).then_some(psnr_db),
        ssim: ssim(reference, test),
        delta_e_2000: Spread::of(&delta_e_2000(reference, test)),
        flip: Spread::of(&flip(reference, test, PIXELS_PER_DEGREE)),
        difference,
    })
}

fn exceeded_by_one_in_1000(a: &Image, b: &Image) -> f64 {
    let mut largest: Vec<f64> = super::largest_per_pixel(a, b).collect();
    largest.sort_by(f64::total_cmp);
    let rank = (0.999 * largest.len() as f64).ceil() as usize;
    rank.checked_sub(1).map_or(0.0, |index| largest[index])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bad_pixel_of_many_is_the_largest_and_not_the_typical() {
        let picture = |bad: f32| {
            let mut image = Image::from_pixels(60, 50, vec![[0.25, 0.25, 0.25, 1.0]; 3000]);
            image.pixels_mut()[77] = [bad, 0.25, 0.25, 1.0];
            image
        };
        let found = compare_as_seen(&picture(0.25), &picture(0.75), 1e-3).unwrap();
        assert_eq!((found.max_abs_all, found.error_of_999_in_1000), (0.5, 0.0));
        assert_eq!(found.difference.pixels_over, 1);
        assert!(found.delta_e_2000.max > 20.0 && found.flip.max > 0.15, "it is seen: {found:?}");
        let same = compare_as_seen(&picture(0.25), &picture(0.25), 0.0).unwrap();
        assert_eq!((same.psnr_db, same.flip.max, same.delta_e_2000.max), (None, 0.0, 0.0));
    }
}
