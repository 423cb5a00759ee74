//! Shading and the effects of light along a passage.

use glam::DVec3;

use super::Oracle;
use super::bernstein::Cubic;
use super::cell::{Cell, along};
use super::occlusion::Occlusion;
use super::patches::Channels;
use super::path::Passage;
use super::shaded::ShadedRay;
use super::splits::Splits;
use crate::scene::{FogLaw, Ray};

/// By what factor fog and depth cue may change within a step of the quadrature.
const LARGEST_CHANGE: f64 = 8.0;

/// Less of a colour than this is left by fog as by none.
const NEGLIGIBLE: f64 = 1e-20;

/// A passage, as its ray's light sees it.
#[derive(Debug, Clone)]
pub(super) struct LitPassage<'a> {
    oracle: &'a Oracle<'a>,
    ray: &'a Ray,
    /// `None` if the scene is not shaded.
    shaded: Option<&'a ShadedRay>,
    from_mm: f64,
    length_mm: f64,
    /// T along the passage towards each occluded light, by its place in the list; empty where it is traced.
    transmittances: Vec<Cubic>,
}

impl<'a> LitPassage<'a> {
    /// The passage of a ray, with what its cell's corners know of lights.
    pub(super) fn new(oracle: &'a Oracle<'a>, ray: &'a Ray, shaded: Option<&'a ShadedRay>, passage: &Passage) -> Self {
        let transmittances = match &oracle.occlusion {
            Occlusion::Traced => Vec::new(),
            Occlusion::Interpolated(lights) => {
                let corners = Cell::new(oracle.volume, passage.cell).corners();
                let towards = |light| corners.map(|voxel| lights.transmittance(oracle, light, voxel));
                (0..lights.directions.len()).map(|light| along(&towards(light), passage)).collect()
            }
        };
        LitPassage { oracle, ray, shaded, from_mm: passage.from_mm, length_mm: passage.length_mm, transmittances }
    }

    /// Extinction and emission as they are seen, from σ and q of the transfer function.
    pub(super) fn light(&self, t: f64, [extinction, emission @ ..]: Channels, gradient_per_mm: DVec3) -> Channels {
        let at_mm = self.from_mm + t * self.length_mm;
        let scene = self.oracle.scene;
        let (reflected, added) =
            scene.factors(self.ray, at_mm, gradient_per_mm, |towards| self.transmittance(towards, t));
        let [r, g, b] = std::array::from_fn(|c| emission[c] * reflected[c] + extinction * added[c]);
        match &scene.effects.haze {
            None => [extinction, r, g, b],
            Some(haze) => {
                let [hr, hg, hb] = haze.emission_per_mm();
                [extinction + haze.extinction_per_mm, r + hr, g + hg, b + hb]
            }
        }
    }

    fn transmittance(&self, towards: DVec3, t: f64) -> f64 {
        match &self.oracle.occlusion {
            Occlusion::Traced => {
                let point = self.ray.origin_mm + (self.from_mm + t * self.length_mm) * self.ray.direction;
                self.oracle.transmittance_of(&Ray { origin_mm: point, direction: towards })
            }
            Occlusion::Interpolated(lights) => {
                let light = lights.directions.iter().position(|d| *d == towards);
                light.map_or(1.0, |light| self.transmittances[light].at(t))
            }
        }
    }

    /// Adds the cuts where fog begins and ends.
    pub(super) fn add_bends(&self, splits: &mut Splits) {
        if let Some(FogLaw::Linear { start_mm, end_mm }) = self.oracle.scene.effects.fog.map(|fog| fog.law) {
            let at = [start_mm, end_mm].map(|mm| (mm - self.from_mm) / self.length_mm);
            for t in at.into_iter().filter(|t| (0.0..1.0).contains(t)) {
                splits.add(&[t]);
            }
        }
    }

    /// True if shading, fog and depth cue change gently between two points, with these gradients, that no cut separates.
    pub(super) fn is_gentle_between(&self, [a, b]: [f64; 2], gradients: [DVec3; 2]) -> bool {
        let shading = self.shaded.is_none_or(|shaded| shaded.is_gentle_between(gradients[0], gradients[1]));
        let at_mm = |t: f64| self.from_mm + t * self.length_mm;
        let (scene, effects) = (self.oracle.scene, &self.oracle.scene.effects);
        // Both fall with the distance.
        let fog = effects.fog.is_none_or(|fog| {
            let (near, far) = (fog.law.clearness(at_mm(a)), fog.law.clearness(at_mm(b)));
            // Linear fog ends at 0, on a straight line.
            matches!(fog.law, FogLaw::Linear { .. }) || near < NEGLIGIBLE || near <= LARGEST_CHANGE * far
        });
        let depth_per_mm = scene.depth_per_mm(self.ray.direction);
        let cue = effects.depth_cue.is_none_or(|cue| {
            cue.factor(at_mm(a) * depth_per_mm) <= LARGEST_CHANGE * cue.factor(at_mm(b) * depth_per_mm)
        });
        shading && fog && cue
    }
}
