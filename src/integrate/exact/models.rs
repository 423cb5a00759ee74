//! Pictures that are not of light: one number of what lies along a ray, or level surfaces. In f64, exact up to rounding.

use crate::field::Voxel;
use crate::scene::{Clip, Ray, Scene, Surface, ValueModel, ValueOf};
use crate::volume::{Grid, Rescale};

use super::Traced;
use super::cells::IndexRay;
use super::depth::{Extinction, optical_depth};
use super::lattice::Lattice;
use super::peak::Peak;
use super::values::{Extreme, crossings, extreme, integral};

/// Rounding of the f64 arithmetic, far above what it amounts to.
const ROUNDING: f64 = 1e-9;

/// Shows one number of the values along a ray; the optical depth is shown by [`show_depth`].
pub(super) fn show_value<V: Voxel>(
    lattice: &Lattice<'_, V>,
    grid: &Grid,
    clip: &Clip,
    rescale: Rescale,
    model: &ValueModel,
    ray: &Ray,
) -> Option<Traced> {
    let inside = IndexRay::new(ray, grid, clip)?;
    let segments = inside.segments(grid);
    // A falling rescale turns the largest value into the smallest stored number.
    let (upwards, downwards) = match rescale.slope < 0.0 {
        false => (Extreme::Largest, Extreme::Smallest),
        true => (Extreme::Smallest, Extreme::Largest),
    };
    let number = match model.of {
        ValueOf::Maximum => rescale.value(extreme(lattice, segments, upwards)?),
        ValueOf::Minimum => rescale.value(extreme(lattice, segments, downwards)?),
        ValueOf::LocalMaximum { threshold } => {
            let peak = Peak {
                sign: rescale.slope.signum(),
                threshold: rescale.stored(threshold),
                fall: model.smallest_fall() / rescale.slope.abs(),
            };
            rescale.value(peak.first(lattice, segments)?)
        }
        ValueOf::Mean => rescale.value(integral(lattice, segments) / inside.length_mm()),
        ValueOf::Sum => rescale.slope * integral(lattice, segments) + rescale.intercept * inside.length_mm(),
        ValueOf::OpticalDepth => unreachable!("the optical depth reads a transfer function"),
    };
    Some(shown(model, number))
}

/// Shows the optical depth along a ray.
pub(super) fn show_depth<M: Extinction>(
    medium: &M,
    grid: &Grid,
    clip: &Clip,
    model: &ValueModel,
    ray: &Ray,
) -> Option<Traced> {
    Some(shown(model, optical_depth(medium, IndexRay::new(ray, grid, clip)?.segments(grid))))
}

fn shown(model: &ValueModel, number: f64) -> Traced {
    let light = model.light(number);
    Traced { radiance: [light; 3], transmittance: 0.0, opacity: 1.0, bound: ROUNDING, pieces: 1 }
}

/// Composites the level surfaces along a ray, front to back.
pub(super) fn show_surfaces<V: Voxel>(
    lattice: &Lattice<'_, V>,
    grid: &Grid,
    rescale: Rescale,
    surfaces: &[Surface],
    scene: &Scene,
    ray: &Ray,
) -> Traced {
    let levels: Vec<f64> = surfaces.iter().map(|s| rescale.stored(s.value)).collect();
    let mut traced = Traced { radiance: [0.0; 3], transmittance: 1.0, opacity: 0.0, bound: ROUNDING, pieces: 0 };
    let segments = IndexRay::new(ray, grid, &scene.effects.clip).into_iter().flat_map(|inside| inside.segments(grid));
    crossings(lattice, segments, rescale.slope.signum(), &levels, |crossing| {
        let Surface { opacity, color, .. } = surfaces[crossing.level];
        // Between surfaces nothing absorbs, so that they cast no shadows.
        let (reflected, added) = scene.factors(ray, crossing.at_mm, crossing.gradient_per_mm.into(), |_| 1.0);
        for c in 0..3 {
            traced.radiance[c] += traced.transmittance * opacity * (color[c] * reflected[c] + added[c]);
        }
        traced.opacity += traced.transmittance * opacity;
        traced.transmittance -= traced.transmittance * opacity;
        traced.pieces += 1;
        traced.transmittance > 0.0
    });
    traced
}
