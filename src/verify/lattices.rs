//! Refinement of the lattice.
//!
//! Samples of one trilinear field, more or fewer of them, are one field: no picture may change. Other smooth fields are
//! approached with the square of the lattice's spacing. A field that is shifted by part of a voxel, as by a mistaken
//! convention of where a voxel is, breaks the first and takes the second down to order 1.

use super::gauss::integrate;
use super::manufactured::{SIDE_MM, oblique, rays, sampled, smooth, trilinear, wave};
use super::report::{Check, Expected};
use super::{Integrator, largest_difference};
use crate::error::Result;
use crate::scene::Scene;

/// Difference that rounding in f32 may make to a march in 512 steps across the cube.
pub const MARCHING: f64 = 2e-5;

/// The step while the lattice is refined, mm.
const STEP_MM: f64 = SIDE_MM / 512.0;

/// Pixels along a side.
const SIZE: usize = 12;

/// How far pictures of one trilinear field on lattices of 2 to 33 points a side are apart, at most `allowed`; and the order
/// in the spacing for a field that is not trilinear.
///
/// # Errors
/// Whatever the integrator says.
pub fn checks(name: &str, allowed: f64, integrator: &Integrator<'_>) -> Result<Vec<Check>> {
    let scene = oblique(smooth()?, SIZE)?;
    let picture = |field, n| integrator(&sampled(field, n)?, &scene, STEP_MM);
    let coarsest = picture(trilinear, 2)?;
    let mut apart = 0.0_f64;
    for n in [3, 5, 9, 17, 33] {
        apart = apart.max(largest_difference(&picture(trilinear, n)?, &coarsest));
    }
    let truth = picture_of_wave(&scene)?;
    let error = |n: usize| Ok([1.0 / (n - 1) as f64, largest_difference(&picture(wave, n)?, &truth)]);
    let errors = [5, 9, 17, 33].into_iter().map(error).collect::<Result<_>>()?;
    Ok(vec![
        Check::error(name, "2 to 33 points a side of a trilinear field", allowed, apart),
        Check::order(name, "order in the lattice's spacing", Expected::order(2.0, 0.15), errors),
    ])
}

/// The picture of the wave itself, on no lattice, to 1e-9.
fn picture_of_wave(scene: &Scene) -> Result<Vec<[f64; 4]>> {
    let grid = *sampled(wave, 2)?.grid();
    let function = &scene.transfer_function;
    let optics = |point_mm: glam::DVec3| function.evaluate(wave(point_mm / SIDE_MM), 0.0);
    Ok(rays(scene).map(|ray| integrate(&grid, &ray, SIDE_MM / 256.0, optics)).collect())
}
