//! Checks on a volume by formula.

use super::{Check, join};
use crate::error::Result;
use crate::spec::{AnalyticSpec, FieldSpec, PerAxis};

/// Voxels along an axis.
const VOXELS: std::ops::RangeInclusive<u32> = 1..=4096;

pub(super) fn check_analytic(check: Check<'_>, path: &str, analytic: &AnalyticSpec) -> Result<()> {
    let at = |key| join(path, key);
    check_field(check, &at("field"), &analytic.field)?;
    let axes = if analytic.planes_mm.is_some() { 2 } else { 3 };
    let each = if axes == 2 { "[x, y]" } else { "[x, y, z]" };
    let is_size = |n: &u32| VOXELS.contains(n);
    let size = analytic.size.numbers(axes).is_some_and(|size| size.iter().all(is_size));
    check.require(&at("size"), size, &format!("1 to 4096 voxels: one number, or {each}"))?;
    let lengths = [("spacing_mm", &analytic.spacing_mm), ("extent_mm", &analytic.extent_mm)];
    check.exactly_one(path, &lengths.map(|(key, length)| (key, length.is_some())))?;
    for (key, length) in lengths {
        let usable = |length: &PerAxis<f64>| length.numbers(axes).is_some_and(|mm| mm.iter().all(|mm| *mm > 0.0));
        let expected = format!("mm above 0: one number, or {each}");
        check.require(&at(key), length.as_ref().is_none_or(usable), &expected)?;
    }
    let Some(planes_mm) = &analytic.planes_mm else { return Ok(()) };
    let usable = (2..=4096).contains(&planes_mm.len()) && planes_mm.is_sorted_by(|a, b| a < b);
    check.require(&at("planes_mm"), usable, "2 to 4096 positions in mm, each above the one before")
}

fn check_field(check: Check<'_>, path: &str, field: &FieldSpec) -> Result<()> {
    match field {
        FieldSpec::Sphere(sphere) => check.above_zero(&join(path, "sphere.radius_mm"), Some(sphere.radius_mm)),
        FieldSpec::Torus(torus) => {
            check.above_zero(&join(path, "torus.major_radius_mm"), Some(torus.major_radius_mm))?;
            check.above_zero(&join(path, "torus.minor_radius_mm"), Some(torus.minor_radius_mm))
        }
        FieldSpec::MarschnerLobb(settings) => {
            check.above_zero(&join(path, "marschner_lobb.unit_mm"), settings.unit_mm)?;
            check.at_least(&join(path, "marschner_lobb.alpha"), settings.alpha, 0.0)
        }
        // What an expression says is read where it is made into a field.
        FieldSpec::Ramp(_) | FieldSpec::Expression(_) => Ok(()),
    }
}
