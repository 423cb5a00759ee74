//! Fixed-step ray marching, as the textbooks and VTK do it.
//!
//! A ray is cut into intervals ([`lattice`]); a kernel, chosen by the types of voxels, transfer function and shading,
//! evaluates a run of samples at a time; a fold ([`composite`]), chosen by the other settings, composites the run. So
//! every setting is decided once per frame and none is asked at a sample, without one kernel per combination.

mod composite;
mod jitter;
mod kernel;
mod lattice;
mod phong;

pub(super) use jitter::hash;
pub(super) use kernel::Kernel;
pub(super) use phong::VtkPhong;

use crate::error::{Error, Fault, Result};
use crate::plan::March;
use crate::scene::{Model, Scene};
use crate::volume::Grid;

/// Samples along one ray beyond which a step is refused.
const MOST_SAMPLES_PER_RAY: f64 = 1e8;

/// Refuses settings that mean nothing or would take for ever.
///
/// # Errors
/// `Fault::Unsupported` for a scene that is not of light, `Fault::Spec` for a step or a transmittance that is no usable number, `Fault::Limit` for a step so small that a ray
/// through the volume would take more than 10⁸ samples.
pub(super) fn check(settings: &March, scene: &Scene, grid: &Grid) -> Result<()> {
    if scene.model != Model::Light {
        return Err(Error::new(Fault::Unsupported, "marching integrates light only")
            .element("integrate.march")
            .found("a scene of values or surfaces")
            .remedy("use integrate: exact, which finds them without steps"));
    }
    let step = settings.step_mm;
    if !(step.is_finite() && step > 0.0) {
        return Err(Error::new(Fault::Spec, "the step is not usable")
            .element("integrate.march.step")
            .found(format!("{step} mm"))
            .expected("a finite length above 0"));
    }
    let least = settings.termination_transmittance;
    if !(0.0..1.0).contains(&least) {
        return Err(Error::new(Fault::Spec, "the transmittance to stop at is not usable")
            .element("integrate.march.termination_transmittance")
            .found(least.to_string())
            .expected("a number from 0 (never) to below 1"));
    }
    // The longest chord of a parallelepiped is one of its four diagonals.
    let corners = grid.corners_mm();
    let longest_mm = (0..4).map(|c| corners[c].distance(corners[7 - c])).fold(0.0, f64::max);
    let samples = longest_mm / step;
    if samples > MOST_SAMPLES_PER_RAY {
        return Err(Error::new(Fault::Limit, "the step is too small for the volume")
            .element("integrate.march.step")
            .found(format!("{step:e} mm, up to {samples:.0e} samples on a ray"))
            .expected(format!("at most {MOST_SAMPLES_PER_RAY:.0e} samples on a ray"))
            .remedy("use a longer step, or the exact integrator"));
    }
    Ok(())
}
