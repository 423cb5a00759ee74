//! The integrators that are verified, as functions of one shape.

use rayon::prelude::*;

use super::Integrator;
use super::manufactured::rays;
use super::steps::Orders;
use crate::error::Result;
use crate::integrate;
use crate::integrate::exact::{Precision, tracer};
use crate::oracle::Oracle;
use crate::plan::{March, Method, SampleRule};
use crate::scene::Scene;
use crate::volume::Volume;

/// The rules of the march.
pub(super) const RULES: [(&str, Orders, SampleRule); 3] = [
    ("march/left", Orders::plain(1.0), SampleRule::Left),
    ("march/midpoint", Orders::plain(2.0), SampleRule::Midpoint),
    ("march/trapezoid", Orders::plain(2.0), SampleRule::Trapezoid),
];

/// A march by a rule.
pub(super) fn march(rule: SampleRule) -> impl Fn(&Volume, &Scene, f64) -> Result<Vec<[f64; 4]>> {
    move |volume, scene, step_mm| marched(volume, scene, March::plain(rule, step_mm))
}

/// A picture by marching.
pub(super) fn marched(volume: &Volume, scene: &Scene, settings: March) -> Result<Vec<[f64; 4]>> {
    let rendered = integrate::render(volume, scene, &Method::March(settings), &|_| ())?;
    Ok(rendered.image.pixels().iter().map(|pixel| pixel.map(f64::from)).collect())
}

/// A picture by the exact integrator.
pub(super) fn exact(volume: &Volume, scene: &Scene, tolerance: f64, precision: Precision) -> Vec<[f64; 4]> {
    let tracer = tracer(volume, scene, tolerance, precision);
    let rays: Vec<_> = rays(scene).collect();
    let pixel = |ray: &crate::scene::Ray| {
        tracer.trace(ray).map_or([0.0; 4], |traced| {
            let [r, g, b] = traced.radiance;
            [r, g, b, 1.0 - traced.transmittance]
        })
    };
    rays.par_iter().map(pixel).collect()
}

/// A picture whose error is far below the differences between windows of neighbouring sizes.
pub(super) fn exact_enough(volume: &Volume, scene: &Scene, _step_mm: f64) -> Result<Vec<[f64; 4]>> {
    Ok(exact(volume, scene, 1e-7, Precision::Double))
}

/// Integrators that need no step, with the difference allowed between two of their pictures.
pub(super) fn without_step() -> [(&'static str, f64, Box<Integrator<'static>>); 3] {
    [
        ("oracle", 1e-12, Box::new(|v, s, _| Ok(Oracle::new(v, s).render(|_| ())))),
        ("exact/f64 at 1e-6", 2e-6, Box::new(|v, s, _| Ok(exact(v, s, 1e-6, Precision::Double)))),
        ("exact/f32 at 1e-4", 2e-4, Box::new(|v, s, _| Ok(exact(v, s, 1e-4, Precision::Single)))),
    ]
}
