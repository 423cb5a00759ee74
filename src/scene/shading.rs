//! Levoy's gradient shading with the Blinn-Phong reflection, exact in f64.

use glam::DVec3;

/// Light that arrives from one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// At the eye: it shines along each ray.
    Headlight {
        /// Linear RGB intensity.
        color: [f64; 3],
    },
    /// Infinitely far away.
    Directional {
        /// Unit vector from the patient *towards* the light, LPS.
        towards: DVec3,
        /// Linear RGB intensity.
        color: [f64; 3],
    },
}

/// Shading of what the transfer function shows, by the gradient of the value.
///
/// **Definition** (Levoy 1988; Blinn 1977). With the interpolated central-difference gradient `g` (HU/mm), the unit
/// vectors `l` towards a light and `h` halfway between `l` and the eye, and `w = |g|² / (|g|² + g₀²)`:
///
/// ```text
/// D = w · d(n·l),  S = w · d(n·h)^shininess      n = −g/|g|;  d(x) = |x| two-sided, max(x, 0) one-sided
/// q_shaded = q · (ambient + diffuse · Σ_lights color · D)  +  σ · specular · Σ_lights color · S
/// ```
///
/// `S` is 0 where a one-sided `n·l` is not above 0. `w` fades the lit terms out where the gradient vanishes and its
/// direction means nothing; `g₀ = 0` switches the fade off, and then a gradient of exactly 0 leaves the ambient term
/// alone. The light is not attenuated on its way to the point, unless [`Shadows`](super::Shadows) say so.
#[derive(Debug, Clone, PartialEq)]
pub struct Shading {
    /// Share of the colour seen without any light.
    pub ambient: f64,
    /// Share of the colour that follows Lambert's cosine law.
    pub diffuse: f64,
    /// Strength of the highlight, in the light's colour.
    pub specular: f64,
    /// Exponent of the highlight, at least 1.
    pub shininess: f64,
    /// Light both sides of a surface alike.
    pub two_sided: bool,
    /// g₀, HU/mm: at this gradient magnitude shading has half its strength; 0 for none of this fade.
    pub soft_gradient_per_mm: f64,
    /// The lights.
    pub lights: Vec<Light>,
}

impl Shading {
    /// Per light, in order: the unit vector towards it, the half vector, and its colour, for a ray of this direction.
    /// All three are constant along a ray.
    pub fn directions(&self, ray_direction: DVec3) -> impl Iterator<Item = (DVec3, DVec3, [f64; 3])> + '_ {
        let to_eye = -ray_direction;
        self.lights.iter().map(move |light| match *light {
            Light::Headlight { color } => (to_eye, to_eye, color),
            Light::Directional { towards, color } => {
                // Light from straight behind has no half vector; any vector across the ray is the limit of some.
                let half = (towards + to_eye).try_normalize().unwrap_or_else(|| to_eye.any_orthonormal_vector());
                (towards, half, color)
            }
        })
    }

    /// Whether anything is lit; if not, no gradient is read and the emission is only scaled.
    pub fn is_lit(&self) -> bool {
        self.diffuse != 0.0 || self.specular != 0.0
    }

    /// The largest values that the two factors of the definition can take in any channel: of the emission, and of the
    /// extinction.
    pub fn largest_factors(&self) -> (f64, f64) {
        let light: [f64; 3] = self.lights.iter().fold([0.0; 3], |sum, light| {
            let (Light::Headlight { color } | Light::Directional { color, .. }) = light;
            std::array::from_fn(|c| sum[c] + color[c])
        });
        let brightest = light.into_iter().fold(0.0, f64::max);
        (self.ambient + self.diffuse * brightest, self.specular * brightest)
    }

    /// The factors of the definition at a gradient `g` (HU/mm) on a ray of this direction:
    /// `(ambient + diffuse · Σ color · D, specular · Σ color · S)`, each linear RGB.
    pub fn factors(&self, gradient_per_mm: DVec3, ray_direction: DVec3) -> ([f64; 3], [f64; 3]) {
        self.factors_dimmed(gradient_per_mm, ray_direction, |_| 1.0)
    }

    /// The same with the terms of each light, given by its index, multiplied by a share of its own.
    pub fn factors_dimmed(
        &self,
        gradient_per_mm: DVec3,
        ray_direction: DVec3,
        share: impl Fn(usize) -> f64,
    ) -> ([f64; 3], [f64; 3]) {
        let mut reflected = [self.ambient; 3];
        let mut highlight = [0.0; 3];
        let square = gradient_per_mm.length_squared();
        if square == 0.0 {
            return (reflected, highlight);
        }
        let fade = square / (square + self.soft_gradient_per_mm * self.soft_gradient_per_mm);
        let normal = -gradient_per_mm / square.sqrt();
        for (light, (towards, half, color)) in self.directions(ray_direction).enumerate() {
            let fade = fade * share(light);
            let facing = normal.dot(towards);
            let lit = if self.two_sided { facing.abs() } else { facing.max(0.0) };
            let shine = normal.dot(half);
            // Clamped before the power: a negative base has no real power.
            let shine = if self.two_sided { shine.abs() } else { shine.max(0.0) };
            let gloss = if lit > 0.0 { shine.powf(self.shininess) } else { 0.0 };
            for c in 0..3 {
                reflected[c] += self.diffuse * color[c] * fade * lit;
                highlight[c] += self.specular * color[c] * fade * gloss;
            }
        }
        (reflected, highlight)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headlit(two_sided: bool) -> Shading {
        Shading {
            ambient: 0.1,
            diffuse: 0.7,
            specular: 0.2,
            shininess: 10.0,
            two_sided,
            soft_gradient_per_mm: 0.0,
            lights: vec![Light::Headlight { color: [1.0; 3] }],
        }
    }

    #[test]
    fn facing_the_light_gives_all_of_each_term() {
        // The ray goes along +x and meets something denser: the gradient is +x, the normal -x, towards the eye.
        let (reflected, highlight) = headlit(false).factors(DVec3::X * 100.0, DVec3::X);
        assert!(
            (reflected[0] - 0.8).abs() < 1e-15 && (highlight[0] - 0.2).abs() < 1e-15,
            "{reflected:?} {highlight:?}"
        );
    }

    #[test]
    fn the_back_of_a_surface_is_lit_only_when_two_sided() {
        let away = DVec3::X * -100.0;
        assert_eq!(headlit(false).factors(away, DVec3::X), ([0.1; 3], [0.0; 3]));
        assert!(headlit(true).factors(away, DVec3::X).0[0] > 0.79);
    }

    #[test]
    fn no_gradient_leaves_the_ambient_term() {
        assert_eq!(headlit(true).factors(DVec3::ZERO, DVec3::X), ([0.1; 3], [0.0; 3]));
    }

    #[test]
    fn the_fade_halves_the_lit_terms_at_its_gradient() {
        let mut shading = headlit(true);
        shading.soft_gradient_per_mm = 50.0;
        let (reflected, _) = shading.factors(DVec3::X * 50.0, DVec3::X);
        assert!((reflected[0] - 0.45).abs() < 1e-15, "found {}", reflected[0]);
    }
}
