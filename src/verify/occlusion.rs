//! The model's error of shadows and scattering.
//!
//! Transmittances towards lights are defined at the lattice points and interpolated between them. What that definition costs
//! against tracing the light of every point is no error of an integrator, so no tolerance holds it; here it is measured, by
//! the oracle both ways.

use glam::DVec3;
use rayon::prelude::*;

use super::bounds::{head, head_scene};
use super::largest_difference;
use super::manufactured::{SIDE_MM, oblique, rays, sampled, smooth, wave};
use super::report::{Check, Expected};
use crate::error::Result;
use crate::oracle::Oracle;
use crate::scene::{Light, Ray, Scene, Shading, Shadows};
use crate::volume::Volume;

/// Pixels along a side.
const SIZE: usize = 5;

/// Rays through the head phantom.
const RAYS: usize = 24;

/// The most that the model may cost a channel on the head phantom at 32 voxels: bone is opaque within a voxel of it.
const ON_THE_HEAD: f64 = 0.15;

/// The order of the model's error in the lattice's spacing for a smooth field, and its size on the head phantom.
///
/// # Errors
/// `Fault::Limit` where memory for the phantom cannot be had.
pub fn checks() -> Result<Vec<Check>> {
    // Towards a face: no light passes an edge of the cube, where transmittances are bent.
    let scene = shadowed(oblique(smooth()?, SIZE)?, DVec3::Z);
    let rays: Vec<Ray> = rays(&scene).collect();
    let error = |n: usize| Ok([SIDE_MM / (n - 1) as f64, model_error(&sampled(wave, n)?, &scene, &rays)]);
    let errors = [5, 9, 17].into_iter().map(error).collect::<Result<_>>()?;
    let head = head()?;
    let scene = shadowed(head_scene(&head)?, DVec3::new(-0.36, -0.48, 0.8));
    let rays = super::rays::through(head.grid(), RAYS, 2);
    let on_the_head = model_error(&head, &scene, &rays);
    Ok(vec![
        Check::order("shadow model", "order in the lattice's spacing", Expected::order(2.0, 0.4), errors),
        Check::error("shadow model", format!("error over {RAYS} rays through a head"), ON_THE_HEAD, on_the_head),
    ])
}

/// The scene in the light of one lamp, which the volume shadows.
fn shadowed(scene: Scene, towards: DVec3) -> Scene {
    let shading = Shading {
        ambient: 0.2,
        diffuse: 0.7,
        specular: 0.2,
        shininess: 20.0,
        two_sided: true,
        soft_gradient_per_mm: 20.0,
        lights: vec![Light::Directional { towards, color: [1.0; 3] }],
    };
    let mut scene = Scene { shading: Some(shading), ..scene };
    scene.effects.shadows = Some(Shadows { strength: 1.0 });
    scene
}

/// Largest difference that tracing the light of every point makes to these rays.
fn model_error(volume: &Volume, scene: &Scene, rays: &[Ray]) -> f64 {
    let interpolated = Oracle::new(volume, scene);
    let traced = interpolated.clone().with_traced_light();
    let seen = |oracle: &Oracle<'_>| rays.par_iter().map(|ray| oracle.radiance(ray)).collect::<Vec<_>>();
    largest_difference(&seen(&interpolated), &seen(&traced))
}
