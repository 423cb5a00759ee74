//! Effects of light along a ray: depth cue, shadows, scattering, fog and haze, on top of shading.
//!
//! Each effect is a factor that is enclosed between lines over a piece ([`enclosed`]); their sums and products make the
//! factors of emission and extinction, so that the bound of a shaded piece holds for all of them. Haze is a constant that is
//! added to extinction and emission after them, and where it is alone, a slab in closed form.

mod enclosed;
mod kernel;

pub(super) use kernel::Kernel;

use crate::integrate::light_volumes::{LightVolumes, STORED_ERROR};
use crate::math::bernstein::{Cubic, restrict};
use crate::scene::{DepthCue, Fog, FogLaw, Haze, Light, Ray, Scene};

use super::cells::Segment;
use super::lattice::along;
use super::piece::{Integral, LinearFactors, Optics};
use super::ray::Brightest;
use super::shade::{Lit, Shader};
use super::splits::Splits;
use enclosed::Enclosed;

/// Shading and effects of light on one ray.
struct Atmosphere<'a> {
    lights: &'a LightVolumes<'a>,
    /// Share of the emission that is seen without any light.
    ambient: f64,
    lit: Option<Lit<f64>>,
    /// For each light of shading, the strength of its shadows and its light volume.
    shadows: Vec<Option<(f64, usize)>>,
    /// With the depth per mm of the ray.
    depth_cue: Option<(DepthCue, f64)>,
    /// Share of the emission that is not scattered light.
    absorbed: f64,
    /// For each light that is scattered, `albedo · 4π p L`, and its light volume.
    scattered: Vec<([f64; 3], usize)>,
    fog: Option<Fog>,
    haze: Option<Haze>,
    /// Of the transfer function.
    largest_color: f64,
}

/// What it keeps of a segment.
struct Passage {
    /// There where something is lit.
    gradient: Option<[Cubic<f64>; 3]>,
    /// T towards each light volume's light.
    transmittances: Vec<Cubic<f64>>,
    /// Distance of the segment's front from the ray's origin, mm.
    front_mm: f64,
    length_mm: f64,
}

impl<'a> Atmosphere<'a> {
    fn new(scene: &Scene, ray: &Ray, lights: &'a LightVolumes<'a>, largest_color: f64) -> Self {
        let effects = &scene.effects;
        let shading = scene.shading.as_ref();
        let occluded = |light: &Light| match (*light, effects.shadows) {
            (Light::Directional { towards, .. }, Some(shadows)) => Some((shadows.strength, lights.light(towards)?)),
            _ => None,
        };
        let scattering = effects.scattering.as_ref();
        let scattered = scattering.into_iter().flat_map(|s| {
            let phases = s.phases(ray.direction).map(|phase| phase.map(|p| s.albedo * p));
            phases.zip(&s.lights).filter_map(|(phase, (towards, _))| Some((phase, lights.light(*towards)?)))
        });
        Atmosphere {
            lights,
            ambient: shading.map_or(1.0, |s| s.ambient),
            lit: shading.filter(|s| s.is_lit()).map(|s| Lit::new(s, ray.direction, largest_color)),
            shadows: shading.into_iter().flat_map(|s| s.lights.iter().map(occluded)).collect(),
            depth_cue: effects.depth_cue.map(|cue| (cue, scene.depth_per_mm(ray.direction))),
            absorbed: scattering.map_or(1.0, |s| 1.0 - s.albedo),
            scattered: scattered.collect(),
            fog: effects.fog,
            haze: effects.haze,
            largest_color,
        }
    }

    /// Factors over the part `[from, to]` of a segment, which lies between cuts: as [`Scene::factors`], term by term.
    fn factors(&self, passage: &Passage, [from, to]: [f64; 2]) -> LinearFactors<f64> {
        let at_mm = [from, to].map(|u| passage.front_mm + u * passage.length_mm);
        let transmittance = |light: usize| Enclosed::cubic(&restrict(&passage.transmittances[light], from, to));
        let mut reflected = [Enclosed::constant(self.ambient); 3];
        let mut added = [Enclosed::constant(0.0); 3];
        if let (Some(lit), Some(gradient)) = (&self.lit, &passage.gradient) {
            let cue = self.depth_cue.map_or(Enclosed::constant(1.0), |(cue, depth_per_mm)| {
                Enclosed::cue(cue, at_mm.map(|mm| mm * depth_per_mm))
            });
            lit.each_light(gradient, [from, to], |light, terms, diffuse, specular| {
                let share = match self.shadows[light] {
                    Some((strength, volume)) => cue.times(transmittance(volume).visibility(strength)),
                    None => cue,
                };
                let lambert = Enclosed { ends: terms.lambert, error: terms.lambert_error }.times(share);
                let gloss = Enclosed { ends: terms.gloss, error: terms.gloss_error }.times(share);
                for c in 0..3 {
                    reflected[c] = reflected[c].plus(lambert.scaled(diffuse[c]));
                    added[c] = added[c].plus(gloss.scaled(specular[c]));
                }
            });
        }
        if self.absorbed < 1.0 {
            reflected = reflected.map(|x| x.scaled(self.absorbed));
            added = added.map(|x| x.scaled(self.absorbed));
            for &(phase, volume) in &self.scattered {
                let t = transmittance(volume);
                reflected = std::array::from_fn(|c| reflected[c].plus(t.scaled(phase[c])));
            }
        }
        if let Some(fog) = self.fog {
            let clear = Enclosed::fog(fog.law, at_mm);
            let fogged = Enclosed::constant(1.0).plus(clear.scaled(-1.0));
            reflected = reflected.map(|x| x.times(clear));
            added = std::array::from_fn(|c| added[c].times(clear).plus(fogged.scaled(fog.color[c])));
        }
        let most = |all: &[Enclosed; 3]| all.iter().fold(0.0, |most, e| f64::max(most, e.error));
        LinearFactors {
            reflected: [0, 1].map(|end| reflected.map(|e| e.ends[end])),
            highlight: [0, 1].map(|end| added.map(|e| e.ends[end])),
            reflected_error: most(&reflected),
            highlight_error: most(&added),
        }
    }

    /// The largest values that the factors can take where the ray is at least `near_mm` from its origin, in any channel,
    /// without fog: of the emission, and of the extinction; and how fast they change with an error of transmittances.
    fn largest_factors(&self, scene: &Scene, near_mm: f64) -> LargestFactors {
        let cue = self.depth_cue.map_or(1.0, |(cue, depth_per_mm)| cue.factor(near_mm * depth_per_mm));
        let mut largest = LargestFactors { reflected: self.ambient, added: 0.0, by_light: [0.0; 2] };
        for (light, shadow) in scene.shading.iter().flat_map(|s| s.lights.iter().zip(&self.shadows)) {
            let (Light::Headlight { color } | Light::Directional { color, .. }) = light;
            let brightest = cue * color.iter().fold(0.0, |most, &c| f64::max(most, c));
            let [diffuse, specular] =
                scene.shading.as_ref().map_or([0.0; 2], |s| [s.diffuse * brightest, s.specular * brightest]);
            largest.reflected += diffuse;
            largest.added += specular;
            let strength = shadow.map_or(0.0, |(strength, _)| strength);
            largest.by_light[0] += strength * diffuse;
            largest.by_light[1] += strength * specular;
        }
        let phases = self.scattered.iter().map(|(phase, _)| phase.iter().fold(0.0, |most, &p| f64::max(most, p)));
        let scattered: f64 = phases.sum();
        largest.reflected = self.absorbed * largest.reflected + scattered;
        largest.added *= self.absorbed;
        largest.by_light[0] += scattered;
        largest
    }

    /// Bounds on the light of a ray that enters the volume at `near_mm` and is inside it for a length, and on the error that
    /// stored transmittances make to it.
    fn bounds(&self, scene: &Scene, of_function: Brightest, near_mm: f64, length_mm: f64) -> (Brightest, f64) {
        let LargestFactors { reflected, added, by_light } = self.largest_factors(scene, near_mm);
        let mut brightest = of_function.shaded(reflected, added);
        let [of_emission, of_extinction] = by_light;
        let emitted = of_function.color.min(of_function.emission_per_mm * length_mm);
        let stored = STORED_ERROR * (of_emission * emitted + of_extinction);
        let largest = |color: [f64; 3]| color.into_iter().fold(0.0, f64::max);
        if let Some(fog) = self.fog {
            brightest = brightest.fogged(largest(fog.color));
        }
        if let Some(haze) = self.haze {
            brightest = brightest.in_haze(haze.extinction_per_mm, largest(haze.color));
        }
        (brightest, stored)
    }
}

/// See [`Atmosphere::largest_factors`].
struct LargestFactors {
    reflected: f64,
    added: f64,
    /// Of both, per transmittance.
    by_light: [f64; 2],
}

impl Shader<f64> for Atmosphere<'_> {
    type Cell = Passage;

    fn cell(&self, segment: &Segment, gradient: impl FnOnce() -> [Cubic<f64>; 3]) -> Passage {
        let towards = |light| along(&self.lights.corners(light, segment.cell).map(f64::from), segment);
        Passage {
            gradient: self.lit.is_some().then(gradient),
            transmittances: (0..self.lights.len()).map(towards).collect(),
            front_mm: segment.exit_mm - segment.length_mm,
            length_mm: segment.length_mm,
        }
    }

    fn cut(&self, passage: &Passage, splits: &mut Splits<f64>) {
        if let (Some(lit), Some(gradient)) = (&self.lit, &passage.gradient) {
            lit.cut(gradient, splits);
        }
        if let Some(FogLaw::Linear { start_mm, end_mm }) = self.fog.map(|fog| fog.law) {
            let third = passage.length_mm / 3.0;
            let distance = [0.0, 1.0, 2.0, 3.0].map(|k| passage.front_mm + k * third);
            splits.cut_at(&distance, &[start_mm, end_mm]);
        }
    }

    fn integrate<const N: usize, const M: usize>(
        &self,
        optics: &Optics<f64, N>,
        length_mm: f64,
        passage: &Passage,
        part: [f64; 2],
    ) -> Integral<f64> {
        let factors = self.factors(passage, part);
        let Some(haze) = &self.haze else {
            return optics.integrate_shaded::<M>(length_mm, &factors, self.largest_color);
        };
        let emission = haze.emission_per_mm();
        optics.integrate_in_medium::<M>(length_mm, &factors, self.largest_color, emission, haze.extinction_per_mm)
    }

    fn space(&self, length_mm: f64) -> Option<Integral<f64>> {
        let (radiance, absorbed) = self.haze?.slab(length_mm);
        Some(Integral { absorbed, radiance, error: 0.0 })
    }

    fn space_end_mm(&self) -> Option<f64> {
        self.haze.map(|haze| haze.end_mm)
    }
}
