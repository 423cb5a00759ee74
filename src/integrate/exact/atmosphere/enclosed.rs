//! Functions along a piece, enclosed between lines with a proven error.
//!
//! With `u ∈ [0, 1]` along the piece, `f(u) = (1 − u) f₀ + u f₁ + e(u)` and `|e| ≤ error`. A product of two such functions
//! differs from the line through the products of their ends by at most
//!
//! ```text
//! |Δa Δb|/4  +  e_a max|b|  +  e_b max|a|  +  e_a e_b,      Δa = a₁ − a₀
//! ```
//!
//! since `a(u) b(u)` of two lines lies `u(1 − u) Δa Δb` off the line through its ends.

use crate::math::bernstein::Cubic;
use crate::scene::{DepthCue, FogLaw};

/// A function between a line plus and minus an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Enclosed {
    /// The line at the front and the back of the piece.
    pub(super) ends: [f64; 2],
    /// Largest distance from it.
    pub(super) error: f64,
}

impl Enclosed {
    pub(super) fn constant(x: f64) -> Self {
        Enclosed { ends: [x; 2], error: 0.0 }
    }

    /// A cubic. Its distance from the line has the Bernstein coefficients 0, d₁, d₂, 0, and `B₁ + B₂ = 3u(1 − u) ≤ 3/4`.
    pub(super) fn cubic(c: &Cubic<f64>) -> Self {
        let rise = (c[3] - c[0]) / 3.0;
        let off = (c[1] - (c[0] + rise)).abs().max((c[2] - (c[3] - rise)).abs());
        Enclosed { ends: [c[0], c[3]], error: 0.75 * off }
    }

    /// What fog leaves of a colour between two distances, mm, with no end of linear fog between them.
    pub(super) fn fog(law: FogLaw, [near_mm, far_mm]: [f64; 2]) -> Self {
        let curvature = match law {
            FogLaw::Linear { .. } => 0.0,
            // Both e^{−dz} and its second derivative fall.
            FogLaw::Exp { density_per_mm: d } => d * d * law.clearness(near_mm),
            FogLaw::Exp2 { density_per_mm: d } => 2.0 * d * d * gaussian_bend(d * near_mm, d * far_mm),
        };
        Self::monotone([near_mm, far_mm].map(|z| law.clearness(z)), curvature, far_mm - near_mm)
    }

    /// The depth cue between two depths, mm. It is convex and its second derivative falls.
    pub(super) fn cue(cue: DepthCue, [near_mm, far_mm]: [f64; 2]) -> Self {
        let near = cue.factor(near_mm);
        let curvature = 2.0 * cue.per_mm * cue.per_mm * near * near * near;
        Self::monotone([near, cue.factor(far_mm)], curvature, far_mm - near_mm)
    }

    /// A monotone function with `|f″| ≤ curvature` over a length: it is within `curvature · length²/8` of the line through
    /// its ends, and no farther than they are apart.
    fn monotone(ends: [f64; 2], curvature: f64, length: f64) -> Self {
        let error = (0.125 * curvature * length * length).min((ends[1] - ends[0]).abs());
        Enclosed { ends, error }
    }

    pub(super) fn scaled(self, x: f64) -> Self {
        Enclosed { ends: self.ends.map(|e| e * x), error: self.error * x.abs() }
    }

    pub(super) fn plus(self, other: Enclosed) -> Self {
        let [a, b] = [self.ends, other.ends];
        Enclosed { ends: [a[0] + b[0], a[1] + b[1]], error: self.error + other.error }
    }

    /// `1 − strength · (1 − self)`: the visibility of a light by its transmittance.
    pub(super) fn visibility(self, strength: f64) -> Self {
        Enclosed { ends: self.ends.map(|t| 1.0 - strength * (1.0 - t)), error: strength * self.error }
    }

    pub(super) fn times(self, other: Enclosed) -> Self {
        let [a, b] = [self.ends, other.ends];
        let most = |x: [f64; 2]| x[0].abs().max(x[1].abs());
        let bend = 0.25 * ((a[1] - a[0]) * (b[1] - b[0])).abs();
        let error = bend + self.error * (most(b) + other.error) + other.error * most(a);
        Enclosed { ends: [a[0] * b[0], a[1] * b[1]], error }
    }
}

/// Largest of `|(2x² − 1) e^{−x²}|` between `x₀` and `x₁`, both at least 0. Its derivative `2x(3 − 2x²) e^{−x²}` vanishes at
/// 0 and at √(3/2) only.
fn gaussian_bend(x0: f64, x1: f64) -> f64 {
    let bend = |x: f64| ((2.0 * x * x - 1.0) * (-x * x).exp()).abs();
    let turn = 1.5_f64.sqrt();
    let inner = if x0 < turn && turn < x1 { bend(turn) } else { 0.0 };
    bend(x0).max(bend(x1)).max(inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::bernstein::value;

    /// Pseudo-random numbers in [0, 1).
    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Largest distance of a function from the line, over what the enclosure allows.
    fn of_allowed(enclosed: Enclosed, f: impl Fn(f64) -> f64) -> f64 {
        let [a, b] = enclosed.ends;
        let off = |i: i32| {
            let u = f64::from(i) / 64.0;
            (f(u) - (a + u * (b - a))).abs()
        };
        (0..=64).map(off).fold(0.0, f64::max) / (enclosed.error + 1e-14)
    }

    /// An enclosure, and what it encloses.
    type Case = (Enclosed, Box<dyn Fn(f64) -> f64>);

    /// Random smooth factors of distance, and a cubic.
    fn random_case(seed: &mut u64) -> [Case; 4] {
        let near = 300.0 * random(seed);
        let length = 10f64.powf(3.0 * random(seed) - 1.5);
        let d = 10f64.powf(3.0 * random(seed) - 4.0);
        let at = move |u: f64| near + u * length;
        let ends = [near, near + length];
        let (exp, exp2) = (FogLaw::Exp { density_per_mm: d }, FogLaw::Exp2 { density_per_mm: d });
        let cue = DepthCue { constant: 0.1 + random(seed), per_mm: d };
        let cubic: Cubic<f64> = std::array::from_fn(|_| random(seed));
        [
            (Enclosed::fog(exp, ends), Box::new(move |u| exp.clearness(at(u)))),
            (Enclosed::fog(exp2, ends), Box::new(move |u| exp2.clearness(at(u)))),
            (Enclosed::cue(cue, ends), Box::new(move |u| cue.factor(at(u)))),
            (Enclosed::cubic(&cubic), Box::new(move |u| value(&cubic, u))),
        ]
    }

    #[test]
    fn the_true_functions_are_within_the_enclosure_and_come_near_to_it() {
        let (mut seed, mut tightest) = (11, [0.0f64; 4]);
        for case in 0..5000 {
            for (kind, (enclosed, f)) in random_case(&mut seed).into_iter().enumerate() {
                let ratio = of_allowed(enclosed, f);
                assert!(ratio <= 1.0, "case {case}, function {kind}: {ratio} x what {enclosed:?} allows");
                tightest[kind] = tightest[kind].max(ratio);
            }
        }
        assert!(tightest.iter().all(|t| *t > 0.9), "a bound that is never approached says little: {tightest:?}");
    }

    #[test]
    fn products_sums_and_visibilities_are_within_theirs() {
        let (mut seed, mut tightest) = (5, 0.0f64);
        for case in 0..5000 {
            let [(fog, f), (_, _), (cue, c), (cubic, t)] = random_case(&mut seed);
            let (strength, weight) = (random(&mut seed), random(&mut seed));
            let visible = cubic.visibility(strength);
            let enclosed = cue.times(visible).times(fog).plus(cubic.scaled(-weight));
            let ratio = of_allowed(enclosed, |u| c(u) * (1.0 - strength * (1.0 - t(u))) * f(u) - weight * t(u));
            assert!(ratio <= 1.0, "case {case}: {ratio} x what {enclosed:?} allows");
            tightest = tightest.max(ratio);
        }
        assert!(tightest > 0.5, "a bound that is never approached says little: {tightest}");
    }

    #[test]
    fn linear_fog_between_its_ends_is_exact() {
        let law = FogLaw::Linear { start_mm: 100.0, end_mm: 300.0 };
        assert_eq!(Enclosed::fog(law, [150.0, 250.0]), Enclosed { ends: [0.75, 0.25], error: 0.0 });
    }
}
