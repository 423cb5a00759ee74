//! Layers of the transfer function: presets and widgets become terms.

use crate::error::{Error, Result};
use crate::spec::{
    AttenuationSpec, Color, ContourSpec, EmissionSpec, LayerSpec, LoadedPreset, Pipeline, Preset, Spec, Tissue,
    ValuesName, Widget,
};
use crate::transfer::attenuation::Attenuation;
use crate::transfer::shapes::{Ellipse, Expansion, Gaussian, Shape, Triangle, extinction_per_mm};
use crate::transfer::{Curve, Knot, Optics, Side, Term, Weight};
use crate::volume::Quantity;

use super::VolumeInfo;
use super::light::Scales;

/// How far terms may be from a shape, as a share of its height, unless told.
const DEFAULT_DEVIATION: f64 = 1.0 / 32.0;

/// One layer of the transfer function.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Name of its preset, or `layer 2` for the second one where it is written in the pipeline.
    pub name: String,
    /// The tissue it classifies.
    pub tissue: Option<Tissue>,
    /// Its terms; their sum over all layers is the transfer function. Those that are 0 on its domain are left out.
    pub terms: Vec<Term>,
    /// How far the terms may be from the shapes that were written, as a share of a shape's height; 0 where they are exact.
    pub max_deviation: f64,
}

/// The window of values and the range of gradient magnitudes.
pub(super) fn domain(pipeline: &Pipeline) -> [[f64; 2]; 2] {
    let window = pipeline.normalise.as_ref().map_or([-1024.0, 3071.0], |normalise| normalise.hu);
    let gradient = pipeline.gradient.as_ref().map_or([0.0, 1500.0], |gradient| gradient.range_hu_per_mm);
    [window, gradient]
}

/// The layers in the order written, with all extinction and emission scaled.
pub(super) fn resolve(
    spec: &Spec,
    volume: &VolumeInfo,
    gradient_range_per_mm: f64,
    scales: Scales,
) -> Result<Vec<Layer>> {
    let resolve = |(i, (written, loaded)): (usize, (&LayerSpec, Option<&LoadedPreset>))| {
        let (key_path, name) = (format!("transfer_function.{i}"), format!("layer {}", i + 1));
        let place = Place { key_path: &key_path, name: &name };
        layer(spec, volume, written, loaded, place, gradient_range_per_mm, scales)
    };
    spec.layers().enumerate().map(resolve).collect()
}

/// The usual tube voltage is 120 kVp, and its effective energy about 70 keV.
fn attenuation(spec: &AttenuationSpec) -> Attenuation {
    Attenuation { kev: spec.kev, scanned_at_kev: spec.scanned_at_kev.unwrap_or(70.0) }
}

/// Where a layer is written, and what it is called unless it has a preset.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) key_path: &'a str,
    pub(super) name: &'a str,
}

/// One layer, with all extinction and emission scaled.
pub(super) fn layer(
    spec: &Spec,
    volume: &VolumeInfo,
    layer: &LayerSpec,
    loaded: Option<&LoadedPreset>,
    place: Place<'_>,
    gradient_range_per_mm: f64,
    scales: Scales,
) -> Result<Layer> {
    let preset = loaded.map(|loaded| &loaded.preset);
    let is_in_hu = preset.is_some_and(|p| p.values != Some(ValuesName::Arbitrary)) || layer.attenuation.is_some();
    if is_in_hu {
        let kind = if layer.attenuation.is_some() { "attenuation" } else { "preset" };
        refuse_hu_for_other_values(spec, volume, layer, [place.key_path, kind])?;
    }
    let widgets = preset.map(|p| &p.widgets).or(layer.widgets.as_ref());
    let mut max_deviation = 0.0f64;
    let mut terms = Vec::new();
    for (k, widget) in widgets.into_iter().flatten().enumerate() {
        let file = loaded.map_or(spec.path(), |loaded| &loaded.path);
        let prefix = if loaded.is_some() { String::new() } else { format!("{}.", place.key_path) };
        let named = |error: Error| error.at(file).element(format!("{prefix}widgets.{k}"));
        let expansion = expand(widget, layer.color).map_err(named)?;
        max_deviation = max_deviation.max(expansion.max_deviation);
        for term in expansion.terms {
            terms.extend(placed(term, layer, scales).and_then(|t| simplified(t, gradient_range_per_mm))?);
        }
    }
    let attenuation = layer.attenuation.as_ref().map(attenuation);
    if let Some(attenuation) = attenuation {
        let term = Term { curve: attenuation.curve()?, weight: None };
        terms.extend(placed(term, layer, scales).and_then(|t| simplified(t, gradient_range_per_mm))?);
    }
    let name = match (preset, attenuation) {
        (Some(preset), _) => preset.name.clone(),
        (None, Some(attenuation)) => format!("attenuation at {} keV", attenuation.kev),
        (None, None) => place.name.to_owned(),
    };
    Ok(Layer { name, tissue: preset.and_then(|p| p.tissue.clone()), terms, max_deviation })
}

/// The terms of a preset as it is written, without a layer's settings.
///
/// # Errors
/// `Fault::Spec` for a shape that is degenerate or takes too many terms, naming the widget.
pub fn preset_terms(preset: &Preset) -> Result<Vec<Term>> {
    let terms = |(k, widget): (usize, &Widget)| {
        let expansion = expand(widget, None).map_err(|error| error.element(format!("widgets.{k}")))?;
        Ok(expansion.terms)
    };
    Ok(preset.widgets.iter().enumerate().map(terms).collect::<Result<Vec<_>>>()?.concat())
}

/// The terms of shapes without optics: their extinction is 1 where a shape is 1.
pub(super) fn shapes(widgets: &[Widget], layer: &LayerSpec, gradient_range_per_mm: f64) -> Result<Vec<Term>> {
    let unit = Optics { extinction_per_mm: 1.0, emission_per_mm: [0.0; 3] };
    let mut terms = Vec::new();
    for (k, widget) in widgets.iter().enumerate() {
        let Some((shape, max_deviation)) = shape(widget) else { continue };
        let expansion = shape.expand(unit, max_deviation.unwrap_or(DEFAULT_DEVIATION));
        for term in expansion.map_err(|error| error.element(format!("classify.{k}")))?.terms {
            terms.extend(placed(term, layer, Scales::NONE).and_then(|term| simplified(term, gradient_range_per_mm))?);
        }
    }
    Ok(terms)
}

/// What is in HU means nothing on values of unknown meaning, unless the layer says how the two relate.
fn refuse_hu_for_other_values(
    spec: &Spec,
    volume: &VolumeInfo,
    layer: &LayerSpec,
    [path, kind]: [&str; 2],
) -> Result<()> {
    if volume.quantity == Quantity::Hu || layer.scale.is_some() || layer.shift_hu.is_some() {
        return Ok(());
    }
    let [low, high] = volume.value_range;
    Err(spec
        .error(
            &format!("{path}.{kind}"),
            format!("this {kind} is in HU, and the volume does not say that its values are"),
        )
        .found(format!("values from {low} to {high} of unknown unit"))
        .remedy(
            "write volume: { values: hu } if they are HU, volume: { shift_hu: -1024 } if they are HU + 1024, \
             or give the layer a scale and a shift_hu of its own",
        ))
}

/// The terms of a widget as written, before the layer's settings.
fn expand(widget: &Widget, color: Option<Color>) -> Result<Expansion> {
    if let Some(points) = &widget.points {
        let knots = points.iter().map(|p| Knot {
            value: p.hu,
            optics: optics(p.opacity_per_mm, p.extinction_per_mm, color.or(p.color), p.emission_per_mm.as_ref()),
        });
        let weight = widget.gradient_weight.clone().map(Weight::new).transpose()?;
        return Ok(Expansion { terms: vec![Term { curve: Curve::new(knots.collect())?, weight }], max_deviation: 0.0 });
    }
    let optics = optics(
        widget.opacity_per_mm,
        widget.extinction_per_mm,
        color.or(widget.color),
        widget.emission_per_mm.as_ref(),
    );
    let Some((shape, max_deviation)) = shape(widget) else {
        return Ok(Expansion { terms: Vec::new(), max_deviation: 0.0 });
    };
    shape.expand(optics, max_deviation.unwrap_or(DEFAULT_DEVIATION))
}

/// The shape of a widget and how far its terms may be from it; the spec has seen to it that there is one, or points.
fn shape(widget: &Widget) -> Option<(Shape, Option<f64>)> {
    if let Some(r) = &widget.rectangle {
        return Some((Shape::Rectangle { value: r.hu, gradient_per_mm: r.gradient_hu_per_mm }, None));
    }
    if let Some(t) = &widget.trapezoid {
        return Some((Shape::Trapezoid { value: t.hu, gradient_per_mm: t.gradient_hu_per_mm }, None));
    }
    if let Some(t) = &widget.triangle {
        let (opening_mm, edge) = (t.opening_mm, t.edge.unwrap_or(0.5));
        let triangle = Triangle { apex: t.apex_hu, opening_mm, edge, gradient_per_mm: t.gradient_hu_per_mm };
        return Some((Shape::Triangle(triangle), t.max_deviation));
    }
    if let Some(ContourSpec { hu, thickness_mm, gradient_hu_per_mm, max_deviation }) = &widget.contour {
        let (apex, opening_mm) = (*hu, *thickness_mm);
        let triangle = Triangle { apex, opening_mm, edge: 1.0, gradient_per_mm: *gradient_hu_per_mm };
        return Some((Shape::Triangle(triangle), *max_deviation));
    }
    if let Some(e) = &widget.ellipse {
        let ellipse = Ellipse {
            value: e.hu,
            value_radius: e.hu_radius,
            gradient_per_mm: e.gradient_hu_per_mm,
            gradient_radius_per_mm: e.gradient_radius_hu_per_mm,
        };
        return Some((Shape::Ellipse(ellipse), e.max_deviation));
    }
    let g = widget.gaussian.as_ref()?;
    let gradient_per_mm = g.gradient_hu_per_mm.zip(g.gradient_sigma_hu_per_mm).map(|(mean, sigma)| [mean, sigma]);
    Some((Shape::Gaussian(Gaussian { value: [g.hu, g.hu_sigma], gradient_per_mm }), g.max_deviation))
}

fn optics(
    opacity_per_mm: Option<f64>,
    extinction: Option<f64>,
    color: Option<Color>,
    emission: Option<&EmissionSpec>,
) -> Optics {
    let extinction = extinction.unwrap_or_else(|| extinction_per_mm(opacity_per_mm.unwrap_or(0.0), 1.0));
    let absorbing = Optics::colored(extinction, color.unwrap_or(Color::BLACK).0);
    match emission {
        None => absorbing,
        Some(EmissionSpec { color: Color(rgb), strength }) => {
            absorbing.plus(*strength, Optics { extinction_per_mm: 0.0, emission_per_mm: *rgb })
        }
    }
}

/// A term with the layer's scale, shift and opacity scale.
fn placed(term: Term, layer: &LayerSpec, scales: Scales) -> Result<Term> {
    let (scale, shift) = (layer.scale.unwrap_or(1.0), layer.shift_hu.unwrap_or(0.0));
    let opacity_scale = layer.opacity_scale.unwrap_or(1.0);
    let knots = term.curve.knots().iter().map(|knot| Knot {
        value: knot.value * scale + shift,
        optics: Optics {
            extinction_per_mm: knot.optics.extinction_per_mm * opacity_scale * scales.extinction,
            emission_per_mm: knot.optics.emission_per_mm.map(|q| q * opacity_scale * scales.emission),
        },
    });
    let weight = term.weight.map(|w| Weight::new(w.knots().iter().map(|[g, w]| [g * scale, *w]).collect()));
    Ok(Term { curve: Curve::new(knots.collect())?, weight: weight.transpose()? })
}

/// The same function on gradient magnitudes up to `range`, without a weight that is constant there, so that nobody
/// computes gradients for it; `None` for a term that is 0 there.
fn simplified(term: Term, range: f64) -> Result<Option<Term>> {
    if term.curve.knots().iter().all(|knot| knot.optics == Optics::NOTHING) {
        return Ok(None);
    }
    let Some(weight) = &term.weight else { return Ok(Some(term)) };
    let inner = weight.positions().filter(|&g| 0.0 < g && g < range);
    let level = weight.at(0.0, Side::Right);
    let even = inner.flat_map(|g| [(g, Side::Left), (g, Side::Right)]).chain([(range, Side::Left)]);
    if even.into_iter().any(|(g, side)| weight.at(g, side) != level) {
        return Ok(Some(term));
    }
    if level == 0.0 {
        return Ok(None);
    }
    let knots = term.curve.knots().iter();
    let knots = knots.map(|k| Knot { value: k.value, optics: Optics::NOTHING.plus(level, k.optics) }).collect();
    Ok(Some(Term { curve: Curve::new(knots)?, weight: None }))
}
