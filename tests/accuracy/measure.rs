//! A picture by the oracle, and pictures by the exact integrator held against it.

use std::time::Instant;

use pellucid::integrate::exact::{Precision, Traced, tracer};
use pellucid::oracle::Oracle;
use pellucid::{Scene, Volume};
use rayon::prelude::*;

/// Every pixel by the oracle.
pub(crate) struct Truth {
    pixels: Vec<[f64; 4]>,
    pub(crate) seconds: f64,
}

impl Truth {
    pub(crate) fn compute(volume: &Volume, scene: &Scene) -> Self {
        let started = Instant::now();
        let pixels = Oracle::new(volume, scene).render(|_| ());
        Truth { pixels, seconds: started.elapsed().as_secs_f64() }
    }
}

/// What a picture at a tolerance is like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Row {
    pub(crate) max_error: f64,
    /// Largest ratio of a pixel's error to the bound reported for it.
    pub(crate) max_of_bound: f64,
    /// Pixels with a larger error than the tolerance.
    pub(crate) above_tolerance: usize,
    /// Pixels with a larger error than their bound.
    pub(crate) above_bound: usize,
    pub(crate) pixels: usize,
    pub(crate) seconds: f64,
}

impl Row {
    /// True if no tolerance of 1e-3 or more is exceeded, and no bound without shading.
    pub(crate) fn keeps_its_promise(&self, tolerance: f64, shaded: bool) -> bool {
        (tolerance < 1e-3 || self.above_tolerance == 0) && (shaded || self.above_bound == 0)
    }
}

/// Renders by the exact integrator in f32, on all threads, and compares every pixel.
pub(crate) fn measure(volume: &Volume, scene: &Scene, truth: &Truth, tolerance: f64) -> Row {
    let [width, height] = scene.camera.size();
    let started = Instant::now();
    let tracer = tracer(volume, scene, tolerance, Precision::Single);
    let pixel = |i: usize| tracer.trace(&scene.camera.pixel_ray(i % width, i / width));
    let traced: Vec<Option<Traced>> = (0..width * height).into_par_iter().map(pixel).collect();
    let seconds = started.elapsed().as_secs_f64();
    let mut row =
        Row { max_error: 0.0, max_of_bound: 0.0, above_tolerance: 0, above_bound: 0, pixels: traced.len(), seconds };
    for (traced, truth) in traced.iter().zip(&truth.pixels) {
        let (error, bound) = error_and_bound(traced.as_ref(), truth);
        row.max_error = row.max_error.max(error);
        row.above_tolerance += usize::from(error > tolerance);
        row.above_bound += usize::from(error > bound);
        if error > 0.0 {
            row.max_of_bound = row.max_of_bound.max(error / bound);
        }
    }
    row
}

/// Largest error of a channel, infinite if one is not a number; a ray that misses claims to see nothing, without error.
fn error_and_bound(traced: Option<&Traced>, truth: &[f64; 4]) -> (f64, f64) {
    let (found, bound) = traced.map_or(([0.0; 4], 0.0), |t| {
        let [r, g, b] = t.radiance;
        ([r, g, b, t.opacity], t.bound)
    });
    let off = found.iter().zip(truth).map(|(x, y)| (x - y).abs());
    (off.map(|d| if d.is_nan() { f64::INFINITY } else { d }).fold(0.0, f64::max), bound)
}
