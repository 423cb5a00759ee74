//! The exact integrator: a tolerance in, a picture within it out, with no step size.
//!
//! In a cell the value along a ray is an exact cubic, and so is the gradient magnitude. The segment is cut where a cubic
//! crosses a knot of the transfer function ([`splits`]); between cuts extinction and emission are polynomials
//! ([`medium`]), optical depth is exact, and the emitted light has a proven error ([`piece`]). Pieces are halved until the
//! ray keeps within its [`budget`]. This scalar kernel, in f64, is the twin of every faster one.

mod budget;
mod cells;
mod lattice;
mod medium;
mod piece;
mod ray;
mod shade;
mod splits;
mod values;

use std::fmt;

use crate::classify::{Baked, bake};
use crate::error::{Error, Fault, Result};
use crate::field::Voxel;
use crate::math::Real;
use crate::plan::Exact;
use crate::scene::{Ray, Scene, Shading};
use crate::volume::{Samples, Volume};

use super::tiles::{self, Radiance};
use super::{Rendered, Statistics};
use lattice::Lattice;
use medium::Medium;
use ray::{Brightest, Frame};
use shade::{Lit, Unlit};
use splits::Splits;

pub use ray::Traced;

/// Renders within a tolerance.
///
/// # Errors
/// `Fault::Spec` for a tolerance that is not a number above 0.
pub(super) fn render(frame: &super::Frame<'_>, settings: &Exact) -> Result<Rendered> {
    let tolerance = settings.tolerance;
    if !(tolerance.is_finite() && tolerance > 0.0) {
        return Err(Error::new(Fault::Spec, "the tolerance is not usable")
            .element("integrate.exact.tolerance")
            .found(tolerance.to_string())
            .expected("a finite number above 0, such as 1/255"));
    }
    let tracer = tracer(frame.volume, frame.scene, tolerance, Precision::Single);
    let (image, tally) = tiles::render(
        frame,
        || (),
        |(), column, row| {
            let traced = tracer.trace(&frame.scene.camera.pixel_ray(column, row))?;
            Some(Radiance {
                color: traced.radiance.map(|x| x as f32),
                transmittance: traced.transmittance as f32,
                samples: traced.pieces,
                error_bound: traced.bound,
            })
        },
    );
    let statistics = Statistics {
        samples: tally.samples,
        error_bound: Some(tally.error_bound),
        rays: tally.rays,
        kernel: tracer.kernel().to_string(),
    };
    Ok(Rendered { image, statistics })
}

/// In which arithmetic a kernel integrates its pieces; rays are set up and summed in f64 by both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// f32 inside cells.
    Single,
    /// f64 throughout: the twin.
    Double,
}

/// Traces rays of one frame; the kernel behind it is chosen once, by type.
pub trait Tracer: Sync {
    /// The light of a ray, with its bound; `None` if it misses the volume.
    fn trace(&self, ray: &Ray) -> Option<Traced>;
    /// What runs, such as `exact/i16/tf2d/lit/f32`.
    fn kernel(&self) -> &str;
}

/// The exact integrator for a scene, within `tolerance` of a channel of a pixel.
pub fn tracer<'a>(volume: &'a Volume, scene: &'a Scene, tolerance: f64, precision: Precision) -> Box<dyn Tracer + 'a> {
    match precision {
        Precision::Single => for_medium::<f32>(volume, scene, tolerance),
        Precision::Double => for_medium::<f64>(volume, scene, tolerance),
    }
}

fn for_medium<'a, R: Real>(volume: &'a Volume, scene: &'a Scene, tolerance: f64) -> Box<dyn Tracer + 'a> {
    match bake::<R>(&scene.transfer_function, volume.rescale()) {
        Baked::OneD(medium) => for_samples(volume, scene, tolerance, medium, "tf1d"),
        Baked::TwoD(medium) => for_samples(volume, scene, tolerance, medium, "tf2d"),
    }
}

fn for_samples<'a, R: Real, M: Medium<R> + 'a>(
    volume: &'a Volume,
    scene: &'a Scene,
    tolerance: f64,
    medium: M,
    name: &str,
) -> Box<dyn Tracer + 'a> {
    let brightest = Brightest::of(scene);
    let grid = volume.grid();
    let lit = if scene.shading.is_some() { "lit" } else { "unlit" };
    let precision = if R::EPSILON.to_f64() > 1e-10 { "f32" } else { "f64" };
    let kernel = |samples| format!("exact/{samples}/{name}/{lit}/{precision}");
    let shading = scene.shading.as_ref();
    match volume.samples() {
        Samples::I16(samples) => {
            let lattice = Lattice::new(volume, samples);
            let frame = Frame { grid, lattice, medium, tolerance, brightest };
            Box::new(Kernel { frame, shading, name: kernel(i16::NAME), real: std::marker::PhantomData::<R> })
        }
        Samples::F32(samples) => {
            let lattice = Lattice::new(volume, samples);
            let frame = Frame { grid, lattice, medium, tolerance, brightest };
            Box::new(Kernel { frame, shading, name: kernel(f32::NAME), real: std::marker::PhantomData::<R> })
        }
    }
}

struct Kernel<'a, R, V, M> {
    frame: Frame<'a, V, M>,
    shading: Option<&'a Shading>,
    name: String,
    real: std::marker::PhantomData<R>,
}

impl<R: Real, V: Voxel, M: Medium<R>> Tracer for Kernel<'_, R, V, M> {
    fn trace(&self, ray: &Ray) -> Option<Traced> {
        let mut splits = Splits::<R>::default();
        match self.shading {
            None => self.frame.trace(ray, &Unlit, &mut splits),
            Some(shading) => {
                let lit = Lit::<R>::new(shading, ray.direction, self.frame.brightest.color);
                self.frame.trace(ray, &lit, &mut splits)
            }
        }
    }

    fn kernel(&self) -> &str {
        &self.name
    }
}

impl<R, V, M> fmt::Debug for Kernel<'_, R, V, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}
