//! Many views of one scene with one set-up.

use std::sync::OnceLock;

use super::exact::{self, Tracer};
use super::survey::Survey;
use super::{Frame, Progress, Rendered, Schedule, check_combination, march, reference, select};
use crate::error::Result;
use crate::plan::{Method, SampleRule};
use crate::scene::{Camera, ClassifyAt, Model, Scene};
use crate::volume::Volume;

/// Renders a scene from any number of cameras. What depends on the volume and on what shows of it alone (where nothing shows,
/// gradient magnitudes, tables, the light that gets through to the scene) is made with the first picture and kept.
pub struct Views<'a> {
    volume: &'a Volume,
    scene: &'a Scene,
    method: &'a Method,
    schedule: Schedule,
    survey: Survey,
    tracer: OnceLock<Box<dyn Tracer + 'a>>,
}

impl<'a> Views<'a> {
    /// Views of a scene, of which nothing is made yet.
    ///
    /// # Errors
    /// As [`render`](super::render).
    pub fn new(volume: &'a Volume, scene: &'a Scene, method: &'a Method, schedule: Schedule) -> Result<Self> {
        check_combination(volume, scene, method)?;
        match method {
            Method::March(settings) => march::check(settings, scene, volume.grid())?,
            Method::Exact(settings) => exact::check(settings)?,
            Method::Reference => {}
        }
        let (survey, tracer) = (Survey::default(), OnceLock::new());
        Ok(Views { volume, scene, method, schedule, survey, tracer })
    }

    /// Renders the scene as the camera that it has sees it.
    ///
    /// # Errors
    /// As [`render`](super::render).
    pub fn render(&self, progress: Progress<'_>) -> Result<Rendered> {
        self.render_of(self.scene, progress)
    }

    /// Renders another scene of the volume: with what is kept where it differs by its camera alone, and from nothing elsewhere, as
    /// where effects are set by the distance from the eye. The picture is the same in either case.
    ///
    /// # Errors
    /// As [`render`](super::render).
    pub fn render_scene(&self, scene: &Scene, progress: Progress<'_>) -> Result<Rendered> {
        if self.keeps_for(scene) {
            return self.render_of(scene, progress);
        }
        Views::new(self.volume, scene, self.method, self.schedule)?.render(progress)
    }

    /// Whether what is kept is that of this scene.
    fn keeps_for(&self, scene: &Scene) -> bool {
        // Light at the voxels shines towards the eye.
        let by_eye = scene.effects.classify == ClassifyAt::Voxels && scene.shading.is_some();
        let moved = |camera: Camera| Scene { camera, ..scene.clone() };
        !by_eye && moved(self.scene.camera) == *self.scene
    }

    fn render_of(&self, scene: &Scene, progress: Progress<'_>) -> Result<Rendered> {
        let frame = Frame { volume: self.volume, scene, schedule: self.schedule, survey: &self.survey, progress };
        match self.method {
            Method::March(settings) => match &scene.model {
                Model::Light => select::march(&frame, settings),
                Model::Value(model) => march::show_number(&frame, settings, model),
                Model::Surfaces(surfaces) if settings.rule == SampleRule::WholeSteps => {
                    select::level_changes(&frame, settings, surfaces)
                }
                Model::Surfaces(surfaces) => march::show_surfaces(&frame, settings, surfaces),
            },
            Method::Exact(settings) => {
                let of_scene = || exact::frame_tracer(self.schedule, self.volume, self.scene, settings);
                Ok(exact::render(&frame, self.tracer.get_or_init(of_scene).as_ref()))
            }
            Method::Reference => Ok(reference::render(&frame)),
        }
    }
}
