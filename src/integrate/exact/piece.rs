//! The volume rendering integral over one piece, with a bound on its error.
//!
//! On a piece of length `w` between knots, `σ` and `q` are polynomials of the ray parameter. With the optical depth
//! `τ = ∫σ`, the emission `Q = ∫q` and the mean colour `c̄ = Q/τ`, let `h = q − c̄σ` and `H(t) = ∫₀^t h`, so that
//! `H(0) = H(w) = 0`. Integration by parts gives, exactly,
//!
//! ```text
//! ∫ q e^{−τ(t)} dt  =  c̄ A  +  ∫ H σ e^{−τ(t)} dt,       A = 1 − e^{−τ}.
//! ```
//!
//! `H` is a polynomial too, and lies between the smallest and largest of its Bernstein coefficients; `σ e^{−τ}` integrates
//! to `A`. With the middle `H_mid` and half-width `H_rad` of that range:
//!
//! ```text
//! ∫ q e^{−τ(t)} dt  =  (c̄ + H_mid) A  ±  H_rad A.
//! ```
//!
//! The bound is proven, needs no ratio `q/σ`, vanishes for a constant colour at any depth, and shrinks with the cube of the
//! piece's length. Since front-to-back weights satisfy `Σ T A ≤ 1`, pieces that keep `H_rad ≤ ε` keep a whole ray within
//! `ε`. To allow emission without extinction everything is multiplied by `τ`: with `m = A/τ` (1 at `τ = 0`) and `G = τH`,
//! the integral is `m (Q + G_mid) ± m G_rad`.

use crate::math::bernstein::{sum, times_linear};
use crate::math::{Number, each};
use crate::simd::Lanes;

/// Emission and extinction along a piece: polynomials in Bernstein form with `N` coefficients, 1/mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Optics<R, const N: usize> {
    pub(super) emission: [[R; N]; 3],
    pub(super) extinction: [R; N],
}

/// What a piece does to light.
#[derive(Debug, Clone, Copy)]
pub(super) struct Integral<R> {
    /// `1 − e^{−τ}`.
    pub(super) absorbed: R,
    /// Light towards the eye at the front of the piece, linear RGB.
    pub(super) radiance: [R; 3],
    /// Largest error of a channel of `radiance`.
    pub(super) error: R,
}

impl<L: Lanes> Integral<L> {
    /// Of nothing.
    #[inline(always)]
    pub(super) fn nothing() -> Self {
        Integral { absorbed: L::ZERO, radiance: [L::ZERO; 3], error: L::ZERO }
    }

    /// What a piece and the one behind it do.
    #[inline(always)]
    pub(super) fn followed_by(&self, next: &Self) -> Self {
        let transmittance = L::ONE - self.absorbed;
        Integral {
            absorbed: transmittance.mul_plus(next.absorbed, self.absorbed),
            radiance: each(
                #[inline(always)]
                |c| transmittance.mul_plus(next.radiance[c], self.radiance[c]),
            ),
            error: transmittance.mul_plus(next.error, self.error),
        }
    }

    /// Makes nothing of some lanes' pieces.
    #[inline(always)]
    pub(super) fn forget(&mut self, lanes: L::Mask) {
        self.forget_light(lanes);
        self.absorbed = L::select(lanes, L::ZERO, self.absorbed);
    }

    /// Leaves of some lanes' pieces what they absorb.
    #[inline(always)]
    pub(super) fn forget_light(&mut self, lanes: L::Mask) {
        for number in self.radiance.iter_mut().chain([&mut self.error]) {
            *number = L::select(lanes, L::ZERO, *number);
        }
    }
}

/// Shading along a piece: factors between linear functions of the piece's parameter, within an error.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinearFactors<R> {
    /// Factor of the emission at the front and the back.
    pub(super) reflected: [[R; 3]; 2],
    /// Factor of the extinction that adds emission, at the front and the back.
    pub(super) highlight: [[R; 3]; 2],
    /// Largest distance of the true factor of emission from the linear one.
    pub(super) reflected_error: R,
    /// Largest distance of the true factor of extinction from the linear one.
    pub(super) highlight_error: R,
}

impl<R: Number, const N: usize> Optics<R, N> {
    /// The integral over a piece of this length.
    #[inline(always)]
    pub(super) fn integrate(&self, length_mm: R) -> Integral<R> {
        let share = R::from_f64(1.0 / N as f64);
        // A rounded or overshooting coefficient may take a vanishing extinction below 0.
        let sigma = (share * sum(&self.extinction)).max(R::ZERO);
        let depth = length_mm * sigma;
        let (absorbed, m) = depth.absorbed_and_mean_transmittance();
        let scale = length_mm * length_mm * share;
        let mut error = R::ZERO;
        let radiance = each(
            #[inline(always)]
            |c| {
                let q = &self.emission[c];
                let mean = share * sum(q);
                // G at the coefficients between its ends, where it is 0.
                let (mut low, mut high, mut g) = (R::ZERO, R::ZERO, R::ZERO);
                for (&q, &s) in q.iter().zip(&self.extinction).take(N - 1) {
                    g = sigma.mul_plus(q, g).minus_product(mean, s);
                    low = low.min(g);
                    high = high.max(g);
                }
                let half = R::from_f64(0.5) * scale;
                error = error.max(half * (high - low));
                length_mm.mul_plus(mean, half * (high + low))
            },
        );
        let [r, g, b]: [R; 3] = radiance;
        Integral { absorbed, radiance: [m * r, m * g, m * b], error: m * error }
    }

    /// Emission with shading between `factors`' linear functions; `M` must be `N + 1`.
    #[inline(always)]
    pub(super) fn shaded<const M: usize>(&self, factors: &LinearFactors<R>) -> Optics<R, M> {
        let [front, back] = &factors.reflected;
        let [shine_front, shine_back] = &factors.highlight;
        let emission = each(
            #[inline(always)]
            |c| {
                let reflected: [R; M] = times_linear(&self.emission[c], front[c], back[c]);
                let highlight: [R; M] = times_linear(&self.extinction, shine_front[c], shine_back[c]);
                each(
                    #[inline(always)]
                    |k| reflected[k] + highlight[k],
                )
            },
        );
        Optics { emission, extinction: times_linear(&self.extinction, R::ONE, R::ONE) }
    }

    /// The integral over a piece of this length, shaded. `largest_color` bounds `q/σ`, or is infinite.
    #[inline(always)]
    pub(super) fn integrate_shaded<const M: usize>(
        &self,
        length_mm: R,
        factors: &LinearFactors<R>,
        largest_color: R,
    ) -> Integral<R> {
        self.with_factor_errors(self.shaded::<M>(factors).integrate(length_mm), length_mm, factors, largest_color)
    }

    /// The same in a homogeneous medium that adds emission and extinction of its own, unshaded.
    pub(super) fn integrate_in_medium<const M: usize>(
        &self,
        length_mm: R,
        factors: &LinearFactors<R>,
        largest_color: R,
        emission: [R; 3],
        extinction: R,
    ) -> Integral<R> {
        let mut optics = self.shaded::<M>(factors);
        for (q, more) in optics.emission.iter_mut().zip(emission) {
            *q = q.map(|q| q + more);
        }
        optics.extinction = optics.extinction.map(|s| s + extinction);
        self.with_factor_errors(optics.integrate(length_mm), length_mm, factors, largest_color)
    }

    /// An integral with what the errors of factors may have added to it.
    #[inline(always)]
    fn with_factor_errors(
        &self,
        mut integral: Integral<R>,
        length_mm: R,
        factors: &LinearFactors<R>,
        largest_color: R,
    ) -> Integral<R> {
        // ∫q e^{−τ} is at most ∫q, and at most the largest colour times A.
        let n = R::from_f64(N as f64);
        let emitted = self.emission.iter().fold(R::ZERO, |most, q| most.max(length_mm * sum(q) / n));
        let reflecting = emitted.min(largest_color * integral.absorbed);
        integral.error += factors.reflected_error * reflecting + factors.highlight_error * integral.absorbed;
        integral
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ q e^{−τ} by a fine midpoint rule on Bernstein cubics.
    fn truth(piece: &Optics<f64, 4>, w: f64) -> [f64; 3] {
        use crate::math::bernstein::value;
        let steps = 200_000;
        let dt = w / f64::from(steps);
        let (mut depth, mut light) = (0.0, [0.0; 3]);
        for i in 0..steps {
            let u = (f64::from(i) + 0.5) / f64::from(steps);
            let sigma = value(&piece.extinction, u);
            for (c, light) in light.iter_mut().enumerate() {
                *light += value(&piece.emission[c], u) * (-(depth + 0.5 * sigma * dt)).exp() * dt;
            }
            depth += sigma * dt;
        }
        light
    }

    fn piece(scale: f64) -> Optics<f64, 4> {
        let extinction = [0.2, 0.9, 0.4, 1.5].map(|x| x * scale);
        let emission =
            [[0.2, 0.1, 0.4, 0.1], [0.0, 0.3, 0.3, 1.4], [0.1, 0.45, 0.2, 0.75]].map(|q| q.map(|x| x * scale));
        Optics { emission, extinction }
    }

    #[test]
    fn the_integral_is_within_its_bound_at_any_depth() {
        for scale in [1e-6, 1e-2, 0.3, 1.0, 5.0, 40.0] {
            let p = piece(scale);
            let found = p.integrate(2.0);
            let expected = truth(&p, 2.0);
            for (c, (&found_c, expected_c)) in found.radiance.iter().zip(expected).enumerate() {
                let miss = (found_c - expected_c).abs();
                assert!(
                    miss <= found.error + 1e-9 * scale,
                    "scale {scale}, channel {c}: off by {miss:e}, bound {:e}",
                    found.error
                );
            }
        }
    }

    #[test]
    fn a_constant_color_needs_no_bound() {
        let mut p = piece(3.0);
        p.emission = [0.25, 0.5, 1.0].map(|c| p.extinction.map(|s| c * s));
        let found = p.integrate(2.0);
        assert!(found.error <= 1e-15, "found a bound of {:e}", found.error);
        assert!((found.radiance[1] - 0.5 * found.absorbed).abs() < 1e-15);
    }

    #[test]
    fn emission_without_extinction_is_its_integral() {
        let mut p = piece(1.0);
        p.extinction = [0.0; 4];
        let found = p.integrate(2.0);
        assert!(
            (found.radiance[0] - 2.0 * 0.2).abs() < 1e-15 && found.absorbed == 0.0 && found.error == 0.0,
            "{found:?}"
        );
    }

    #[test]
    fn the_bound_shrinks_with_the_cube_of_the_length() {
        // The same polynomials over a shorter piece vary less; restricting does both.
        use crate::math::bernstein::restrict;
        let p = piece(1.0);
        let part = |w: f64| {
            let cut = |b: &[f64; 4]| restrict(b, 0.3, 0.3 + w);
            Optics { emission: std::array::from_fn(|c| cut(&p.emission[c])), extinction: cut(&p.extinction) }
                .integrate(2.0 * w)
                .error
        };
        let order = (part(0.02) / part(0.01)).log2();
        assert!((order - 3.0).abs() < 0.1, "found order {order}");
    }

    #[test]
    fn shading_that_is_linear_is_exact() {
        let p = piece(1e-7);
        let factors = LinearFactors {
            reflected: [[0.2; 3], [0.8; 3]],
            highlight: [[0.0; 3], [0.1; 3]],
            reflected_error: 0.0,
            highlight_error: 0.0,
        };
        let found = p.integrate_shaded::<5>(2.0, &factors, 10.0);
        // So thin that the integral is that of the emission: ∫ (q (0.2 + 0.6 u) + 0.1 u σ) · 2 du by Simpson's rule, fine.
        let n = 1000;
        let f = |u: f64| {
            use crate::math::bernstein::value;
            value(&p.emission[1], u) * (0.2 + 0.6 * u) + 0.1 * u * value(&p.extinction, u)
        };
        let expected: f64 = (0..n).map(|i| f((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() * 2.0 / f64::from(n);
        assert!((found.radiance[1] / expected - 1.0).abs() < 1e-6, "found {}, expected {expected}", found.radiance[1]);
    }
}
