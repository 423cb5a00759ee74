//! Pictures that are not of light: one number of the values along a ray, or level surfaces. In f64, exact up to rounding.

use crate::field::Voxel;
use crate::scene::{Ray, Scene, Surface, ValueModel, ValueOf};
use crate::volume::{Grid, Rescale};

use super::Traced;
use super::lattice::Lattice;
use super::values::{Extreme, crossings, extreme, mean};

/// Rounding of the f64 arithmetic, far above what it amounts to.
const ROUNDING: f64 = 1e-9;

/// Shows one number of the values along a ray.
pub(super) fn show_value<V: Voxel>(
    lattice: &Lattice<'_, V>,
    grid: &Grid,
    rescale: Rescale,
    model: &ValueModel,
    ray: &Ray,
) -> Option<Traced> {
    // A falling rescale turns the largest value into the smallest stored number.
    let falling = rescale.slope < 0.0;
    let stored = match model.of {
        ValueOf::Maximum if !falling => extreme(lattice, grid, ray, Extreme::Largest)?,
        ValueOf::Minimum if falling => extreme(lattice, grid, ray, Extreme::Largest)?,
        ValueOf::Maximum | ValueOf::Minimum => extreme(lattice, grid, ray, Extreme::Smallest)?,
        ValueOf::Mean => mean(lattice, grid, ray)?,
    };
    let light = model.light(rescale.value(stored));
    Some(Traced { radiance: [light; 3], transmittance: 0.0, opacity: 1.0, bound: ROUNDING, pieces: 1 })
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
    crossings(lattice, grid, ray, &levels, |crossing| {
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
