//! Effects of light at a sample: the definition of [`Scene::factors`] in f32, and haze.

use super::Frame;
use super::light_volumes::{LightVolumes, Transmittances};
use super::shade::{Beam, Course, Lit, Shader, Spot};
use crate::classify::Rgbs;
use crate::field::{Cell, interpolate};
use crate::math::absorbed_f32;
use crate::scene::{FogLaw, Haze, Light, Scene};

/// Shading, depth cue, shadows, scattering, fog and haze.
pub(super) struct Atmosphere<'a> {
    scene: &'a Scene,
    lights: LightVolumes<'a>,
    ambient: f32,
    lit: Option<Lit<'a>>,
    /// For each light of shading, the strength of its shadows and its light volume.
    shadows: Vec<Option<(f32, usize)>>,
    /// Share of the emission that is not scattered light.
    absorbed: f32,
    haze: Option<Haze>,
    /// What haze emits and extinguishes, 1/mm; 0 without haze.
    space: Rgbs<f32>,
}

/// What is constant along a ray.
#[derive(Default)]
pub(super) struct Aim {
    beams: Vec<Beam>,
    /// For each light that is scattered, `albedo · 4π p L`, and its light volume.
    scattered: Vec<([f32; 3], usize)>,
    depth_per_mm: f64,
}

impl<'a> Atmosphere<'a> {
    pub(super) fn new(frame: &Frame<'a>) -> Self {
        let Frame { volume, scene, survey, .. } = *frame;
        let unknown = || Transmittances::unknown(volume, scene);
        let lights = LightVolumes::new(volume, scene, survey.transmittances.get_or_init(unknown));
        let effects = &scene.effects;
        let occluded = |light: &Light| match (*light, effects.shadows) {
            (Light::Directional { towards, .. }, Some(s)) => Some((s.strength as f32, lights.light(towards)?)),
            _ => None,
        };
        let shading = scene.shading.as_ref();
        let space = effects.haze.map_or([0.0; 4], |haze| {
            let [r, g, b] = haze.emission_per_mm();
            [r, g, b, haze.extinction_per_mm].map(|x| x as f32)
        });
        Atmosphere {
            ambient: shading.map_or(1.0, |s| s.ambient as f32),
            lit: shading.filter(|s| s.is_lit()).map(Lit::new),
            shadows: shading.into_iter().flat_map(|s| s.lights.iter().map(occluded)).collect(),
            absorbed: effects.scattering.as_ref().map_or(1.0, |s| (1.0 - s.albedo) as f32),
            haze: effects.haze,
            space,
            scene,
            lights,
        }
    }

    fn transmittance(&self, light: usize, cell: &Cell) -> f32 {
        interpolate(self.lights.corners(light, cell.corner), cell.fraction)
    }
}

impl Shader for Atmosphere<'_> {
    const SHADES: bool = true;
    const NAME: &'static str = "atmosphere";
    type Aim = Aim;

    fn aim(&self, course: &Course, aim: &mut Aim) {
        let direction = course.direction;
        if let Some(lit) = &self.lit {
            lit.aim(course, &mut aim.beams);
        }
        aim.scattered.clear();
        if let Some(s) = &self.scene.effects.scattering {
            let phases = s.phases(direction).map(|phase| phase.map(|p| (s.albedo * p) as f32));
            let lights = s.lights.iter().map(|(towards, _)| self.lights.light(*towards));
            aim.scattered.extend(phases.zip(lights).filter_map(|(phase, light)| Some((phase, light?))));
        }
        aim.depth_per_mm = self.scene.depth_per_mm(direction);
    }

    #[inline]
    fn shade(
        &self,
        aim: &Aim,
        [r, g, b, extinction]: Rgbs<f32>,
        spot: &Spot,
        gradient: impl FnOnce() -> [f32; 3],
    ) -> Rgbs<f32> {
        let effects = &self.scene.effects;
        let (mut reflected, mut added) = ([self.ambient; 3], [0.0; 3]);
        if let Some(lit) = &self.lit {
            let cue = effects.depth_cue.map_or(1.0, |cue| cue.factor(spot.distance_mm * aim.depth_per_mm) as f32);
            (reflected, added) = lit.factors(&aim.beams, gradient(), |light| match self.shadows[light] {
                Some((strength, volume)) => cue * (1.0 - strength * (1.0 - self.transmittance(volume, &spot.cell))),
                None => cue,
            });
        }
        if self.absorbed < 1.0 {
            reflected = reflected.map(|x| self.absorbed * x);
            added = added.map(|x| self.absorbed * x);
            for &(phase, light) in &aim.scattered {
                let t = self.transmittance(light, &spot.cell);
                reflected = std::array::from_fn(|c| reflected[c] + phase[c] * t);
            }
        }
        if let Some(fog) = &effects.fog {
            let clear = clearness(fog.law, spot.distance_mm);
            reflected = reflected.map(|x| clear * x);
            added = std::array::from_fn(|c| clear * added[c] + (1.0 - clear) * fog.color[c] as f32);
        }
        let [hr, hg, hb, haze] = self.space;
        let seen = |q: f32, c: usize| q * reflected[c] + extinction * added[c];
        [seen(r, 0) + hr, seen(g, 1) + hg, seen(b, 2) + hb, extinction + haze]
    }

    #[inline(always)]
    fn space(&self) -> Rgbs<f32> {
        self.space
    }

    #[inline(always)]
    fn haze(&self) -> Option<&Haze> {
        self.haze.as_ref()
    }
}

/// What fog leaves of a colour, by our own exponential, so that pictures do not depend on the system's.
fn clearness(law: FogLaw, distance_mm: f64) -> f32 {
    match law {
        FogLaw::Linear { .. } => law.clearness(distance_mm) as f32,
        FogLaw::Exp { density_per_mm } => 1.0 - absorbed_f32((density_per_mm * distance_mm) as f32),
        FogLaw::Exp2 { density_per_mm } => 1.0 - absorbed_f32((density_per_mm * distance_mm).powi(2) as f32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fog_equals_its_definition() {
        for i in 0..2000 {
            let z = f64::from(i) * 0.7;
            for law in [
                FogLaw::Linear { start_mm: 100.0, end_mm: 900.0 },
                FogLaw::Exp { density_per_mm: 0.004 },
                FogLaw::Exp2 { density_per_mm: 0.002 },
            ] {
                let (found, expected) = (f64::from(clearness(law, z)), law.clearness(z));
                assert!((found - expected).abs() < 3e-7, "{law:?} at {z}: found {found}, expected {expected}");
            }
        }
    }
}
