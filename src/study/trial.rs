//! One picture, rendered for its time and its errors.

use rayon::ThreadPool;

use super::clock::timed;
use crate::error::{Error, Fault, Result};
use crate::integrate::{Rendered, Schedule, render_scheduled};
use crate::plan::Method;
use crate::scene::Scene;
use crate::volume::Volume;

/// What is rendered, and how.
pub(super) struct Trial<'a> {
    pub(super) volume: &'a Volume,
    pub(super) scene: &'a Scene,
    pub(super) method: Method,
    pub(super) schedule: Schedule,
    /// Threads of its own; the common ones by default.
    pub(super) threads: Option<&'a ThreadPool>,
}

impl<'a> Trial<'a> {
    /// A trial on all threads with everything that saves time.
    pub(super) fn new(volume: &'a Volume, scene: &'a Scene, method: Method) -> Self {
        Trial { volume, scene, method, schedule: Schedule::default(), threads: None }
    }

    /// Renders: the picture, and seconds with all that a frame needs, from the baking of the transfer function on.
    pub(super) fn run(&self) -> Result<(Rendered, f64)> {
        let render = || render_scheduled(self.volume, self.scene, &self.method, self.schedule, &|_| ());
        let (rendered, seconds) = match self.threads {
            Some(pool) => pool.install(|| timed(render)),
            None => timed(render),
        };
        Ok((rendered?, seconds))
    }
}

/// A single thread to render with.
pub(super) fn one_thread() -> Result<ThreadPool> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .map_err(|cause| Error::new(Fault::Limit, "a thread could not be started").caused_by(cause))
}

/// Why a setting does not apply to a scene, if that is what the error says; other errors stay errors.
pub(super) fn reason_to_leave_out(error: Error) -> Result<String> {
    match error.fault() {
        Fault::Unsupported | Fault::Limit => Ok(error.to_string()),
        _ => Err(error),
    }
}
