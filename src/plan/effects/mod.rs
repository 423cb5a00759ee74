//! Effects, resolved: one that is named with a strength of 0 is not there.

mod depth_cue;
mod describe;
mod fog;
mod haze;
mod scattering;
mod shadows;

pub(super) use describe::{effects_json, in_words};
pub(super) use scattering::scatters;

use crate::error::Result;
use crate::scene::{Background, Camera, ClassifyAt, Effects, Projection, Shading};
use crate::spec::{ClassifyAtName, Color, Spec};
use crate::volume::Grid;

use super::stages::NOT_NAMED;
use super::{Omission, clip};

/// What an effect needs to know besides its own keys.
pub(super) struct Surroundings<'a> {
    pub(super) grid: &'a Grid,
    pub(super) camera: &'a Camera,
    pub(super) shading: Option<&'a Shading>,
    pub(super) background: Background,
}

/// Effects, and those that are not computed.
#[derive(Default)]
pub(super) struct Resolved {
    pub(super) effects: Effects,
    pub(super) omitted: Vec<Omission>,
    /// What an author of effects that turn out to do nothing should know.
    pub(super) warnings: Vec<String>,
}

/// An effect, or why it is none.
type Asked<T> = std::result::Result<T, Absence>;

/// Why an effect is not computed.
enum Absence {
    /// The pipeline does not name it.
    NotNamed,
    /// It is named with a strength of 0.
    NoStrength(String),
    /// It is named, and has nothing to act on.
    Idle(String),
}

pub(super) fn resolve(spec: &Spec, surroundings: &Surroundings<'_>) -> Result<Resolved> {
    let written = spec.pipeline.effects.clone().unwrap_or_default();
    let mut resolved = Resolved::default();
    resolved.effects = Effects {
        clip: clip::resolve(spec, surroundings.grid),
        classify: match written.classify {
            None | Some(ClassifyAtName::Samples) => ClassifyAt::Samples,
            Some(ClassifyAtName::Voxels) => ClassifyAt::Voxels,
        },
        depth_cue: resolved.keep(depth_cue::resolve(written.depth_cue.as_ref(), surroundings), "depth cue"),
        shadows: resolved.keep(shadows::resolve(written.shadows.as_ref(), surroundings), "shadows"),
        scattering: resolved.keep(scattering::resolve(&written), "scattering"),
        fog: resolved.keep(fog::resolve(written.fog.as_ref(), surroundings), "fog"),
        haze: resolved.keep(haze::resolve(spec, written.haze.as_ref(), surroundings)?, "haze"),
        ..Effects::default()
    };
    Ok(resolved)
}

impl Resolved {
    fn keep<T>(&mut self, asked: Asked<T>, what: &'static str) -> Option<T> {
        let why = match asked {
            Ok(effect) => return Some(effect),
            Err(Absence::NotNamed) => NOT_NAMED.to_owned(),
            Err(Absence::NoStrength(why)) => why,
            Err(Absence::Idle(why)) => {
                self.warnings.push(format!("{what} changes nothing: {why}"));
                why
            }
        };
        self.omitted.push(Omission { what, why });
        None
    }
}

impl Surroundings<'_> {
    /// Distance along rays beyond which no point of the volume lies, mm.
    fn farthest_mm(&self) -> f64 {
        let distance = |corner: glam::DVec3| {
            let from_eye = corner - self.camera.position_mm();
            match self.camera.projection() {
                Projection::Perspective { .. } => from_eye.length(),
                Projection::Parallel { .. } => from_eye.dot(self.camera.forward()),
            }
        };
        self.grid.corners_mm().map(distance).into_iter().fold(0.0, f64::max)
    }

    /// A colour as written, or that of the background.
    fn color(&self, written: Option<Color>) -> [f64; 3] {
        match (written, self.background) {
            (Some(Color(rgb)), _) | (None, Background::Color(rgb)) => rgb,
            (None, Background::Transparent) => [0.0; 3],
        }
    }
}
