//! Light scattered once on its way from a light to the eye.

use glam::DVec3;

use crate::math::scattering::henyey_greenstein;

/// Single scattering by a Henyey-Greenstein phase function.
///
/// **Definition** (Max 1995). Of what is extinguished the share `albedo` is scattered, in the transfer function's own colour, and the
/// rest absorbed. With the emission `q` of the transfer function, `q_shaded` after shading, the directional lights `l` of
/// colours `L_l`, and `V_l` their visibility as in [`Shadows`](super::Shadows) of full strength:
///
/// ```text
/// q′ = (1 − albedo) q_shaded  +  albedo · q · Σ_l  4π p(cos θ_l) L_l V_l
/// ```
///
/// `θ_l` is the angle by which light from `l` turns towards the eye, and `p` integrates to 1 over the sphere, so that an
/// isotropic medium of white albedo 1 in light of colour 1 emits `σ` where nothing shades it.
#[derive(Debug, Clone, PartialEq)]
pub struct Scattering {
    /// Share of the extinction that scatters, 0 to 1.
    pub albedo: f64,
    /// Mean cosine of the angle by which light turns, between -1 (back) and 1 (on).
    pub anisotropy: f64,
    /// Directions towards the lights, unit vectors in LPS, and their linear RGB colours.
    pub lights: Vec<(DVec3, [f64; 3])>,
}

impl Scattering {
    /// Per light: `4π p(cos θ) L` on a ray of this direction, which is constant along the ray.
    pub fn phases(&self, ray_direction: DVec3) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.lights.iter().map(move |(towards, color)| {
            // Light travels along −towards, and on to the eye along −ray_direction.
            let cosine = towards.dot(ray_direction).clamp(-1.0, 1.0);
            let phase = 4.0 * std::f64::consts::PI * henyey_greenstein(self.anisotropy, cosine);
            color.map(|c| c * phase)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forward_scattering_is_brightest_against_the_light() {
        let scattering =
            |anisotropy| Scattering { albedo: 1.0, anisotropy, lights: vec![(DVec3::X, [1.0, 0.5, 0.25])] };
        let phase = |g: f64, direction| scattering(g).phases(direction).next().expect("one light");
        // Looking along +x is looking into a light that stands at +x.
        let [into, away] = [DVec3::X, -DVec3::X].map(|d| phase(0.5, d)[0]);
        assert!((into - 6.0).abs() < 1e-12, "(1 − g²)/(1 − g)³ = 6, found {into}");
        assert!((away - 0.75 / 3.375).abs() < 1e-12, "(1 − g²)/(1 + g)³, found {away}");
        assert_eq!(phase(0.0, DVec3::Y), [1.0, 0.5, 0.25], "isotropic light of colour 1 scatters as 1");
    }
}
