//! What shading and the effects of light make of the transfer function's emission at a point of a ray.

use glam::DVec3;

use super::{Light, Ray, Scene};

impl Scene {
    /// The factors `a` and `b` by which the effects of light turn the emission `q` of the transfer function into
    /// `a q + b σ` at a distance from a ray's origin: shading, depth cue, shadows, scattering and fog, in this order. Haze
    /// adds itself after them. A level surface of colour `C` looks `a C + b`.
    ///
    /// `gradient_per_mm` is the gradient of the value there, HU/mm; `transmittance` gives T towards a light in this
    /// direction.
    pub fn factors(
        &self,
        ray: &Ray,
        distance_mm: f64,
        gradient_per_mm: DVec3,
        transmittance: impl Fn(DVec3) -> f64,
    ) -> ([f64; 3], [f64; 3]) {
        let effects = &self.effects;
        let (mut reflected, mut added) = match &self.shading {
            None => ([1.0; 3], [0.0; 3]),
            Some(shading) => {
                let cue =
                    effects.depth_cue.map_or(1.0, |cue| cue.factor(distance_mm * self.depth_per_mm(ray.direction)));
                shading.factors_dimmed(gradient_per_mm, ray.direction, |light| {
                    match (shading.lights[light], effects.shadows) {
                        (Light::Directional { towards, .. }, Some(s)) => cue * s.visibility(transmittance(towards)),
                        _ => cue,
                    }
                })
            }
        };
        if let Some(scattering) = &effects.scattering {
            let absorbed = 1.0 - scattering.albedo;
            reflected = reflected.map(|x| absorbed * x);
            added = added.map(|x| absorbed * x);
            for ((towards, _), phase) in scattering.lights.iter().zip(scattering.phases(ray.direction)) {
                let scattered = scattering.albedo * transmittance(*towards);
                for (sum, p) in reflected.iter_mut().zip(phase) {
                    *sum += scattered * p;
                }
            }
        }
        if let Some(fog) = &effects.fog {
            let clear = fog.law.clearness(distance_mm);
            reflected = reflected.map(|x| clear * x);
            added = std::array::from_fn(|c| clear * added[c] + (1.0 - clear) * fog.color[c]);
        }
        (reflected, added)
    }

    /// How fast the distance from the picture plane grows along a ray of this direction: the cosine to the line of sight.
    pub fn depth_per_mm(&self, ray_direction: DVec3) -> f64 {
        ray_direction.dot(self.camera.forward()).max(0.0)
    }

    /// The directions towards all lights whose transmittance an effect reads, LPS, each once.
    pub fn occluded_directions(&self) -> Vec<DVec3> {
        let effects = &self.effects;
        let shaded = self.shading.iter().filter(|_| effects.shadows.is_some()).flat_map(|shading| &shading.lights);
        let shaded = shaded.filter_map(|light| match *light {
            Light::Directional { towards, .. } => Some(towards),
            Light::Headlight { .. } => None,
        });
        let scattered = effects.scattering.iter().flat_map(|s| s.lights.iter().map(|(towards, _)| *towards));
        let mut directions: Vec<DVec3> = Vec::new();
        for towards in shaded.chain(scattered) {
            if !directions.contains(&towards) {
                directions.push(towards);
            }
        }
        directions
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{
        Background, Camera, DepthCue, Effects, Fog, FogLaw, Model, Projection, Scattering, Shading, Shadows,
    };
    use crate::transfer::TransferFunction;

    fn scene(effects: Effects) -> Scene {
        let camera =
            Camera::look_at(DVec3::ZERO, DVec3::X, DVec3::Z, Projection::Perspective { fov_degrees: 90.0 }, [1, 1]);
        let shading = Shading {
            ambient: 0.25,
            diffuse: 0.5,
            specular: 1.0,
            shininess: 1.0,
            two_sided: true,
            soft_gradient_per_mm: 0.0,
            lights: vec![
                Light::Headlight { color: [1.0; 3] },
                Light::Directional { towards: -DVec3::X, color: [1.0, 0.0, 0.0] },
            ],
        };
        Scene {
            model: Model::Light,
            transfer_function: TransferFunction::new([0.0, 1.0], 1.0, vec![]).unwrap(),
            shading: Some(shading),
            camera: camera.unwrap(),
            background: Background::Transparent,
            effects,
        }
    }

    const RAY: Ray = Ray { origin_mm: DVec3::ZERO, direction: DVec3::X };

    /// At 100 mm on the central ray, facing both lights, half of the directional one let through.
    fn factors(effects: Effects) -> ([f64; 3], [f64; 3]) {
        scene(effects).factors(&RAY, 100.0, DVec3::X, |_| 0.5)
    }

    #[test]
    fn without_effects_it_is_shading_alone() {
        let plain = scene(Effects::default());
        let expected = plain.shading.as_ref().unwrap().factors(DVec3::X, DVec3::X);
        assert_eq!(factors(Effects::default()), expected);
        assert!(plain.occluded_directions().is_empty(), "no transmittance is read");
    }

    #[test]
    fn each_effect_changes_its_own_terms() {
        let cue = Some(DepthCue { constant: 1.0, per_mm: 0.01 });
        let cued = factors(Effects { depth_cue: cue, ..Effects::default() });
        assert_eq!(cued, ([0.75, 0.5, 0.5], [1.0, 0.5, 0.5]), "half of the lit terms, all of the ambient one");
        let shadowed = factors(Effects { shadows: Some(Shadows { strength: 1.0 }), ..Effects::default() });
        assert_eq!(shadowed, ([1.0, 0.75, 0.75], [1.5, 1.0, 1.0]), "half of the directional light");
        let law = FogLaw::Linear { start_mm: 0.0, end_mm: 200.0 };
        let fogged = factors(Effects { fog: Some(Fog { law, color: [0.0, 1.0, 0.5] }), ..Effects::default() });
        assert_eq!(fogged, ([0.625, 0.375, 0.375], [1.0, 1.0, 0.75]), "half of it is fog");
        let lights = vec![(DVec3::Y, [1.0, 0.5, 0.0])];
        let scattering = Some(Scattering { albedo: 0.5, anisotropy: 0.0, lights });
        let (reflected, _) = factors(Effects { scattering, ..Effects::default() });
        let expected = [0.5 * 1.25 + 0.25, 0.5 * 0.75 + 0.125, 0.5 * 0.75];
        assert!(
            reflected.iter().zip(expected).all(|(x, e)| (x - e).abs() < 1e-15),
            "found {reflected:?}, expected {expected:?}"
        );
    }

    #[test]
    fn a_light_that_two_effects_share_is_one_direction() {
        let lights = vec![(-DVec3::X, [1.0; 3]), (DVec3::Y, [1.0; 3])];
        let scattering = Some(Scattering { albedo: 0.5, anisotropy: 0.3, lights });
        let both = scene(Effects { shadows: Some(Shadows { strength: 1.0 }), scattering, ..Effects::default() });
        assert_eq!(both.occluded_directions(), [-DVec3::X, DVec3::Y]);
    }

    #[test]
    fn depth_is_counted_across_the_picture_plane() {
        let found = scene(Effects::default()).depth_per_mm(DVec3::new(0.6, 0.8, 0.0));
        assert!((found - 0.6).abs() < 1e-15, "found {found}");
    }
}
