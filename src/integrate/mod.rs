//! The volume rendering integral along each ray of a picture.
//!
//! [`render`] is all a caller needs. A kernel is chosen once per frame by type (voxels, transfer function, shading, or the
//! atmosphere where a scene has effects of light); the choices of a [`Schedule`] change how long a picture takes, never the
//! picture.

mod atmosphere;
mod chord;
mod empty_space;
pub mod exact;
mod light_volumes;
mod march;
mod reference;
mod select;
mod shade;
mod tiles;

use std::fmt;

use crate::error::Result;
use crate::image::Image;
use crate::plan::Method;
use crate::scene::Scene;
use crate::volume::Volume;

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
    /// Largest bound on the error of a channel of a pixel (linear, premultiplied), where the method proves one.
    pub error_bound: Option<f64>,
    /// Rays that met the volume, or haze.
    pub rays: u64,
    /// The kernel, such as `march/i16/tf2d/lit`.
    pub kernel: String,
}

/// Choices that change how long a picture takes, never the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schedule {
    /// Seed of a random order of the tiles; `None` row by row.
    pub shuffled_tiles: Option<u64>,
    /// Leap over blocks of cells in which nothing absorbs or emits.
    pub empty_space_skipping: bool,
}

impl Default for Schedule {
    fn default() -> Self {
        Schedule { shuffled_tiles: None, empty_space_skipping: true }
    }
}

/// Called from any thread with the number of pixels just finished.
pub type Progress<'a> = &'a (dyn Fn(usize) + Sync);

/// Renders a scene.
///
/// # Errors
/// `Fault::Unsupported` for marching what is not light, `Fault::Spec` for settings that are no usable numbers, `Fault::Limit` for a step so small that a picture would take for
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
    let frame = Frame { volume, scene, schedule, progress };
    match method {
        Method::March(settings) => {
            march::check(settings, scene, volume.grid())?;
            select::march(&frame, settings)
        }
        Method::Exact(settings) => exact::render(&frame, settings),
        Method::Reference => Ok(reference::render(&frame)),
    }
}

/// What is pictured, and how the work is to be done.
#[derive(Clone, Copy)]
struct Frame<'a> {
    volume: &'a Volume,
    scene: &'a Scene,
    schedule: Schedule,
    progress: Progress<'a>,
}

/// Names a kernel by the types it was made of.
struct KernelName {
    method: &'static str,
    voxel: &'static str,
    reads_gradient: bool,
    shader: &'static str,
}

impl fmt::Display for KernelName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let classifier = if self.reads_gradient { "tf2d" } else { "tf1d" };
        write!(f, "{}/{}/{classifier}/{}", self.method, self.voxel, self.shader)
    }
}
