//! From the axes of a header to the lattice in the patient.

use glam::{DAffine3, DMat3, DVec3};

use super::header::{Axis, Center, Header};
use super::rgba;
use super::space::{Frame, Space};
use crate::error::{Error, Fault, Result};
use crate::volume::Grid;

/// Spacing and directions may both be given; they agree if they differ by less than this part.
const SPACING_TOLERANCE: f64 = 1e-3;

/// Where the elements of a volume lie in the patient, with what had to be assumed.
///
/// # Errors
/// `Fault::Unsupported` for an array that is not one volume of scalars or of RGBA colours, `Fault::Geometry` for axes without a usable
/// spacing or that do not span space. The caller names the file.
pub(super) fn grid(header: &Header, warnings: &mut Vec<String>) -> Result<Grid> {
    let axes = spatial_axes(header)?;
    let oriented = axes.iter().filter(|axis| axis.direction.is_some()).count();
    let (steps, origin) = match oriented {
        3 => oriented_lattice(header, axes, warnings)?,
        0 => aligned_lattice(header, axes, warnings)?,
        _ => {
            return Err(Error::new(Fault::Geometry, "some axes of the volume have a direction and others have none")
                .element("space directions")
                .expected("three vectors"));
        }
    };
    let signs = signs_to_lps(header.space, warnings);
    let steps = DMat3::from_diagonal(signs) * steps;
    // Adding 0 makes one zero of the two.
    let origin = signs * origin + DVec3::ZERO;
    Grid::new(axes.map(|axis| axis.size), DAffine3::from_mat3_translation(steps, origin))
}

/// The three axes that extend in space. Others may only be there with one sample, or hold the components of a colour with
/// an opacity.
fn spatial_axes(header: &Header) -> Result<[&Axis; 3]> {
    let oriented = header.axes.iter().any(|axis| axis.direction.is_some());
    let is_spatial = |axis: &Axis| match axis.kind {
        Some(kind) if !kind.is_spatial() => false,
        _ if oriented => axis.direction.is_some(),
        // Without orientation and with more than three axes, those without a spacing are not spatial.
        _ => header.axes.len() == 3 || axis.spacing.is_some(),
    };
    let (spatial, other): (Vec<&Axis>, Vec<&Axis>) = header.axes.iter().partition(|axis| is_spatial(axis));
    match <[&Axis; 3]>::try_from(spatial) {
        Ok(axes) => match other.iter().filter(|axis| axis.size > 1).collect::<Vec<_>>()[..] {
            [] => Ok(axes),
            [components] if rgba::holds_components(components) => Ok(axes),
            [components] if rgba::may_hold_components(components) => Err(rgba::without_opacity(header)),
            _ => Err(not_a_volume(header, "one value at each point")),
        },
        Err(_) => Err(not_a_volume(header, "three spatial axes")),
    }
}

fn not_a_volume(header: &Header, expected: &str) -> Error {
    Error::new(Fault::Unsupported, "the array is not one volume of scalars")
        .element("sizes, kinds, space directions")
        .found(header.shape())
        .expected(expected)
}

/// Steps and origin in the world, in mm, of axes with directions.
fn oriented_lattice(header: &Header, axes: [&Axis; 3], warnings: &mut Vec<String>) -> Result<(DMat3, DVec3)> {
    let world = |vector: &[f64], what: &str| match *vector {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        // Time is the last coordinate of the spaces that have it; where the array is in time is of no matter.
        [x, y, z, t] if t == 0.0 || what == "space origin" => Ok(DVec3::new(x, y, z)),
        _ => Err(Error::new(Fault::Unsupported, "the volume does not lie in a space of three dimensions")
            .element(what)
            .found(format!("{vector:?}"))),
    };
    let mut steps = [DVec3::ZERO; 3];
    for (step, axis) in steps.iter_mut().zip(axes) {
        *step = world(axis.direction.as_deref().unwrap_or_default(), "space directions")?;
        let length = step.length();
        if let Some(spacing) = axis.spacing
            && (spacing - length).abs() > SPACING_TOLERANCE * length
        {
            return Err(Error::new(Fault::Geometry, "spacing and direction of an axis contradict each other")
                .element("spacings")
                .found(spacing.to_string())
                .expected(format!("{length}, the length of the direction, or `nan`")));
        }
    }
    let origin = match header.space_origin.as_deref() {
        Some(origin) => world(origin, "space origin")?,
        None => {
            warnings.push("there is no `space origin`: the first voxel is put at the origin".to_owned());
            DVec3::ZERO
        }
    };
    let mut scale = DVec3::ONE;
    for (i, unit) in header.space_units.iter().take(3).enumerate() {
        scale[i] = mm_per(unit, "space units", warnings);
    }
    let steps = DMat3::from_diagonal(scale) * DMat3::from_cols(steps[0], steps[1], steps[2]);
    Ok((steps, scale * origin))
}

/// Steps and origin of axes with nothing but a spacing: along the axes of the world.
fn aligned_lattice(header: &Header, axes: [&Axis; 3], warnings: &mut Vec<String>) -> Result<(DMat3, DVec3)> {
    warnings.push("there are no `space directions`: the axes are assumed to be those of the space".to_owned());
    let mut spacing = DVec3::ZERO;
    let mut origin = DVec3::ZERO;
    for (i, axis) in axes.into_iter().enumerate() {
        let given = spacing_of(axis).ok_or_else(|| {
            Error::new(Fault::Geometry, "an axis of the volume has no spacing")
                .element("spacings")
                .found(axis.spacing.map_or("none".to_owned(), |spacing| spacing.to_string()))
                .expected("a number above 0, in mm")
                .remedy("add `spacings` or `space directions` to the header")
        })?;
        let scale = mm_per(axis.unit.as_deref().unwrap_or_default(), "units", warnings);
        let first = match (axis.min, axis.center) {
            (Some(min), Some(Center::Node)) => min,
            (Some(min), Some(Center::Cell)) => min + 0.5 * given,
            _ => 0.0,
        };
        spacing[i] = scale * given;
        origin[i] = scale * first;
    }
    if let Some(given) = header.space_origin.as_deref().and_then(|v| v.get(..3)) {
        origin = DVec3::from_slice(given);
    }
    Ok((DMat3::from_diagonal(spacing), origin))
}

/// Spacing as given, or from both ends of the axis where it is said what they are the ends of.
fn spacing_of(axis: &Axis) -> Option<f64> {
    let samples = axis.size as f64;
    let spacing = match (axis.spacing, axis.min, axis.max, axis.center) {
        (Some(spacing), ..) => spacing,
        (None, Some(min), Some(max), Some(Center::Cell)) => (max - min) / samples,
        (None, Some(min), Some(max), Some(Center::Node)) if axis.size > 1 => (max - min) / (samples - 1.0),
        _ => return None,
    };
    Some(spacing).filter(|&s| s.is_finite() && s > 0.0)
}

/// Millimetres in one of these units; an unknown one is taken for millimetres, with a warning.
fn mm_per(unit: &str, field: &str, warnings: &mut Vec<String>) -> f64 {
    match unit.trim() {
        "" | "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => 1.0,
        "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => 10.0,
        "m" | "meter" | "meters" | "metre" | "metres" => 1000.0,
        "um" | "µm" | "μm" | "micron" | "microns" | "micrometer" | "micrometers" | "micrometre" | "micrometres" => {
            1e-3
        }
        "nm" | "nanometer" | "nanometers" | "nanometre" | "nanometres" => 1e-6,
        unknown => {
            warnings.push(format!("the unit {unknown:?} in `{field}` is not known: millimetres are assumed"));
            1.0
        }
    }
}

fn signs_to_lps(space: Option<Space>, warnings: &mut Vec<String>) -> DVec3 {
    let assumed = space.unwrap_or(Space { frame: Frame::LeftPosteriorSuperior, time: false });
    if space.is_none() {
        warnings.push(
            "there is no `space`: x is assumed to go to the patient's left, y to the back, z to the head".to_owned(),
        );
    } else if let Some(assumption) = assumed.assumption() {
        warnings.push(format!("the space `{}` does not say how the patient lies: {assumption}", assumed.name()));
    }
    assumed.signs_to_lps()
}
