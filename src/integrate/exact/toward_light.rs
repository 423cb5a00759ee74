//! Transmittance from a lattice point towards a light.
//!
//! On each piece of the light's ray extinction is a polynomial, so the optical depth is exact and nothing need be bounded.

use glam::DVec3;

use crate::classify::{Baked, BakedAlike, bake, bake_alike};
use crate::field::Voxel;
use crate::scene::Scene;
use crate::volume::{Samples, Volume};

use super::cells::Domain;
use super::lattice::Lattice;
use super::masked::Masked;
use super::medium::{Classified, Medium};
use super::nearest::Nearest;
use super::shade::Unlit;
use super::splits::Splits;

/// Below this transmittance a ray ends: 1/2 of the last bit that is stored of a transmittance near 1 is 2⁻²⁵.
const OPAQUE: f64 = 1e-12;

/// The transmittance of a scene's extinction, clipped and without haze, from a voxel along a direction.
pub(in super::super) type TowardLight<'a> = Box<dyn Fn([usize; 3], DVec3) -> f64 + Sync + 'a>;

/// Transmittances towards lights, to rounding in f64.
pub(in super::super) fn toward_light<'a>(volume: &'a Volume, scene: &'a Scene) -> TowardLight<'a> {
    match volume.samples() {
        Samples::I16(samples) => for_samples(volume, scene, samples),
        Samples::F32(samples) => for_samples(volume, scene, samples),
        Samples::Rgba8(_) | Samples::Rgba16(_) => unreachable!("colours have no values, and are refused"),
    }
}

fn for_samples<'a, V: Voxel>(volume: &'a Volume, scene: &'a Scene, samples: &'a [V]) -> TowardLight<'a> {
    let lattice = Lattice::new(volume, samples);
    let occluder = Occluder { domain: Domain::new(volume, scene) };
    if let Some((mask, classes)) = scene.effects.mask.as_ref().zip(volume.classes()) {
        let nearest = Nearest::new(classes, volume.grid());
        return match bake_alike::<f64>(&mask.functions(classes.count(), &scene.transfer_function), volume.rescale()) {
            BakedAlike::OneD(all) => {
                let media = all.into_iter().map(|classifier| Classified { lattice, classifier }).collect();
                let medium = Masked { media, nearest };
                Box::new(move |voxel, towards| occluder.transmittance(&medium, voxel, towards))
            }
            BakedAlike::TwoD(all) => {
                let media = all.into_iter().map(|classifier| Classified { lattice, classifier }).collect();
                let medium = Masked { media, nearest };
                Box::new(move |voxel, towards| occluder.transmittance(&medium, voxel, towards))
            }
        };
    }
    match bake::<f64>(&scene.transfer_function, volume.rescale()) {
        Baked::OneD(classifier) => {
            let medium = Classified { lattice, classifier };
            Box::new(move |voxel, towards| occluder.transmittance(&medium, voxel, towards))
        }
        Baked::TwoD(classifier) => {
            let medium = Classified { lattice, classifier };
            Box::new(move |voxel, towards| occluder.transmittance(&medium, voxel, towards))
        }
    }
}

/// What stands in a light's way.
struct Occluder<'a> {
    domain: Domain<'a>,
}

impl Occluder<'_> {
    fn transmittance<M: Medium<f64>>(&self, medium: &M, voxel: [usize; 3], direction: DVec3) -> f64 {
        let Some((inside, [from_mm, to_mm])) = self.domain.inside_from_voxel(voxel, direction) else { return 1.0 };
        let mut transmittance = 1.0;
        let mut splits = Splits::default();
        for segment in self.domain.segments(inside) {
            let front_mm = segment.exit_mm - segment.length_mm;
            let Some(fields) = medium.fields(&segment) else { continue };
            splits.restart(0.0);
            medium.cut(&fields, &mut splits);
            splits.sorted();
            let [first, last] = [from_mm, to_mm].map(|mm| ((mm - front_mm) / segment.length_mm).clamp(0.0, 1.0));
            for i in 1..splits.len() {
                let (from, to) = (splits.get(i - 1).max(first), splits.get(i).min(last));
                let length_mm = (to - from) * segment.length_mm;
                if length_mm > 0.0
                    && let Some(integral) = medium.integrate(&fields, [from, to], length_mm, &Unlit, &())
                {
                    transmittance -= transmittance * integral.absorbed;
                }
            }
            if transmittance < OPAQUE {
                break;
            }
        }
        transmittance
    }
}
