//! Pictures that are not of light: one number of what lies along a ray, or level surfaces. In f64, exact up to rounding.

use crate::field::Voxel;
use crate::scene::{Ray, Scene, Surface, ValueModel, ValueOf};
use crate::volume::Rescale;

use super::Traced;
use super::cells::{Domain, Segment};
use super::depth::{Extinction, optical_depth};
use super::lattice::Lattice;
use super::peak::Peak;
use super::shown::{Passed, Shown};
use super::values::{Crossing, Extreme, crossings, extreme, integral};

/// Rounding of the f64 arithmetic, far above what it amounts to.
const ROUNDING: f64 = 1e-9;

/// Shows one number of the values along a ray; the optical depth is shown by [`show_depth`].
pub(super) fn show_value<V: Voxel>(
    lattice: &Lattice<'_, V>,
    shown: &Shown<'_>,
    rescale: Rescale,
    model: &ValueModel,
    ray: &Ray,
) -> Option<Traced> {
    let inside = shown.domain.inside(ray)?;
    let segments = || shown.domain.segments(inside);
    let number = match shown.hiding {
        None => number(lattice, segments(), inside.length_mm(), rescale, model)?,
        Some(hiding) => {
            let left = || hiding.pass(segments()).filter_map(Passed::shown);
            number(lattice, left(), left().map(|s| s.length_mm).sum(), rescale, model)?
        }
    };
    Some(in_grey(model, number))
}

/// A number of the values along segments, which are `length_mm` long together; `None` if that is 0.
fn number<V: Voxel>(
    lattice: &Lattice<'_, V>,
    segments: impl Iterator<Item = Segment>,
    length_mm: f64,
    rescale: Rescale,
    model: &ValueModel,
) -> Option<f64> {
    if length_mm <= 0.0 {
        return None;
    }
    // A falling rescale turns the largest value into the smallest stored number.
    let (upwards, downwards) = match rescale.slope < 0.0 {
        false => (Extreme::Largest, Extreme::Smallest),
        true => (Extreme::Smallest, Extreme::Largest),
    };
    Some(match model.of {
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
        ValueOf::Mean => rescale.value(integral(lattice, segments) / length_mm),
        ValueOf::Sum => rescale.slope * integral(lattice, segments) + rescale.intercept * length_mm,
        ValueOf::OpticalDepth => unreachable!("the optical depth reads a transfer function"),
    })
}

/// Shows the optical depth along a ray.
pub(super) fn show_depth<M: Extinction>(
    medium: &M,
    domain: &Domain<'_>,
    model: &ValueModel,
    ray: &Ray,
) -> Option<Traced> {
    Some(in_grey(model, optical_depth(medium, domain.segments(domain.inside(ray)?))))
}

fn in_grey(model: &ValueModel, number: f64) -> Traced {
    let light = model.light(number);
    Traced { radiance: [light; 3], transmittance: 0.0, opacity: 1.0, bound: ROUNDING, pieces: 1 }
}

/// Composites the level surfaces along a ray, front to back.
pub(super) fn show_surfaces<V: Voxel>(
    lattice: &Lattice<'_, V>,
    shown: &Shown<'_>,
    rescale: Rescale,
    surfaces: &[Surface],
    scene: &Scene,
    ray: &Ray,
) -> Traced {
    let nothing = Traced { radiance: [0.0; 3], transmittance: 1.0, opacity: 0.0, bound: ROUNDING, pieces: 0 };
    let Some(inside) = shown.domain.inside(ray) else { return nothing };
    let levels: Vec<f64> = surfaces.iter().map(|s| rescale.stored(s.value)).collect();
    let mut traced = nothing;
    let composite = |crossing: Crossing| {
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
    };
    let segments = shown.domain.segments(inside);
    let sign = rescale.slope.signum();
    match shown.hiding {
        None => crossings(lattice, segments, sign, &levels, composite),
        Some(hiding) => crossings(lattice, hiding.pass(segments), sign, &levels, composite),
    }
    traced
}
