//! Light: shading and what is behind the volume.

use glam::DVec3;

use crate::scene::{Background, Light, Shading};
use crate::spec::{BackgroundSpec, Color, LightSpec, ShadingSpec, Spec};

/// Light, resolved.
pub(super) struct ResolvedLight {
    /// Shading; `None` if nothing is lit.
    pub(super) shading: Option<Shading>,
    /// Factor on all emission: the ambient share where shading is written but nothing is lit.
    pub(super) emission_scale: f64,
    pub(super) background: Background,
}

pub(super) fn resolve(spec: &Spec) -> ResolvedLight {
    let written = spec.pipeline.effects.as_ref().and_then(|effects| effects.shading.as_ref()).map(shading);
    let background = spec.pipeline.image.as_ref().and_then(|image| image.background);
    let background = self::background(background);
    match written {
        // Without light, shading is a constant factor, and no gradient need be computed for it.
        Some(Shading { diffuse, specular, ambient, .. }) if diffuse == 0.0 && specular == 0.0 => {
            ResolvedLight { shading: None, emission_scale: ambient, background }
        }
        shading => ResolvedLight { shading, emission_scale: 1.0, background },
    }
}

/// What is behind; black unless told.
pub(super) fn background(written: Option<BackgroundSpec>) -> Background {
    match written.unwrap_or(BackgroundSpec::Color(Color::BLACK)) {
        BackgroundSpec::Transparent => Background::Transparent,
        BackgroundSpec::Color(Color(rgb)) => Background::Color(rgb),
    }
}

fn shading(spec: &ShadingSpec) -> Shading {
    let headlight = || vec![LightSpec::Headlight { color: None }];
    Shading {
        ambient: spec.ambient.unwrap_or(0.2),
        diffuse: spec.diffuse.unwrap_or(0.7),
        specular: spec.specular.unwrap_or(0.2),
        shininess: spec.shininess.unwrap_or(20.0),
        two_sided: spec.two_sided.unwrap_or(true),
        soft_gradient_per_mm: spec.soft_gradient_hu_per_mm.unwrap_or(20.0),
        lights: spec.lights.clone().unwrap_or_else(headlight).iter().map(light).collect(),
    }
}

fn light(spec: &LightSpec) -> Light {
    let rgb = |color: &Option<Color>| color.unwrap_or(Color::WHITE).0;
    match spec {
        LightSpec::Headlight { color } => Light::Headlight { color: rgb(color) },
        LightSpec::Directional { towards, color } => {
            // The spec refuses the zero vector; dividing by the largest component keeps the length from overflowing.
            let towards = DVec3::from_array(*towards);
            let towards = (towards / towards.abs().max_element()).normalize();
            Light::Directional { towards, color: rgb(color) }
        }
    }
}
