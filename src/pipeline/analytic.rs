//! The volume of a formula that a spec writes.

use glam::DVec3;

use super::memory;
use crate::error::Result;
use crate::io::Scan;
use crate::spec::{AnalyticSpec, FieldSpec, PerAxis, Spec};
use crate::synthetic::analytic::{Expression, MarschnerLobb, Ramp, ScalarField, Sphere, Torus, centered_grid, sample};
use crate::volume::{Grid, Quantity};

/// Samples the formula; its values are arbitrary unless the spec says otherwise.
pub(super) fn load(spec: &Spec, analytic: &AnalyticSpec, max_bytes: Option<u64>) -> Result<Scan> {
    let field = field(spec, &analytic.field)?;
    let grid = grid(analytic).map_err(|error| spec.located("volume.analytic", error))?;
    let reading_bytes = 4 * grid.voxel_count() as u64;
    memory::refuse_beyond(max_bytes, reading_bytes, "volume.analytic.size")?;
    let volume = sample(field.as_ref(), grid, Quantity::Arbitrary)
        .map_err(|error| spec.located("volume.analytic.field", error))?;
    let facts = [("format", "synthetic, by formula".to_string()), ("formula", describe(&analytic.field))];
    let facts = facts.map(|(label, text)| (label.to_string(), text)).to_vec();
    Ok(Scan { volume, facts, warnings: Vec::new(), files: Vec::new(), reading_bytes })
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

/// The lattice; the spec has been checked, so that what is written is three numbers.
fn grid(analytic: &AnalyticSpec) -> Result<Grid> {
    let along = |lengths: &Option<PerAxis<f64>>| lengths.as_ref().and_then(PerAxis::along::<3>);
    let size = analytic.size.along::<3>().unwrap_or([0; 3]);
    let spacing_mm = match (along(&analytic.spacing_mm), along(&analytic.extent_mm)) {
        (Some(spacing_mm), _) => DVec3::from_array(spacing_mm),
        (None, extent_mm) => {
            let extent_mm = DVec3::from_array(extent_mm.unwrap_or([f64::NAN; 3]));
            extent_mm / DVec3::from_array(size.map(|n| f64::from(n.max(2) - 1)))
        }
    };
    centered_grid(size.map(|n| n as usize), spacing_mm)
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
