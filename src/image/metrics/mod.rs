//! How much two pictures differ, in linear premultiplied values.

mod comparison;
mod delta_e;
mod flip;
mod ssim;

pub use comparison::{Comparison, compare_as_seen};
pub use delta_e::delta_e_2000;
pub use flip::{PIXELS_PER_DEGREE, flip};
pub use ssim::ssim;

use serde::Serialize;

use super::Image;
use crate::error::{Error, Fault, Result};

/// How much two pictures differ. Arrays are red, green, blue and alpha.
///
/// A difference that is not a number counts as infinite: a NaN is never within a tolerance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Difference {
    /// Largest absolute difference of each channel.
    pub max_abs: [f64; 4],
    /// Root of the mean square difference of each channel.
    pub rms: [f64; 4],
    /// Number of pixels with any channel off by more than the tolerance.
    pub pixels_over: usize,
    /// Number of pixels.
    pub pixels: usize,
    /// The pixel with the largest difference in any channel, the first of them; `None` if all are equal.
    pub worst: Option<WorstPixel>,
}

/// A pixel that differs most.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WorstPixel {
    /// Column from the left.
    pub column: usize,
    /// Row from the top.
    pub row: usize,
    /// Largest absolute difference of its channels.
    pub difference: f64,
    /// Its value in both pictures.
    pub values: [[f32; 4]; 2],
}

impl Difference {
    /// Largest absolute difference of all channels.
    pub fn max_abs_all(&self) -> f64 {
        self.max_abs.into_iter().fold(0.0, f64::max)
    }

    /// Root of the mean square difference over all channels.
    pub fn rms_all(&self) -> f64 {
        (self.rms.iter().map(|rms| rms * rms).sum::<f64>() / 4.0).sqrt()
    }

    /// Peak signal-to-noise ratio in dB over all channels, for a peak of 1; infinite for equal pictures.
    pub fn psnr_db(&self) -> f64 {
        -20.0 * self.rms_all().log10()
    }
}

/// Compares two pictures; `tolerance` is the largest difference of a channel that is not counted.
///
/// # Errors
/// `Fault::Input` if their sizes differ or they have no pixels.
pub fn compare(a: &Image, b: &Image, tolerance: f64) -> Result<Difference> {
    let size = |image: &Image| format!("{} x {}", image.width(), image.height());
    if (a.width(), a.height()) != (b.width(), b.height()) || a.pixels().is_empty() {
        return Err(Error::new(Fault::Input, "pictures can only be compared if they have the same size, and pixels")
            .found(size(b))
            .expected(size(a)));
    }
    let mut max_abs = [0.0_f64; 4];
    let mut squares = [0.0_f64; 4];
    let mut pixels_over = 0;
    let mut worst: Option<WorstPixel> = None;
    for (index, (&p, &q)) in a.pixels().iter().zip(b.pixels()).enumerate() {
        let off: [f64; 4] = std::array::from_fn(|c| distance(p[c], q[c]));
        for c in 0..4 {
            max_abs[c] = max_abs[c].max(off[c]);
            squares[c] += off[c] * off[c];
        }
        let difference = off.into_iter().fold(0.0, f64::max);
        // A tolerance that is not a number counts every pixel.
        pixels_over += usize::from(difference > tolerance || tolerance.is_nan());
        if difference > worst.map_or(0.0, |w| w.difference) {
            let (column, row) = (index % a.width(), index / a.width());
            worst = Some(WorstPixel { column, row, difference, values: [p, q] });
        }
    }
    let pixels = a.pixels().len();
    Ok(Difference { max_abs, rms: squares.map(|s| (s / pixels as f64).sqrt()), pixels_over, pixels, worst })
}

/// Per pixel, the largest absolute difference of its channels.
pub(super) fn largest_per_pixel<'a>(a: &'a Image, b: &'a Image) -> impl Iterator<Item = f64> + 'a {
    let largest = |(p, q): (&[f32; 4], &[f32; 4])| p.iter().zip(q).map(|(&x, &y)| distance(x, y)).fold(0.0, f64::max);
    a.pixels().iter().zip(b.pixels()).map(largest)
}

/// Absolute difference; infinite if it is not a number.
fn distance(a: f32, b: f32) -> f64 {
    let off = (f64::from(a) - f64::from(b)).abs();
    if off.is_nan() { f64::INFINITY } else { off }
}

/// Two pictures of smooth and busy parts by formula, for metrics whose values another program has computed.
#[cfg(test)]
fn test_pictures() -> (Image, Image) {
    let (width, height) = (48, 40);
    let pixel = |i: usize, shift: f64| {
        let (x, y) = ((i % width) as f64, (i / width) as f64);
        let wave = |k: f64| 0.5 + 0.45 * (0.09 * k * (x + shift) + 0.05 * y * k).sin();
        let alpha = 0.25 + 0.75 * (x / width as f64);
        let dot = if (x - 20.0).hypot(y - 15.0 - shift) < 4.0 { 0.3 } else { 0.0 };
        [wave(1.0) * alpha, (wave(2.7) - dot).max(0.0) * alpha, wave(5.1) * alpha, alpha - 0.1 * shift]
            .map(|v| v as f32)
    };
    let picture =
        |shift: f64| Image::from_pixels(width, height, (0..width * height).map(|i| pixel(i, shift)).collect());
    (picture(0.0), picture(0.8))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient() -> Image {
        let value = |i: u16| [f32::from(i) / 12.0, 0.5, 0.25, 1.0];
        Image::from_pixels(4, 3, (0..12).map(value).collect())
    }

    #[test]
    fn equal_pictures_do_not_differ() {
        let d = compare(&gradient(), &gradient(), 0.0).unwrap();
        assert_eq!((d.max_abs_all(), d.rms_all(), d.pixels_over, d.worst), (0.0, 0.0, 0, None));
        assert_eq!(d.psnr_db(), f64::INFINITY);
    }

    #[test]
    fn a_difference_in_alpha_alone_is_seen() {
        let mut other = gradient();
        other.pixels_mut()[6][3] -= 1.0 / 255.0;
        let d = compare(&gradient(), &other, 0.5 / 255.0).unwrap();
        assert_eq!(d.max_abs[..3], [0.0; 3], "the colours are equal");
        assert!((d.max_abs[3] - 1.0 / 255.0).abs() < 1e-7, "alpha is off by {}", d.max_abs[3]);
        assert!((d.rms[3] - d.max_abs[3] / 12_f64.sqrt()).abs() < 1e-12, "one of twelve pixels: {}", d.rms[3]);
        assert_eq!(d.pixels_over, 1);
        let worst = d.worst.unwrap();
        assert_eq!((worst.column, worst.row), (2, 1));
        assert_eq!(compare(&gradient(), &other, 1.5 / 255.0).unwrap().pixels_over, 0, "within a larger tolerance");
    }

    #[test]
    fn a_shift_by_one_pixel_is_seen() {
        let mut pixels = gradient().pixels().to_vec();
        pixels.rotate_right(1);
        let d = compare(&gradient(), &Image::from_pixels(4, 3, pixels), 1e-3).unwrap();
        assert_eq!(d.pixels_over, 12, "every pixel of a gradient moved");
        assert!((d.max_abs[0] - 11.0 / 12.0).abs() < 1e-6, "the last pixel came first: {}", d.max_abs[0]);
        assert!(d.psnr_db() < 20.0, "found {} dB", d.psnr_db());
    }

    #[test]
    fn a_nan_is_infinitely_far_even_from_itself() {
        let mut other = gradient();
        other.pixels_mut()[5][1] = f32::NAN;
        for (a, b) in [(&gradient(), &other), (&other, &gradient()), (&other, &other)] {
            let d = compare(a, b, 1e9).unwrap();
            assert_eq!((d.max_abs[1], d.rms_all(), d.pixels_over), (f64::INFINITY, f64::INFINITY, 1));
            assert_eq!(d.worst.map(|w| (w.column, w.row)), Some((1, 1)));
            assert_eq!(d.psnr_db(), f64::NEG_INFINITY);
        }
        assert_eq!(compare(&gradient(), &gradient(), f64::NAN).unwrap().pixels_over, 12, "no tolerance at all");
    }

    #[test]
    fn pictures_of_different_sizes_are_not_compared() {
        let error = compare(&gradient(), &Image::transparent(3, 4), 0.0).unwrap_err();
        assert!(error.to_string().ends_with("found 3 x 4, expected 4 x 3"), "{error}");
        assert!(compare(&Image::transparent(0, 0), &Image::transparent(0, 0), 0.0).is_err(), "no pixels");
    }
}
