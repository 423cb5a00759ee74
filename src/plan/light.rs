//! Light: shading and what is behind the volume.

use glam::DVec3;

use super::effects;
use crate::scene::{Background, Light, Shading};
use crate::spec::{BackgroundSpec, Color, LightSpec, ShadingSpec, Spec, TransportName};

/// Light, resolved.
pub(super) struct ResolvedLight {
    /// Shading; `None` if nothing is lit.
    pub(super) shading: Option<Shading>,
    /// Factors on what the layers absorb and emit.
    pub(super) scales: Scales,
    pub(super) background: Background,
}

/// Factors on all extinction and all emission of the transfer function.
///
/// `effects.light` is no more than this: without emission the light from behind is what is left to see, and without
/// extinction nothing is hidden and there are no highlights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scales {
    pub(super) extinction: f64,
    /// The ambient share, too, where shading is written but nothing is lit.
    pub(super) emission: f64,
}

impl Scales {
    /// As written.
    pub(super) const NONE: Scales = Scales { extinction: 1.0, emission: 1.0 };
}

pub(super) fn resolve(spec: &Spec) -> ResolvedLight {
    let effects = spec.pipeline.effects.clone().unwrap_or_default();
    let transport = effects.light.unwrap_or(TransportName::Both);
    let scales = match (transport, &effects.project) {
        // The optical depth is of extinction.
        (TransportName::Absorption, _) | (_, Some(_)) => Scales { extinction: 1.0, emission: 0.0 },
        (TransportName::Emission, None) => Scales { extinction: 0.0, emission: 1.0 },
        (TransportName::Both, None) => Scales::NONE,
    };
    let written = effects.shading.as_ref().map(|written| {
        let shading = shading(written);
        // A highlight is extinction times its strength.
        if scales.extinction == 0.0 { Shading { specular: 0.0, ..shading } } else { shading }
    });
    let background = spec.pipeline.image.as_ref().and_then(|image| image.background);
    let background = self::background(background);
    match written {
        // Without light, shading is a constant factor, and no gradient need be computed for it. What scatters is not
        // scaled by it.
        Some(shading) if !shading.is_lit() && !effects::scatters(spec) => {
            let scales = Scales { emission: shading.ambient * scales.emission, ..scales };
            ResolvedLight { shading: None, scales, background }
        }
        shading => ResolvedLight { shading, scales, background },
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

pub(super) fn light(spec: &LightSpec) -> Light {
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
