//! Fixed-step ray marching, as the textbooks and VTK do it.
//!
//! A ray is cut into intervals ([`lattice`], [`sampling`], [`whole_steps`]); a kernel, chosen by the type of what absorbs and emits ([`medium`]),
//! evaluates a run of samples at a time; a fold ([`composite`]), chosen by the other settings, composites the run. So
//! every setting is decided once per frame and none is asked at a sample, without one kernel per combination.
//!
//! A picture of numbers ([`number`]) probes the values, or the extinction, and gathers a run into a maximum or an integral
//! ([`gather`]); a picture of surfaces looks for changes between neighbouring samples: it
//! interpolates between them ([`surfaces`]), or takes whole steps and stays at the samples ([`level_changes`]).

mod blocks;
mod by_place;
mod composite;
mod gather;
mod jitter;
mod kernel;
mod lanes;
mod lattice;
mod level_changes;
mod medium;
mod number;
mod packet;
mod phong;
mod probe;
mod sampling;
mod surfaces;
mod voxels;
mod whole_steps;

pub(super) use blocks::Blocks;
pub(super) use by_place::{ByPlace, Masked};
pub(super) use jitter::hash;
pub(super) use kernel::Kernel;
pub(super) use lanes::ByLanes;
pub(super) use level_changes::LevelChanges;
pub(super) use medium::{Classified, Medium, OneByOne};
pub(super) use number::show_number;
pub(super) use packet::{Packets, suits as suits_packets};
pub(super) use phong::VtkPhong;
pub(super) use surfaces::show_surfaces;
pub(super) use voxels::AtVoxels;

use crate::error::{Error, Fault, Result};
use crate::plan::{Emission, March};
use crate::scene::Scene;
use crate::volume::Grid;

/// Samples along one ray beyond which a step is refused.
const MOST_SAMPLES_PER_RAY: f64 = 1e8;

/// Refuses settings that mean nothing or would take for ever.
///
/// # Errors
/// `Fault::Unsupported` for haze with emission per sample, `Fault::Spec` for a step or a transmittance that is no usable
/// number, `Fault::Limit` for a step so small that a ray
/// through the volume would take more than 10⁸ samples.
pub(super) fn check(settings: &March, scene: &Scene, grid: &Grid) -> Result<()> {
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
    if scene.effects.haze.is_some() && settings.emission == Emission::PerSample {
        return Err(Error::new(Fault::Unsupported, "haze has no samples to emit by")
            .element("integrate.march.emission")
            .found("emission per sample")
            .remedy("use emission: per-length, the default, or leave haze out"));
    }
    let samples = grid.longest_chord_mm() / step;
    if samples > MOST_SAMPLES_PER_RAY {
        return Err(Error::new(Fault::Limit, "the step is too small for the volume")
            .element("integrate.march.step")
            .found(format!("{step:e} mm, up to {samples:.0e} samples on a ray"))
            .expected(format!("at most {MOST_SAMPLES_PER_RAY:.0e} samples on a ray"))
            .remedy("use a longer step, or the exact integrator"));
    }
    Ok(())
}
