//! Pictures that are not of light: one number of the values along a ray, or level surfaces. In f64, exact up to rounding.

use crate::field::Voxel;
use crate::scene::{Ray, Shading, Surface, ValueModel, ValueOf};
use crate::volume::Rescale;

use super::Traced;
use super::cells::Segment;
use super::lattice::Lattice;
use super::shown::{Passed, Shown};
use super::values::{Crossing, Extreme, crossings, extreme, mean};

/// Rounding of the f64 arithmetic, far above what it amounts to.
const ROUNDING: f64 = 1e-9;

/// Shows one number of the values along a ray.
pub(super) fn show_value<V: Voxel>(
    lattice: &Lattice<'_, V>,
    shown: &Shown<'_>,
    rescale: Rescale,
    model: &ValueModel,
    ray: &Ray,
) -> Option<Traced> {
    let inside = shown.inside(ray)?;
    let segments = || inside.segments(shown.grid);
    // A falling rescale turns the largest value into the smallest stored number.
    let of = match model.of {
        ValueOf::Maximum if rescale.slope < 0.0 => ValueOf::Minimum,
        ValueOf::Minimum if rescale.slope < 0.0 => ValueOf::Maximum,
        of => of,
    };
    let stored = match shown.hiding {
        None => number(lattice, segments(), inside.length_mm(), of)?,
        Some(hiding) => {
            let left = || hiding.pass(segments()).filter_map(Passed::shown);
            number(lattice, left(), left().map(|s| s.length_mm).sum(), of)?
        }
    };
    let light = model.light(rescale.value(stored));
    Some(Traced { radiance: [light; 3], transmittance: 0.0, opacity: 1.0, bound: ROUNDING, pieces: 1 })
}

/// A number of the stored values along segments, which are `length_mm` long together.
fn number<V: Voxel>(
    lattice: &Lattice<'_, V>,
    segments: impl Iterator<Item = Segment>,
    length_mm: f64,
    of: ValueOf,
) -> Option<f64> {
    match of {
        ValueOf::Maximum => extreme(lattice, segments, Extreme::Largest),
        ValueOf::Minimum => extreme(lattice, segments, Extreme::Smallest),
        ValueOf::Mean => (length_mm > 0.0).then(|| mean(lattice, segments, length_mm)),
    }
}

/// Composites the level surfaces along a ray, front to back.
pub(super) fn show_surfaces<V: Voxel>(
    lattice: &Lattice<'_, V>,
    shown: &Shown<'_>,
    rescale: Rescale,
    surfaces: &[Surface],
    shading: Option<&Shading>,
    ray: &Ray,
) -> Traced {
    let levels: Vec<f64> = surfaces.iter().map(|s| rescale.stored(s.value)).collect();
    let mut traced = Traced { radiance: [0.0; 3], transmittance: 1.0, opacity: 0.0, bound: ROUNDING, pieces: 0 };
    let composite = |crossing: Crossing| {
        let Surface { opacity, color, .. } = surfaces[crossing.level];
        let (reflected, highlight) = match shading {
            Some(shading) => shading.factors(crossing.gradient_per_mm.into(), ray.direction),
            None => ([1.0; 3], [0.0; 3]),
        };
        for c in 0..3 {
            traced.radiance[c] += traced.transmittance * opacity * (color[c] * reflected[c] + highlight[c]);
        }
        traced.opacity += traced.transmittance * opacity;
        traced.transmittance -= traced.transmittance * opacity;
        traced.pieces += 1;
        traced.transmittance > 0.0
    };
    let segments = shown.inside(ray).into_iter().flat_map(|inside| inside.segments(shown.grid));
    match shown.hiding {
        None => crossings(lattice, segments.map(Passed::Shown), &levels, composite),
        Some(hiding) => crossings(lattice, hiding.pass(segments), &levels, composite),
    }
    traced
}
