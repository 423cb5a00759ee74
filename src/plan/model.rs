//! What a ray shows, resolved, and in words.

use crate::scene::{Model, Scene, Surface, ValueModel, ValueOf};
use crate::spec::{Color, EffectsSpec, ProjectionOf, Spec, TransportName};
use crate::volume::Quantity;

use super::{Layer, Omission, Plan, layers};

pub(super) fn resolve(spec: &Spec) -> Model {
    match &spec.pipeline.effects {
        Some(EffectsSpec { project: Some(project), .. }) => {
            let [window, _] = layers::domain(&spec.pipeline);
            let of = match project.show {
                ProjectionOf::Maximum => ValueOf::Maximum,
                ProjectionOf::Minimum => ValueOf::Minimum,
                ProjectionOf::Mean => ValueOf::Mean,
                ProjectionOf::Sum => ValueOf::Sum,
                // The spec has seen to it that there is one.
                ProjectionOf::LocalMaximum => {
                    ValueOf::LocalMaximum { threshold: project.threshold_hu.unwrap_or(window[0]) }
                }
                ProjectionOf::OpticalDepth => ValueOf::OpticalDepth,
            };
            let written = project.window_hu.or(project.window_hu_mm).or(project.window_optical_depth);
            Model::Value(ValueModel { of, window: written.unwrap_or(window) })
        }
        Some(EffectsSpec { surfaces: Some(surfaces), .. }) => {
            let surface = |s: &crate::spec::SurfaceSpec| {
                let Color(color) = s.color.unwrap_or(Color([1.0; 3]));
                Surface { value: s.hu, opacity: s.opacity.unwrap_or(1.0), color }
            };
            // What is not seen is not looked for.
            let seen = surfaces.iter().map(surface).filter(|s| s.opacity > 0.0);
            Model::Surfaces(seen.collect())
        }
        _ => Model::Light,
    }
}

/// Whether anything reads the transfer function.
pub(super) fn reads_transfer_function(scene: &Scene) -> bool {
    match &scene.model {
        Model::Light => true,
        Model::Value(model) => model.of.reads_transfer_function(),
        Model::Surfaces(_) => false,
    }
}

/// Whether a block of cells can be skipped by the range of its values.
pub(super) fn skips_blocks(model: &Model) -> bool {
    match model {
        Model::Value(model) => !matches!(model.of, ValueOf::Mean | ValueOf::Sum),
        Model::Light | Model::Surfaces(_) => true,
    }
}

/// What a ray shows, in words; `None` for light.
pub(super) fn describe(model: &Model, quantity: Quantity) -> Option<String> {
    let unit = match quantity {
        Quantity::Hu => " HU",
        Quantity::Arbitrary => "",
    };
    match model {
        Model::Light => None,
        Model::Value(ValueModel { of, window: [black, white] }) => {
            let (what, unit) = match of {
                ValueOf::Maximum => ("largest value".to_owned(), unit),
                ValueOf::Minimum => ("smallest value".to_owned(), unit),
                ValueOf::Mean => ("mean value".to_owned(), unit),
                ValueOf::Sum => ("integral of the value".to_owned(), if unit.is_empty() { " mm" } else { " HU mm" }),
                ValueOf::LocalMaximum { threshold } => {
                    (format!("first local maximum of at least {threshold}{unit}"), unit)
                }
                ValueOf::OpticalDepth => ("optical depth".to_owned(), ""),
            };
            Some(format!("the {what} along each ray, black at {black} and white at {white}{unit}"))
        }
        Model::Surfaces(surfaces) => {
            let surface = |s: &Surface| match s.opacity {
                1.0 => format!("{}{unit}", s.value),
                opacity => format!("{}{unit} of opacity {opacity}", s.value),
            };
            let surfaces: Vec<String> = surfaces.iter().map(surface).collect();
            Some(if surfaces.is_empty() {
                "no surface".to_owned()
            } else {
                format!("surfaces at {}", surfaces.join(", "))
            })
        }
    }
}

/// What is not computed because of what a ray shows.
pub(super) fn not_computed(plan: &Plan, spec: &Spec) -> Vec<Omission> {
    let effects = spec.pipeline.effects.clone().unwrap_or_default();
    let mut omissions = Vec::new();
    let mut omit = |what, why: String| omissions.push(Omission { what, why });
    match &plan.scene.model {
        Model::Light => {}
        Model::Value(model) if model.of.reads_transfer_function() => {
            omit("emission", "effects.project shows the optical depth, which is of extinction".to_owned());
        }
        Model::Value(_) => omit("classification", "effects.project shows a number of the values, not light".to_owned()),
        Model::Surfaces(_) => omit("classification", "effects.surfaces shows surfaces, not light".to_owned()),
    }
    match effects.light {
        Some(TransportName::Absorption) => omit("emission", "effects.light shows absorption alone".to_owned()),
        Some(TransportName::Emission) => {
            omit(
                "absorption",
                "effects.light shows emission alone, without highlights, which are of what absorbs".to_owned(),
            );
        }
        Some(TransportName::Both) | None => {}
    }
    for surface in effects.surfaces.iter().flatten().filter(|surface| surface.opacity == Some(0.0)) {
        omit("surface", format!("the one at {} has an opacity of 0", surface.hu));
    }
    omissions
}

/// Why a layer without terms shows nothing.
pub(super) fn why_empty(layer: &Layer, spec: &Spec) -> String {
    let transport = spec.pipeline.effects.as_ref().and_then(|effects| effects.light);
    let what = match transport {
        Some(TransportName::Absorption) => "absorbs nothing",
        Some(TransportName::Emission) => "emits nothing",
        Some(TransportName::Both) | None => "is 0",
    };
    format!("{} {what} everywhere in the window and the range of gradient magnitudes", layer.name)
}
