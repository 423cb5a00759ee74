//! One channel of a picture in f64, and its convolution with separable kernels.

/// One channel of a picture, row by row from the top left.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plane {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) values: Vec<f64>,
}

impl Plane {
    /// `f` of two planes of one size, value by value.
    pub(super) fn combined(&self, other: &Plane, f: impl Fn(f64, f64) -> f64) -> Plane {
        let values = self.values.iter().zip(&other.values).map(|(&a, &b)| f(a, b)).collect();
        Plane { width: self.width, height: self.height, values }
    }

    /// Correlated with the product of two kernels of odd length, across and down; beyond its border the plane goes on as
    /// at the border.
    pub(super) fn filtered(&self, across: &[f64], down: &[f64]) -> Plane {
        let (width, height) = (self.width, self.height);
        let mut rows = Vec::with_capacity(self.values.len());
        for row in self.values.chunks(width) {
            rows.extend((0..width).map(|x| weighted(across, x, width, |i| row[i])));
        }
        let mut values = Vec::with_capacity(self.values.len());
        for y in 0..height {
            values.extend((0..width).map(|x| weighted(down, y, height, |i| rows[i * width + x])));
        }
        Plane { width, height, values }
    }
}

/// The kernel's sum about `center` along a line of `length` values.
fn weighted(kernel: &[f64], center: usize, length: usize, value: impl Fn(usize) -> f64) -> f64 {
    let radius = kernel.len() / 2;
    let place = |k: usize| (center + k).saturating_sub(radius).min(length - 1);
    kernel.iter().enumerate().map(|(k, weight)| weight * value(place(k))).sum()
}

/// `f` at the whole numbers from `-radius` to `radius`.
pub(super) fn kernel(radius: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..=2 * radius).map(|i| f(i as f64 - radius as f64)).collect()
}

/// A Gaussian of this standard deviation in pixels, whose weights add up to 1.
pub(super) fn gaussian(radius: usize, deviation: f64) -> Vec<f64> {
    let mut weights = kernel(radius, |x| (-0.5 * (x / deviation).powi(2)).exp());
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|w| *w /= sum);
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kernel_reads_the_border_again_beyond_it() {
        let plane = Plane { width: 3, height: 2, values: vec![1.0, 2.0, 4.0, 8.0, 16.0, 32.0] };
        let shifted = plane.filtered(&[1.0, 0.0, 0.0], &[1.0]);
        assert_eq!(shifted.values, [1.0, 1.0, 2.0, 8.0, 8.0, 16.0], "each value from its left neighbour");
        let down = plane.filtered(&[1.0], &[0.0, 0.0, 1.0]);
        assert_eq!(down.values, [8.0, 16.0, 32.0, 8.0, 16.0, 32.0], "each value from the one below");
    }

    #[test]
    fn a_gaussian_keeps_what_is_constant() {
        let plane = Plane { width: 4, height: 4, values: vec![0.25; 16] };
        let kernel = gaussian(5, 1.5);
        let off = plane.filtered(&kernel, &kernel).values.iter().map(|v| (v - 0.25).abs()).fold(0.0, f64::max);
        assert!(off < 1e-15, "off by {off:e}");
    }
}
