//! Closed forms of single scattering, stable where the textbook forms cancel: the truth for scattering effects.

use std::f64::consts::PI;

/// Light that a homogeneous slab of optical depth `depth` scatters once, isotropically, and lets through: radiance per unit
/// of incident flux at `cos_out` (μ) for light that enters at `cos_in` (μ₀), cosines to the slab's normal, both above 0
/// (Chandrasekhar 1960).
///
/// The textbook form `ω μ₀/(4π(μ₀−μ)) (e^{−τ/μ₀} − e^{−τ/μ})` is 0/0 at `μ = μ₀`. With `x = τ/μ − τ/μ₀` it is
/// `ω τ/(4π μ) e^{−τ/μ₀} (1 − e^{−x})/x`, whose last factor is smooth through `x = 0`.
pub fn slab_transmitted(albedo: f64, depth: f64, cos_out: f64, cos_in: f64) -> f64 {
    let x = depth * (cos_in - cos_out) / (cos_in * cos_out);
    let factor = if x.abs() < 1e-9 { 1.0 - 0.5 * x } else { -(-x).exp_m1() / x };
    albedo * depth / (4.0 * PI * cos_out) * (-depth / cos_in).exp() * factor
}

/// The same for light that comes back: `ω μ₀/(4π(μ+μ₀)) (1 − e^{−τ(1/μ+1/μ₀)})`.
pub fn slab_reflected(albedo: f64, depth: f64, cos_out: f64, cos_in: f64) -> f64 {
    let twice = depth * (1.0 / cos_out + 1.0 / cos_in);
    -albedo * cos_in / (4.0 * PI * (cos_in + cos_out)) * (-twice).exp_m1()
}

/// Henyey and Greenstein's phase function (1941) of the cosine between the directions before and after, 1/sr; `g` in
/// (-1, 1) is its mean cosine.
pub fn henyey_greenstein(g: f64, cosine: f64) -> f64 {
    let square = 1.0 + g * g - 2.0 * g * cosine;
    (1.0 - g * g) / (4.0 * PI * square * square.sqrt())
}

/// The cosine below which the phase function has the share `u` of its weight, for `u` in `[0, 1]`.
///
/// The textbook form divides a difference that vanishes with `g` by `2g`. With `s = 2u − 1` the division can be carried out:
/// `(2s + g(s²+3) + 2g²s + g³(s²−1)) / (2(1+gs)²)`, which is `s` at `g = 0`.
pub fn henyey_greenstein_cosine(g: f64, u: f64) -> f64 {
    let s = 2.0 * u - 1.0;
    let numerator = 2.0 * s + g * (s * s + 3.0) + 2.0 * g * g * s + g * g * g * (s * s - 1.0);
    let root = 1.0 + g * s;
    numerator / (2.0 * root * root)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_let_through_is_smooth_where_the_angles_meet() {
        let textbook = |mu: f64, mu0: f64, t: f64| mu0 / (4.0 * PI * (mu0 - mu)) * ((-t / mu0).exp() - (-t / mu).exp());
        for (mu, mu0, t) in [(0.3, 0.9, 2.0), (0.9, 0.3, 2.0), (0.5, 0.500_1, 1e-3), (1.0, 0.2, 30.0)] {
            let (found, expected) = (slab_transmitted(1.0, t, mu, mu0), textbook(mu, mu0, t));
            assert!((found / expected - 1.0).abs() < 1e-9, "({mu}, {mu0}, {t}): found {found}, expected {expected}");
        }
        let limit = 2.0 / (4.0 * PI * 0.5) * (-4.0f64).exp();
        for apart in [0.0, 1e-16, 1e-12, 1e-9, -1e-9] {
            let found = slab_transmitted(1.0, 2.0, 0.5, 0.5 + apart);
            assert!((found / limit - 1.0).abs() < 1e-7, "angles {apart:e} apart: found {found}, the limit is {limit}");
        }
        assert!(slab_reflected(1.0, 1e-12, 0.5, 0.5) > 0.0, "a thin slab keeps its digits");
    }

    #[test]
    fn the_phase_function_is_stable_as_it_becomes_isotropic() {
        for g in [0.0, 1e-300, 1e-17, 1e-9, -1e-5, 0.3, -0.9, 0.99] {
            let n = 20_000;
            let cosines = (0..n).map(|i| henyey_greenstein_cosine(g, (f64::from(i) + 0.5) / f64::from(n)));
            let mean = cosines.clone().sum::<f64>() / f64::from(n);
            assert!((mean - g).abs() < 1e-4, "g {g:e}: the mean cosine is {mean}");
            assert!(cosines.into_iter().all(|c| (-1.0..=1.0).contains(&c)), "g {g:e}: cosines of angles");
            // Equal shares of u hold equal weight: p dcos du/dcos = 1/(2·2π) · …, by a difference quotient.
            let (u, h) = (0.37, 1e-6);
            let width = henyey_greenstein_cosine(g, u + h) - henyey_greenstein_cosine(g, u - h);
            let weight = 2.0 * PI * henyey_greenstein(g, henyey_greenstein_cosine(g, u)) * width;
            assert!((weight / (2.0 * h) - 1.0).abs() < 1e-6, "g {g:e}: density {}", weight / (2.0 * h));
        }
    }
}
