//! The exact integrator: a tolerance in, a picture within it out, with no step size.
//!
//! In a cell the value along a ray is an exact cubic, and so is the gradient magnitude. The segment is cut where a cubic
//! crosses a knot of the transfer function (`splits`); between cuts extinction and emission are polynomials
//! (`medium`), optical depth is exact, and the emitted light has a proven error (`piece`). Pieces are halved until the
//! ray keeps within its `budget`. Where extinction and emission are given at the voxels (`voxels`) they are cubics
//! themselves, and nothing is cut. This scalar kernel, in f64, is the twin of every faster one. Scenes with effects of light
//! (`atmosphere`) or a mask (`masked`) are integrated in f64 alone; others in f32, in registers (`stream`) where the lattice is even
//! and the lights are few.

mod atmosphere;
mod budget;
mod cells;
mod depth;
mod lattice;
mod linear;
mod masked;
mod medium;
mod models;
mod nearest;
mod peak;
mod piece;
mod ray;
mod shade;
mod shown;
mod splits;
mod stream;
mod toward_light;
mod values;
mod voxels;

use crate::classify::{Baked, BakedAlike, Classifier, OneD, TwoD, bake, bake_alike};
use crate::error::{Error, Fault, Result};
use crate::field::Voxel;
use crate::math::Real;
use crate::plan::{Bound, Exact, ExactKernel};
use crate::scene::{ClassifyAt, Model, Ray, Rays, Scene, Shading};
use crate::simd::{Level, Pairs};
use crate::volume::{Samples, Volume};

use super::classify_voxels::classify_voxels;
use super::light_volumes::{LightVolumes, Transmittances};
use super::occupancy::Occupancy;
use super::texels::{Component, Rgba};
use super::tiles::{self, Radiance};
use super::{Rendered, Schedule, Statistics};
use cells::Domain;
use depth::Extinction;
use lattice::Lattice;
use masked::Masked;
use medium::{Classified, Medium};
use nearest::Nearest;
use ray::{Brightest, Frame};
use shade::{Lit, Unlit};
use shown::Shown;
use splits::Splits;
use stream::{Estimate, Fields, Function, Lighting, OfValue, OfValueAndMagnitude, Read, Stream, Voxels};

pub use ray::Traced;
pub(super) use toward_light::{TowardLight, toward_light};

/// Checks settings.
///
/// # Errors
/// `Fault::Spec` for a tolerance that is not a number above 0.
pub(super) fn check(settings: &Exact) -> Result<()> {
    let tolerance = settings.tolerance;
    if tolerance.is_finite() && tolerance > 0.0 {
        return Ok(());
    }
    Err(Error::new(Fault::Spec, "the tolerance is not usable")
        .element("integrate.exact.tolerance")
        .found(tolerance.to_string())
        .expected("a finite number above 0, such as 1/255"))
}

/// The tracer for a scene; of views from several cameras, any is as good as the others.
pub(super) fn frame_tracer<'a>(
    schedule: Schedule,
    volume: &'a Volume,
    scene: &'a Scene,
    settings: &Exact,
) -> Box<dyn Tracer + 'a> {
    let precision = match settings.bound {
        Bound::Estimated => Precision::Estimated,
        Bound::Proven => Precision::Single,
    };
    scheduled(schedule, volume, scene, settings.tolerance, precision)
}

/// Renders with a tracer.
pub(super) fn render(frame: &super::Frame<'_>, tracer: &dyn Tracer) -> Rendered {
    let (image, tally) = tiles::render_whole(frame, &|rays, put| {
        tracer.trace_all(rays, &mut |n, traced| {
            let Traced { radiance, transmittance, pieces, bound, .. } = traced;
            put(n, Radiance { color: radiance, transmittance, samples: pieces, error_bound: bound });
        });
    });
    let statistics = Statistics {
        samples: tally.samples,
        error_bound: Some(tally.error_bound),
        bound: Some(tracer.bound()),
        rays: tally.rays,
        kernel: tracer.kernel().to_string(),
    };
    Rendered { image, statistics }
}

/// In which arithmetic a kernel integrates its pieces, and what is known of their errors; rays are set up and summed in f64 by
/// all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// f32 inside cells; what shading misses between the nodes of pieces is estimated, where there is a kernel for that.
    Estimated,
    /// f32 inside cells.
    Single,
    /// f64 throughout: the twin.
    Double,
}

/// Traces rays of one frame; the kernel behind it is chosen once, by type.
pub trait Tracer: Sync {
    /// The light of a ray, with its bound; `None` if it misses the volume.
    fn trace(&self, ray: &Ray) -> Option<Traced>;
    /// The light of many rays, each as if it were traced alone: `ended` takes it, in any order and by the number of the ray, of
    /// those that meet the volume.
    fn trace_all(&self, rays: &Rays, ended: &mut dyn FnMut(usize, Traced)) {
        for n in 0..rays.len() {
            if let Some(traced) = self.trace(&rays.get(n)) {
                ended(n, traced);
            }
        }
    }

    /// What is known of the bounds of its rays, but for rounding, which is estimated by all.
    fn bound(&self) -> Bound {
        Bound::Proven
    }

    /// What runs, such as `exact/i16/tf2d/lit/f32`.
    fn kernel(&self) -> &str;
}

/// The exact integrator for a scene, within `tolerance` of a channel of a pixel. An RGBA volume shows its light, whatever
/// else the scene asks for; [`render`](super::render) refuses what an RGBA volume cannot show.
pub fn tracer<'a>(volume: &'a Volume, scene: &'a Scene, tolerance: f64, precision: Precision) -> Box<dyn Tracer + 'a> {
    tracer_at(Level::widest(), volume, scene, tolerance, precision)
}

/// The same with the registers of a level, for scenes that have a kernel for them.
pub fn tracer_at<'a>(
    level: Level,
    volume: &'a Volume,
    scene: &'a Scene,
    tolerance: f64,
    precision: Precision,
) -> Box<dyn Tracer + 'a> {
    scheduled(Schedule { level, ..Schedule::default() }, volume, scene, tolerance, precision)
}

fn scheduled<'a>(
    schedule: Schedule,
    volume: &'a Volume,
    scene: &'a Scene,
    tolerance: f64,
    precision: Precision,
) -> Box<dyn Tracer + 'a> {
    match volume.samples() {
        Samples::I16(samples) => for_samples(schedule, volume, scene, samples, tolerance, precision),
        Samples::F32(samples) => for_samples(schedule, volume, scene, samples, tolerance, precision),
        Samples::Rgba8(texels) => for_colors(schedule, volume, scene, texels, tolerance),
        Samples::Rgba16(texels) => for_colors(schedule, volume, scene, texels, tolerance),
    }
}

fn for_colors<'a, T: Component>(
    schedule: Schedule,
    volume: &'a Volume,
    scene: &'a Scene,
    texels: &'a [[T; 4]],
    tolerance: f64,
) -> Box<dyn Tracer + 'a> {
    let Some(encoding) = volume.rgba_encoding() else { unreachable!("colours are understood in some way") };
    let name = format!("exact/{}/unlit/f64", T::NAME);
    voxels::tracer(schedule, volume, scene, Rgba::new(texels, encoding), tolerance, name)
}

fn for_samples<'a, V: Voxel + Pairs>(
    schedule: Schedule,
    volume: &'a Volume,
    scene: &'a Scene,
    samples: &'a [V],
    tolerance: f64,
    precision: Precision,
) -> Box<dyn Tracer + 'a> {
    let lattice = Lattice::new(volume, samples);
    let shown = Shown::new(volume, scene);
    let rescale = volume.rescale();
    match &scene.model {
        Model::Light if scene.effects.classify == ClassifyAt::Voxels => {
            let classifier = if scene.transfer_function.reads_gradient() { "tf2d" } else { "tf1d" };
            let lit = if scene.shading.is_some() { "lit" } else { "unlit" };
            let name = format!("exact/voxels/{classifier}/{lit}/f64");
            return voxels::tracer(schedule, volume, scene, classify_voxels(volume, scene), tolerance, name);
        }
        Model::Value(model) if !model.of.reads_transfer_function() => {
            let trace = move |ray: &Ray| models::show_value(&lattice, &shown, rescale, model, ray);
            return Box::new(Direct { trace, name: format!("exact/{}/{}/f64", V::NAME, model.of.name()) });
        }
        Model::Surfaces(surfaces) => {
            let trace = move |ray: &Ray| Some(models::show_surfaces(&lattice, &shown, rescale, surfaces, scene, ray));
            return Box::new(Direct { trace, name: format!("exact/{}/surfaces/f64", V::NAME) });
        }
        Model::Light | Model::Value(_) => {}
    }
    let tf = &scene.transfer_function;
    let of = Of { volume, scene, tolerance, voxel: V::NAME, schedule };
    if let Some((mask, classes)) = scene.effects.mask.as_ref().zip(volume.classes()) {
        let nearest = Nearest::new(classes, volume.grid());
        // In f64 alone, which keeps the number of kernels small.
        return match bake_alike::<f64>(&mask.functions(classes.count(), tf), rescale) {
            BakedAlike::OneD(all) => {
                let media = all.into_iter().map(|one| Classified { lattice, classifier: one }).collect();
                of.tracer("tf1d-masked", Masked { media, nearest }, None::<Classified<'a, V, OneD<f32>>>)
            }
            BakedAlike::TwoD(all) => {
                let media = all.into_iter().map(|one| Classified { lattice, classifier: one }).collect();
                of.tracer("tf2d-masked", Masked { media, nearest }, None::<Classified<'a, V, TwoD<f32>>>)
            }
        };
    }
    let kernel = match precision {
        Precision::Estimated => ExactKernel::of(scene, volume, &Exact { tolerance, bound: Bound::Estimated }),
        Precision::Single => ExactKernel::of(scene, volume, &Exact { tolerance, bound: Bound::Proven }),
        Precision::Double => ExactKernel::Double,
    };
    let baked = (bake::<f64>(tf, rescale), bake::<f32>(tf, rescale));
    if let ExactKernel::InRegisters(bound) = kernel
        && let Some(voxels) = Voxels::new(volume, samples)
    {
        return match baked {
            (Baked::OneD(double), Baked::OneD(other)) => {
                let double = Classified { lattice, classifier: double };
                of.stream("tf1d", bound, voxels, OfValue::new(&other, tolerance), &other, double)
            }
            (Baked::TwoD(double), Baked::TwoD(other)) => {
                let double = Classified { lattice, classifier: double };
                of.stream("tf2d", bound, voxels, OfValueAndMagnitude::new(&other, tolerance), &other, double)
            }
            _ => unreachable!("both precisions bake the same transfer function"),
        };
    }
    let single = kernel != ExactKernel::Double;
    match baked {
        (Baked::OneD(double), Baked::OneD(other)) => {
            let other = single.then_some(Classified { lattice, classifier: other });
            of.tracer("tf1d", Classified { lattice, classifier: double }, other)
        }
        (Baked::TwoD(double), Baked::TwoD(other)) => {
            let other = single.then_some(Classified { lattice, classifier: other });
            of.tracer("tf2d", Classified { lattice, classifier: double }, other)
        }
        _ => unreachable!("both precisions bake the same transfer function"),
    }
}

/// What a kernel is for.
struct Of<'a> {
    volume: &'a Volume,
    scene: &'a Scene,
    tolerance: f64,
    voxel: &'static str,
    schedule: Schedule,
}

impl<'a> Of<'a> {
    /// The fast kernel.
    fn stream<V, T, C, D, const F: usize>(
        self,
        name: &str,
        bound: Bound,
        voxels: Voxels<'a, V>,
        function: T,
        classifier: &C,
        double: D,
    ) -> Box<dyn Tracer + 'a>
    where
        V: Voxel + Pairs,
        T: Function<F> + 'a,
        C: Classifier<f32>,
        D: Medium<f64> + 'a,
        Read: Fields<F>,
    {
        let Of { volume, scene, tolerance, voxel, schedule: Schedule { level, empty_space_skipping, .. } } = self;
        let everything = [0.0, f32::MAX];
        let occupancy = match empty_space_skipping {
            true => voxels.occupancy(|range| !classifier.is_empty(range, everything)),
            false => Occupancy::full(volume.grid().dims()),
        };
        let brightest = Brightest::of(scene);
        let lighting = scene.shading.as_ref().and_then(|shading| Lighting::new(shading, brightest.color));
        let estimate = (bound == Bound::Estimated).then(|| Estimate::within(tolerance));
        let tolerance = estimate.map_or(tolerance, |estimate| estimate.proven);
        let frame = self.frame(tolerance, brightest);
        let (grid, clip) = (volume.grid(), &scene.effects.clip);
        let lit = match (&lighting, estimate) {
            (None, _) => "unlit",
            (Some(_), None) => "lit-proven",
            (Some(_), Some(_)) => "lit",
        };
        let name = format!("exact/{voxel}/{name}/{lit}/{level}");
        Box::new(Stream { level, frame, grid, clip, voxels, occupancy, function, lighting, estimate, double, name })
    }

    /// What all rays share.
    fn frame(&self, tolerance: f64, brightest: Brightest) -> Frame<'a> {
        let domain = Domain::new(self.volume, self.scene);
        Frame { domain, tolerance, brightest, ends_early: self.schedule.early_termination }
    }

    /// The kernel for a medium: by its effects of light, its shading, or the optical depth alone. `single` is the same medium
    /// in f32, where that is enough; effects and numbers are computed in f64 alone.
    fn tracer<D: Extinction + 'a, S: Medium<f32> + 'a>(
        self,
        classifier: &str,
        double: D,
        single: Option<S>,
    ) -> Box<dyn Tracer + 'a> {
        let Of { volume, scene, tolerance, voxel, .. } = self;
        let name = |what: &str, real: &str| format!("exact/{voxel}/{classifier}/{what}/{real}");
        if let Model::Value(model) = &scene.model {
            let domain = Domain::new(volume, scene);
            let trace = move |ray: &Ray| models::show_depth(&double, &domain, model, ray);
            return Box::new(Direct { trace, name: name(model.of.name(), "f64") });
        }
        let frame = self.frame(tolerance, Brightest::of(scene));
        if scene.effects.change_light() {
            let lights = LightVolumes::new(volume, scene, &Transmittances::unknown(volume, scene));
            let name = name("atmosphere", "f64");
            return Box::new(atmosphere::Kernel { frame, scene, medium: double, lights, name });
        }
        let shading = scene.shading.as_ref();
        let name = name(if shading.is_some() { "lit" } else { "unlit" }, if single.is_some() { "f32" } else { "f64" });
        Box::new(Kernel { frame, shading, double, single, name })
    }
}

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
    /// `None` to trace in f64 throughout.
    single: Option<S>,
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
        if let Some(single) = &self.single {
            let (traced, ill_conditioned) = self.trace_in::<f32, S>(single, ray)?;
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
