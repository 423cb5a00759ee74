//! What a ray shows, resolved.

use crate::scene::{Model, Surface, ValueModel, ValueOf};
use crate::spec::{Color, EffectsSpec, ProjectionOf, Spec};

use super::layers;

pub(super) fn resolve(spec: &Spec) -> Model {
    match &spec.pipeline.effects {
        Some(EffectsSpec { project: Some(project), .. }) => {
            let [window, _] = layers::domain(&spec.pipeline);
            let of = match project.show {
                ProjectionOf::Maximum => ValueOf::Maximum,
                ProjectionOf::Minimum => ValueOf::Minimum,
                ProjectionOf::Mean => ValueOf::Mean,
            };
            Model::Value(ValueModel { of, window: project.window_hu.unwrap_or(window) })
        }
        Some(EffectsSpec { surfaces: Some(surfaces), .. }) => {
            let surface = |s: &crate::spec::SurfaceSpec| {
                let Color(color) = s.color.unwrap_or(Color([1.0; 3]));
                Surface { value: s.hu, opacity: s.opacity.unwrap_or(1.0), color }
            };
            Model::Surfaces(surfaces.iter().map(surface).collect())
        }
        _ => Model::Light,
    }
}
