//! The volume rendering integral over a piece along which emission and extinction follow one value.
//!
//! Between the knots of a transfer function of the value alone, `σ = α_σ + β_σ d` and `q_c = α_c + β_c d` for a polynomial `d` of the ray
//! parameter: how far the value lies from a knot. Then the `G` of [`piece`](super::piece) is the same for every channel but for a
//! factor,
//!
//! ```text
//! G_c(t) = σ̄ ∫₀^t q_c − q̄_c ∫₀^t σ  =  κ_c (D(t) − d̄ t),      κ_c = α_σ β_c − α_c β_σ,   D(t) = ∫₀^t d,
//! ```
//!
//! so that its range is sought once, and is 0 where the colour `q_c/σ` does not change with the value.

use super::piece::{Integral, Optics};
use crate::math::bernstein::{Cubic, sum};
use crate::math::{Number, each};

/// Emission in red, green and blue, and extinction, 1/mm: linear functions of one cubic along a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Linear<R> {
    /// `d`, in Bernstein form.
    pub(super) distance: Cubic<R>,
    /// `α` and `β`, extinction last.
    pub(super) low: [R; 4],
    pub(super) slope: [R; 4],
    /// `κ` of red, green and blue, and the largest of their sizes.
    pub(super) drift: [R; 3],
    pub(super) largest_drift: R,
}

/// `κ` of red, green and blue, and the largest of their sizes, for such functions.
pub(super) fn drift(low: &[f32; 4], slope: &[f32; 4]) -> ([f32; 3], f32) {
    let (low, slope) = (low.map(f64::from), slope.map(f64::from));
    let drift: [f64; 3] = std::array::from_fn(|c| low[3] * slope[c] - low[c] * slope[3]);
    let largest = drift.iter().fold(0.0, |most: f64, k| most.max(k.abs()));
    (drift.map(|k| k as f32), largest as f32)
}

impl<R: Number> Linear<R> {
    /// Mean of `d`.
    #[inline(always)]
    pub(super) fn mean_distance(&self) -> R {
        R::from_f64(0.25) * sum(&self.distance)
    }

    /// Emission or extinction at a distance.
    #[inline(always)]
    pub(super) fn at(&self, component: usize, distance: R) -> R {
        self.slope[component].mul_plus(distance, self.low[component])
    }

    /// The integral over a piece of this length.
    #[inline(always)]
    pub(super) fn integrate(&self, length_mm: R) -> Integral<R> {
        let mean = self.mean_distance();
        let depth = length_mm * self.at(3, mean).max(R::ZERO);
        let (absorbed, m) = depth.absorbed_and_mean_transmittance();
        // D − d̄ t at the coefficients between its ends, where it is 0.
        let (mut low, mut high, mut at) = (R::ZERO, R::ZERO, R::ZERO);
        for k in 0..3 {
            at += self.distance[k] - mean;
            low = low.min(at);
            high = high.max(at);
        }
        // Half, over the number of coefficients.
        let scale = R::from_f64(0.125) * (length_mm * length_mm);
        let middle = scale * (high + low);
        let radiance = each(
            #[inline(always)]
            |c| m * length_mm.mul_plus(self.at(c, mean), self.drift[c] * middle),
        );
        let error = m * (self.largest_drift * (scale * (high - low)));
        Integral { absorbed, radiance, error }
    }

    /// The same as polynomials.
    #[inline(always)]
    pub(super) fn optics(&self) -> Optics<R, 4> {
        let [red, green, blue, extinction]: [Cubic<R>; 4] = each(
            #[inline(always)]
            |c| {
                each(
                    #[inline(always)]
                    |k| self.slope[c].mul_plus(self.distance[k], self.low[c]),
                )
            },
        );
        Optics { emission: [red, green, blue], extinction }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(low: [f32; 4], slope: [f32; 4], distance: [f64; 4]) -> Linear<f64> {
        let (drift, largest_drift) = drift(&low, &slope);
        Linear {
            distance,
            low: low.map(f64::from),
            slope: slope.map(f64::from),
            drift: drift.map(f64::from),
            largest_drift: f64::from(largest_drift),
        }
    }

    #[test]
    fn it_is_the_integral_of_the_polynomials_and_has_its_bound() {
        let distances = [[0.0, 3.0, 1.0, 5.0], [4.0, 0.5, 0.2, 6.0], [2.0; 4], [1e-3, 2e-3, 9.0, 0.0]];
        for (n, distance) in distances.into_iter().enumerate() {
            for length_mm in [1e-4, 0.3, 20.0] {
                let linear = linear([0.01, 0.2, 0.0, 0.1], [0.03, -0.02, 0.0, 0.4], distance);
                let (found, expected) = (linear.integrate(length_mm), linear.optics().integrate(length_mm));
                let apart = |a: f64, b: f64| (a - b).abs() <= 1e-6 * expected.absorbed.max(1e-12);
                assert!(apart(found.absorbed, expected.absorbed), "{n}: {found:?}, expected {expected:?}");
                assert!(apart(found.error, expected.error), "{n}: {found:?}, expected {expected:?}");
                for c in 0..3 {
                    assert!(apart(found.radiance[c], expected.radiance[c]), "{n}: {found:?}, expected {expected:?}");
                }
            }
        }
    }

    #[test]
    fn a_color_that_does_not_change_has_no_error() {
        let of_one_color = linear([0.05, 0.1, 0.0, 0.1], [0.2, 0.4, 0.0, 0.4], [0.0, 3.0, 1.0, 5.0]);
        assert!(of_one_color.integrate(20.0).error < 1e-7, "found {}", of_one_color.integrate(20.0).error);
        let of_two = linear([0.05, 0.1, 0.0, 0.1], [0.2, 0.2, 0.0, 0.4], [0.0, 3.0, 1.0, 5.0]);
        assert!(of_two.integrate(20.0).error > 1e-3, "found {}", of_two.integrate(20.0).error);
    }
}
