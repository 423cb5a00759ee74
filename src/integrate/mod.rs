//! The volume rendering integral along each ray of a picture.
//!
//! [`render`] is all a caller needs, and [`Views`] those who want many pictures of one scene. A kernel is chosen once per frame
//! by type (voxels, transfer function, shading, or the atmosphere where a scene has effects of light); the choices of a
//! [`Schedule`] change how long a picture takes, and the picture by no more than its bound.

mod atmosphere;
mod classify_voxels;
mod empty_space;
pub mod exact;
mod light_volumes;
mod march;
mod occupancy;
mod reference;
mod select;
mod shade;
mod shown;
mod survey;
mod texels;
mod tiles;
mod views;

use std::fmt;

use crate::error::{Error, Fault, Result};
use crate::image::Image;
use crate::plan::{Bound, Method};
use crate::scene::{ClassifyAt, Model, Scene};
use crate::simd::Level;
use crate::volume::Volume;
use survey::Survey;

pub use views::Views;

/// A picture, and what it took.
#[derive(Debug, Clone)]
pub struct Rendered {
    /// Linear, premultiplied RGBA.
    pub image: Image,
    /// What it took.
    pub statistics: Statistics,
}

/// What a picture took; the same for any number of threads and any tile order.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// Places where the transfer function was evaluated, or pieces integrated.
    pub samples: u64,
    /// Largest bound on the error of a channel of a pixel (linear, premultiplied), where the method has one.
    pub error_bound: Option<f64>,
    /// What is known of that bound, by the kernel that ran.
    pub bound: Option<Bound>,
    /// Rays that met the volume, or haze.
    pub rays: u64,
    /// The kernel, such as `march/i16/tf2d/lit/avx2`.
    pub kernel: String,
}

/// Choices that change how long a picture takes. None changes a picture by marching. One by the exact integrator is the same for any
/// order of tiles and any registers, and within the same bound with whatever is skipped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schedule {
    /// Seed of a random order of the tiles; `None` row by row.
    pub shuffled_tiles: Option<u64>,
    /// Leap over blocks of cells in which nothing absorbs or emits.
    pub empty_space_skipping: bool,
    /// End rays of the exact integrator where all that may follow fits into what is left of the tolerance; the bound says how much that
    /// was. Where marching ends rays is a setting of its own, since it has no bound to charge.
    pub early_termination: bool,
    /// The registers that kernels are run with.
    pub level: Level,
}

impl Default for Schedule {
    fn default() -> Self {
        Schedule { shuffled_tiles: None, empty_space_skipping: true, early_termination: true, level: Level::widest() }
    }
}

/// Called from any thread with the number of pixels just finished.
pub type Progress<'a> = &'a (dyn Fn(usize) + Sync);

/// Renders a scene.
///
/// # Errors
/// `Fault::Unsupported` for anything but light of an RGBA volume, and for what classification at the voxels leaves out,
/// `Fault::Spec` for settings that are no usable numbers, `Fault::Limit` for a step so small that a picture would take for
/// ever.
pub fn render(volume: &Volume, scene: &Scene, method: &Method, progress: Progress<'_>) -> Result<Rendered> {
    render_scheduled(volume, scene, method, Schedule::default(), progress)
}

/// Renders a scene with a schedule of one's own.
///
/// # Errors
/// As [`render`].
pub fn render_scheduled(
    volume: &Volume,
    scene: &Scene,
    method: &Method,
    schedule: Schedule,
    progress: Progress<'_>,
) -> Result<Rendered> {
    Views::new(volume, scene, method, schedule)?.render(progress)
}

/// Refuses what no kernel renders.
fn check_combination(volume: &Volume, scene: &Scene, method: &Method) -> Result<()> {
    let (colors, effects) = (volume.samples().are_rgba(), &scene.effects);
    let of_light = effects.change_light() || effects.mask.is_some();
    let (marched, uneven) = (matches!(method, Method::March(_)), volume.slices().is_some());
    let at_voxels = effects.classify == ClassifyAt::Voxels && scene.model == Model::Light;
    let (what, found, remedy) = match &scene.model {
        Model::Value(_) if colors => ("an RGBA volume has no values", "a number of its values", "show its light"),
        Model::Surfaces(_) if colors => ("an RGBA volume has no values", "level surfaces of them", "show its light"),
        Model::Light if colors && scene.shading.is_some() => {
            ("an RGBA volume has no values", "shading by their gradient", "show it unshaded")
        }
        Model::Light if colors && of_light => (
            "an RGBA volume shows the light it has",
            "further effects of light, or a mask",
            "leave out all but clipping",
        ),
        Model::Light if at_voxels && of_light => (
            "classification at the voxels knows shading alone",
            "further effects of light, or a mask",
            "classify samples",
        ),
        Model::Value(_) | Model::Surfaces(_) if effects.mask.is_some() && marched => {
            ("marching does not mask values", "a mask", "use integrate: exact, which cuts rays where classes change")
        }
        Model::Light if uneven && at_voxels && !colors => {
            ("classification at the voxels needs even slices", "slices at uneven distances", "classify samples")
        }
        Model::Light if uneven && colors && marched => {
            ("marching through colours needs even slices", "slices at uneven distances", "use integrate: exact")
        }
        Model::Value(_) | Model::Surfaces(_) if uneven && marched => {
            ("marching for values needs even slices", "slices at uneven distances", "use integrate: exact")
        }
        _ => return Ok(()),
    };
    Err(Error::new(Fault::Unsupported, what).found(found).remedy(remedy))
}

/// What is pictured, and how the work is to be done.
#[derive(Clone, Copy)]
struct Frame<'a> {
    volume: &'a Volume,
    scene: &'a Scene,
    schedule: Schedule,
    /// What is found out of the volume, for all views.
    survey: &'a Survey,
    progress: Progress<'a>,
}

/// Names a kernel by the types it was made of.
struct KernelName {
    method: &'static str,
    voxel: &'static str,
    reads_gradient: bool,
    suffix: &'static str,
    shader: &'static str,
}

impl fmt::Display for KernelName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let classifier = if self.reads_gradient { "tf2d" } else { "tf1d" };
        write!(f, "{}/{}/{classifier}{}/{}", self.method, self.voxel, self.suffix, self.shader)
    }
}
