//! The exact integrator held to its tolerance and to the bound it reports, ray by ray, on the built-in head phantom.

use rayon::prelude::*;

use super::rays;
use super::report::Check;
use crate::error::Result;
use crate::integrate::exact::{Precision, Traced, tracer};
use crate::oracle::Oracle;
use crate::scene::{Background, Camera, Effects, Light, Model, Projection, Scene, Shading};
use crate::synthetic::{self, BodyPhantom, Region};
use crate::transfer::shapes::{Shape, extinction_per_mm};
use crate::transfer::{Optics, Term, TransferFunction};
use crate::volume::Volume;

/// Voxels from ear to ear.
const SIZE: usize = 32;

/// Random rays per scene.
const RAYS: usize = 2000;

const TOLERANCES: [(&str, f64); 3] = [("1/255", 1.0 / 255.0), ("1e-3", 1e-3), ("1e-4", 1e-4)];

/// Errors over random rays through the head phantom, by scene, precision and tolerance; and the largest ratio of an error to
/// the bound reported with it.
///
/// # Errors
/// `Fault::Limit` where memory for the phantom cannot be had.
pub fn checks() -> Result<Vec<Check>> {
    let volume = head()?;
    let rays = rays::through(volume.grid(), RAYS, 1);
    let mut checks = Vec::new();
    for (scene_name, scene) in scenes(&volume)? {
        let oracle = Oracle::new(&volume, &scene);
        let truth: Vec<_> = rays.par_iter().map(|ray| oracle.radiance(ray)).collect();
        for (name, precision) in [("exact/f32", Precision::Single), ("exact/f64", Precision::Double)] {
            let mut of_bound = 0.0_f64;
            for (written, tolerance) in TOLERANCES {
                let tracer = tracer(&volume, &scene, tolerance, precision);
                let traced: Vec<_> = rays.par_iter().map(|ray| tracer.trace(ray)).collect();
                let worst = worst(&traced, &truth);
                of_bound = of_bound.max(worst.of_bound);
                let check = format!("{scene_name}: error over {RAYS} rays at {written}");
                checks.push(Check::error(name, check, tolerance, worst.error));
            }
            checks.push(Check::error(name, format!("{scene_name}: error / bound"), 1.0, of_bound));
        }
    }
    Ok(checks)
}

/// The phantom.
pub(super) fn head() -> Result<Volume> {
    synthetic::body(&BodyPhantom { size: SIZE, ..BodyPhantom::of(Region::Head) })
}

/// Its tissues by value alone.
pub(super) fn head_scene(volume: &Volume) -> Result<Scene> {
    scene(volume, false, None)
}

/// The worst of many rays.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Worst {
    error: f64,
    /// Largest ratio of an error to its bound.
    of_bound: f64,
}

fn worst(traced: &[Option<Traced>], truth: &[[f64; 4]]) -> Worst {
    let mut worst = Worst { error: 0.0, of_bound: 0.0 };
    for (traced, truth) in traced.iter().zip(truth) {
        // A ray that is missed has seen nothing, and is sure of it.
        let (found, bound) = traced.map_or(([0.0; 4], 0.0), |t| {
            let [r, g, b] = t.radiance;
            ([r, g, b, t.opacity], t.bound)
        });
        let error = super::largest_difference(&[found], &[*truth]);
        worst.error = worst.error.max(error);
        if error > 0.0 {
            let ratio = error / bound;
            worst.of_bound = worst.of_bound.max(if ratio.is_nan() { f64::INFINITY } else { ratio });
        }
    }
    worst
}

/// A trapezoid for each tissue: values at its four corners, gradient magnitudes, opacity over 1 mm, colour.
type Tissue = ([f64; 4], [f64; 4], f64, [f64; 3]);

const TISSUES: [Tissue; 3] = [
    ([-300.0, -150.0, 0.0, 30.0], [0.0, 10.0, 400.0, 900.0], 0.03, [0.9, 0.5, 0.35]),
    ([20.0, 60.0, 120.0, 200.0], [0.0, 5.0, 200.0, 500.0], 0.15, [0.8, 0.15, 0.1]),
    ([180.0, 350.0, 2500.0, 3071.0], [10.0, 40.0, 900.0, 1400.0], 0.7, [1.0, 0.95, 0.8]),
];

fn scenes(volume: &Volume) -> Result<[(&'static str, Scene); 3]> {
    let lights = vec![Light::Headlight { color: [1.0; 3] }];
    let shading = Shading {
        ambient: 0.2,
        diffuse: 0.7,
        specular: 0.2,
        shininess: 20.0,
        two_sided: true,
        soft_gradient_per_mm: 20.0,
        lights,
    };
    Ok([
        ("1D", scene(volume, false, None)?),
        ("2D", scene(volume, true, None)?),
        ("2D shaded", scene(volume, true, Some(shading))?),
    ])
}

fn scene(volume: &Volume, by_gradient: bool, shading: Option<Shading>) -> Result<Scene> {
    let mut terms: Vec<Term> = Vec::new();
    for (value, gradient, opacity, color) in TISSUES {
        let optics = Optics::colored(extinction_per_mm(opacity, 1.0), color);
        let shape = Shape::Trapezoid { value, gradient_per_mm: by_gradient.then_some(gradient) };
        terms.extend(shape.expand(optics, 0.0)?.terms);
    }
    Ok(Scene {
        model: Model::Light,
        transfer_function: TransferFunction::new([-1024.0, 3071.0], 1500.0, terms)?,
        shading,
        camera: nobody_looks(volume)?,
        background: Background::Transparent,
        effects: Effects::default(),
    })
}

/// Rays are random here; a scene has a camera all the same.
fn nobody_looks(volume: &Volume) -> Result<Camera> {
    let center = volume.grid().center_mm();
    let projection = Projection::Parallel { height_mm: 1.0 };
    Camera::look_at(center - 1000.0 * glam::DVec3::Y, center, glam::DVec3::Z, projection, [1, 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_above_its_bound_and_a_ray_that_is_no_number_are_found() {
        let traced = |red: f64, bound: f64| {
            Some(Traced { radiance: [red, 0.0, 0.0], transmittance: 1.0, opacity: 0.0, bound, pieces: 1 })
        };
        let found = worst(&[traced(0.5, 0.125), None], &[[0.25, 0.0, 0.0, 0.0], [0.0; 4]]);
        assert_eq!(found, Worst { error: 0.25, of_bound: 2.0 });
        let missed = worst(&[None], &[[0.0, 0.0, 0.0, 0.5]]);
        assert_eq!(missed, Worst { error: 0.5, of_bound: f64::INFINITY });
        assert_eq!(worst(&[traced(f64::NAN, 1.0)], &[[0.0; 4]]).error, f64::INFINITY);
    }
}
