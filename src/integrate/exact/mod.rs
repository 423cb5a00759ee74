//! The exact integrator: a tolerance in, a picture within it out, with no step size.
//!
//! In a cell the value along a ray is an exact cubic, and so is the gradient magnitude. The segment is cut where a cubic
//! crosses a knot of the transfer function (`splits`); between cuts extinction and emission are polynomials
//! (`medium`), optical depth is exact, and the emitted light has a proven error (`piece`). Pieces are halved until the
//! ray keeps within its `budget`. Where extinction and emission are given at the voxels (`voxels`) they are cubics
//! themselves, and nothing is cut. This scalar kernel, in f64, is the twin of every faster one.

mod budget;
mod cells;
mod lattice;
mod medium;
mod models;
mod piece;
mod ray;
mod shade;
mod splits;
mod values;
mod voxels;

use crate::classify::{Baked, bake};
use crate::error::{Error, Fault, Result};
use crate::field::Voxel;
use crate::math::Real;
use crate::plan::Exact;
use crate::scene::{ClassifyAt, Model, Ray, Scene, Shading};
use crate::volume::{Samples, Volume};

use super::classify_voxels::classify_voxels;
use super::texels::{Component, Rgba};
use super::tiles::{self, Radiance};
use super::{Rendered, Statistics};
use lattice::Lattice;
use medium::{Classified, Medium};
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
                color: traced.radiance,
                transmittance: traced.transmittance,
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

/// The exact integrator for a scene, within `tolerance` of a channel of a pixel. An RGBA volume shows its light, whatever
/// else the scene asks for; [`render`](super::render) refuses what an RGBA volume cannot show.
pub fn tracer<'a>(volume: &'a Volume, scene: &'a Scene, tolerance: f64, precision: Precision) -> Box<dyn Tracer + 'a> {
    match volume.samples() {
        Samples::I16(samples) => for_samples(volume, scene, samples, tolerance, precision),
        Samples::F32(samples) => for_samples(volume, scene, samples, tolerance, precision),
        Samples::Rgba8(texels) => for_colors(volume, texels, tolerance),
        Samples::Rgba16(texels) => for_colors(volume, texels, tolerance),
    }
}

fn for_colors<'a, T: Component>(volume: &'a Volume, texels: &'a [[T; 4]], tolerance: f64) -> Box<dyn Tracer + 'a> {
    let Some(encoding) = volume.rgba_encoding() else { unreachable!("colours are understood in some way") };
    voxels::tracer(volume.grid(), Rgba::new(texels, encoding), tolerance, format!("exact/{}/unlit/f64", T::NAME))
}

fn for_samples<'a, V: Voxel>(
    volume: &'a Volume,
    scene: &'a Scene,
    samples: &'a [V],
    tolerance: f64,
    precision: Precision,
) -> Box<dyn Tracer + 'a> {
    let lattice = Lattice::new(volume, samples);
    let frame = Frame { grid: volume.grid(), tolerance, brightest: Brightest::of(scene) };
    let (tf, rescale, shading) = (&scene.transfer_function, volume.rescale(), scene.shading.as_ref());
    match &scene.model {
        Model::Light if scene.effects.classify == ClassifyAt::Voxels => {
            let classifier = if tf.reads_gradient() { "tf2d" } else { "tf1d" };
            let lit = if shading.is_some() { "lit" } else { "unlit" };
            let name = format!("exact/voxels/{classifier}/{lit}/f64");
            return voxels::tracer(volume.grid(), classify_voxels(volume, scene), tolerance, name);
        }
        Model::Light => {}
        Model::Value(model) => {
            let (grid, rescale) = (volume.grid(), volume.rescale());
            let trace = move |ray: &Ray| models::show_value(&lattice, grid, rescale, model, ray);
            return Box::new(Direct { trace, name: format!("exact/{}/value/f64", V::NAME) });
        }
        Model::Surfaces(surfaces) => {
            let (grid, rescale, shading) = (volume.grid(), volume.rescale(), scene.shading.as_ref());
            let trace = move |ray: &Ray| Some(models::show_surfaces(&lattice, grid, rescale, surfaces, shading, ray));
            return Box::new(Direct { trace, name: format!("exact/{}/surfaces/f64", V::NAME) });
        }
    }
    let double = bake::<f64>(tf, rescale);
    // Across an interval this narrow, the rounding of a value in f32 would cost more than rounding may.
    let too_narrow = double.narrowest() < SHARE_OF_ROUNDING * f64::from(f32::EPSILON) / tolerance;
    let precision = if too_narrow { Precision::Double } else { precision };
    let name = |classifier: &str| {
        let lit = if shading.is_some() { "lit" } else { "unlit" };
        let real = if precision == Precision::Single { "f32" } else { "f64" };
        format!("exact/{}/{classifier}/{lit}/{real}", V::NAME)
    };
    match (double, bake::<f32>(tf, rescale)) {
        (Baked::OneD(double), Baked::OneD(single)) => {
            let (double, single) = (classified(lattice, double), classified(lattice, single));
            Box::new(Kernel { frame, shading, double, single, precision, name: name("tf1d") })
        }
        (Baked::TwoD(double), Baked::TwoD(single)) => {
            let (double, single) = (classified(lattice, double), classified(lattice, single));
            Box::new(Kernel { frame, shading, double, single, precision, name: name("tf2d") })
        }
        _ => unreachable!("both precisions bake the same transfer function"),
    }
}

fn classified<V, C>(lattice: Lattice<'_, V>, classifier: C) -> Classified<'_, V, C> {
    Classified { lattice, classifier }
}

/// f32 is used where an interval between knots is at least this many roundings wide, over the tolerance. On public scans a
/// ray's error by rounding was up to a thirtieth of a rounding over that width; this keeps it within the budget's share.
const SHARE_OF_ROUNDING: f64 = 16.0;

/// A kernel that needs nothing but its ray.
struct Direct<F> {
    trace: F,
    name: String,
}

impl<F: Fn(&Ray) -> Option<Traced> + Sync> Tracer for Direct<F> {
    fn trace(&self, ray: &Ray) -> Option<Traced> {
        (self.trace)(ray)
    }

    fn kernel(&self) -> &str {
        &self.name
    }
}

/// A kernel for one type of medium, in both precisions.
struct Kernel<'a, D, S> {
    frame: Frame<'a>,
    shading: Option<&'a Shading>,
    double: D,
    single: S,
    precision: Precision,
    name: String,
}

impl<D: Medium<f64>, S: Medium<f32>> Kernel<'_, D, S> {
    /// Traces a ray, and says whether rounding might have misplaced a cut.
    fn trace_in<R: Real, M: Medium<R>>(&self, medium: &M, ray: &Ray) -> Option<(Traced, bool)> {
        let mut splits = Splits::<R>::default();
        let traced = match self.shading {
            None => self.frame.trace(ray, medium, &Unlit, &mut splits),
            Some(shading) => {
                let lit = Lit::<R>::new(shading, ray.direction, self.frame.brightest.color);
                self.frame.trace(ray, medium, &lit, &mut splits)
            }
        };
        traced.map(|t| (t, splits.ill_conditioned))
    }
}

impl<D: Medium<f64>, S: Medium<f32>> Tracer for Kernel<'_, D, S> {
    fn trace(&self, ray: &Ray) -> Option<Traced> {
        if self.precision == Precision::Single {
            let (traced, ill_conditioned) = self.trace_in::<f32, S>(&self.single, ray)?;
            if !ill_conditioned {
                return Some(traced);
            }
        }
        self.trace_in::<f64, D>(&self.double, ray).map(|(traced, _)| traced)
    }

    fn kernel(&self) -> &str {
        &self.name
    }
}
