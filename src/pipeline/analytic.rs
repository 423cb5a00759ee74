//! The volume of a formula that a spec writes.

use glam::DVec3;

use super::memory;
use crate::error::Result;
use crate::io::Scan;
use crate::spec::{AnalyticSpec, FieldSpec, PerAxis, Spec};
use crate::synthetic::analytic::{Expression, Lattice, MarschnerLobb, Ramp, ScalarField, Sphere, Torus, sample};
use crate::volume::Quantity;

/// Samples the formula; its values are arbitrary unless the spec says otherwise.
pub(super) fn load(spec: &Spec, analytic: &AnalyticSpec, max_bytes: Option<u64>) -> Result<Scan> {
    let field = field(spec, &analytic.field)?;
    let lattice = lattice(analytic).map_err(|error| spec.located("volume.analytic", error))?;
    let reading_bytes = 4 * lattice.voxel_count() as u64;
    memory::refuse_beyond(max_bytes, reading_bytes, "volume.analytic.size")?;
    let volume = sample(field.as_ref(), lattice, Quantity::Arbitrary)
        .map_err(|error| spec.located("volume.analytic.field", error))?;
    let facts = [("format", "synthetic, by formula".to_string()), ("formula", describe(&analytic.field))];
    let facts = facts.map(|(label, text)| (label.to_string(), text)).to_vec();
    Ok(Scan { volume, labels: None, facts, warnings: Vec::new(), files: Vec::new(), reading_bytes })
}

/// The spec's formula with every default filled in.
fn field(spec: &Spec, field: &FieldSpec) -> Result<Box<dyn ScalarField>> {
    Ok(match field {
        FieldSpec::Sphere(sphere) => Box::new(Sphere {
            radius_mm: sphere.radius_mm,
            surface_value: sphere.surface_value.unwrap_or(0.0),
            value_per_mm: sphere.value_per_mm.unwrap_or(1.0),
        }),
        FieldSpec::Torus(torus) => Box::new(Torus {
            major_radius_mm: torus.major_radius_mm,
            minor_radius_mm: torus.minor_radius_mm,
            surface_value: torus.surface_value.unwrap_or(0.0),
            value_per_mm: torus.value_per_mm.unwrap_or(1.0),
        }),
        FieldSpec::Ramp(ramp) => Box::new(Ramp {
            origin_value: ramp.origin_value.unwrap_or(0.0),
            gradient_per_mm: DVec3::from_array(ramp.gradient_per_mm),
        }),
        FieldSpec::MarschnerLobb(settings) => {
            let default = MarschnerLobb::default();
            Box::new(MarschnerLobb {
                unit_mm: settings.unit_mm.unwrap_or(default.unit_mm),
                frequency: settings.frequency.unwrap_or(default.frequency),
                alpha: settings.alpha.unwrap_or(default.alpha),
            })
        }
        FieldSpec::Expression(text) => Box::new(expression(spec, text)?),
    })
}

fn expression(spec: &Spec, text: &str) -> Result<Expression> {
    Expression::parse(text).map_err(|mistake| {
        spec.error("volume.analytic.field.expression", "this is no expression in x, y and z")
            .found(format!("{} at character {} of \"{text}\"", mistake.found, mistake.character))
            .expected(mistake.expected)
    })
}

/// The lattice; the spec has been checked, so that as many numbers are written as there are axes.
fn lattice(analytic: &AnalyticSpec) -> Result<Lattice> {
    let axes = if analytic.planes_mm.is_some() { 2 } else { 3 };
    let size = analytic.size.numbers(axes).unwrap_or_default();
    let numbers = |lengths: &Option<PerAxis<f64>>| lengths.as_ref().and_then(|mm| mm.numbers(axes));
    let spacing_mm: Vec<f64> = match (numbers(&analytic.spacing_mm), numbers(&analytic.extent_mm)) {
        (Some(spacing_mm), _) => spacing_mm,
        (None, Some(extent_mm)) => extent_mm.iter().zip(&size).map(|(mm, &n)| mm / f64::from(n.max(2) - 1)).collect(),
        (None, None) => Vec::new(),
    };
    let (size, spacing_mm) = (|a: usize| size.get(a).map_or(0, |&n| n as usize), |a: usize| spacing_mm.get(a).copied());
    let mm = |a: usize| spacing_mm(a).unwrap_or(f64::NAN);
    match &analytic.planes_mm {
        None => Lattice::centered([size(0), size(1), size(2)], DVec3::new(mm(0), mm(1), mm(2))),
        Some(planes_mm) => Lattice::on_planes([size(0), size(1)], [mm(0), mm(1)], planes_mm),
    }
}

/// The formula in words, for `info`.
fn describe(field: &FieldSpec) -> String {
    match field {
        FieldSpec::Sphere(s) => format!("depth beneath a sphere of {} mm", s.radius_mm),
        FieldSpec::Torus(t) => format!("depth beneath a torus of {} and {} mm", t.major_radius_mm, t.minor_radius_mm),
        FieldSpec::Ramp(ramp) => {
            let [x, y, z] = ramp.gradient_per_mm;
            format!("ramp of ({x}, {y}, {z}) per mm")
        }
        FieldSpec::MarschnerLobb(_) => "test signal of Marschner and Lobb".to_string(),
        FieldSpec::Expression(text) => text.split_whitespace().collect::<Vec<_>>().join(" "),
    }
}
