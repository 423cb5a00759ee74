//! Structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004), of what a display shows.

use crate::image::plane::{Plane, gaussian};
use crate::image::{Image, srgb};

/// The paper's window: a Gaussian of 11 x 11 pixels with a standard deviation of 1.5.
const RADIUS: usize = 5;
const DEVIATION: f64 = 1.5;
/// The paper's constants, for values from 0 to 1.
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// Mean structural similarity of red, green, blue and alpha, each at most 1, which is for equal channels.
///
/// Colours are compared as a display shows them, sRGB in front of black; windows lie inside the picture. `None` for
/// pictures smaller than one window. The pictures must have one size.
pub fn ssim(a: &Image, b: &Image) -> Option<[f64; 4]> {
    if a.width().min(a.height()) <= 2 * RADIUS {
        return None;
    }
    Some(std::array::from_fn(|channel| mean_similarity(&plane(a, channel), &plane(b, channel))))
}

fn plane(image: &Image, channel: usize) -> Plane {
    // What is not a number is shown black.
    let shown = |v: f32| if v > 0.0 { f64::from(v).min(1.0) } else { 0.0 };
    let value = |pixel: &[f32; 4]| {
        let v = shown(pixel[channel]);
        if channel < 3 { srgb::encode(v) } else { v }
    };
    Plane { width: image.width(), height: image.height(), values: image.pixels().iter().map(value).collect() }
}

fn mean_similarity(a: &Plane, b: &Plane) -> f64 {
    let window = gaussian(RADIUS, DEVIATION);
    let mean = |plane: &Plane| plane.filtered(&window, &window);
    let (mean_a, mean_b) = (mean(a), mean(b));
    let square_a = mean(&a.combined(a, |x, y| x * y));
    let square_b = mean(&b.combined(b, |x, y| x * y));
    let product = mean(&a.combined(b, |x, y| x * y));
    let (mut sum, mut count) = (0.0, 0);
    for y in RADIUS..a.height - RADIUS {
        for x in RADIUS..a.width - RADIUS {
            let i = y * a.width + x;
            let (ma, mb) = (mean_a.values[i], mean_b.values[i]);
            let variance = square_a.values[i] - ma * ma + (square_b.values[i] - mb * mb);
            let covariance = product.values[i] - ma * mb;
            sum += (2.0 * ma * mb + C1) * (2.0 * covariance + C2) / ((ma * ma + mb * mb + C1) * (variance + C2));
            count += 1;
        }
    }
    sum / f64::from(count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::metrics::test_pictures;

    #[test]
    fn it_is_what_scikit_image_finds() {
        let (a, b) = test_pictures();
        let found = ssim(&a, &b).unwrap();
        // scikit-image 0.26.0, structural_similarity(gaussian_weights=True, sigma=1.5, use_sample_covariance=False,
        // data_range=1) of each channel in f64.
        let expected =
            [0.993_532_041_182_036_5, 0.939_855_492_201_684_4, 0.900_739_243_485_598_5, 0.987_072_425_519_018_2];
        for c in 0..4 {
            assert!((found[c] - expected[c]).abs() < 1e-9, "channel {c}: found {}, expected {}", found[c], expected[c]);
        }
        assert_eq!(ssim(&a, &a), Some([1.0; 4]), "equal pictures");
    }

    #[test]
    fn a_picture_smaller_than_the_window_has_none() {
        assert_eq!(ssim(&Image::transparent(10, 40), &Image::transparent(10, 40)), None);
    }
}
