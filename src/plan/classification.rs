//! What the layers of a transfer function mean as tissues: membership functions, numbers, and how labels are cleaned.

use std::collections::BTreeMap;

use crate::error::{Error, Fault, Result};
use crate::image::srgb;
use crate::spec::{CleanSpec, LayerSpec, Spec};
use crate::transfer::{Curve, Knot, Optics, Side, Term, TransferFunction};
use crate::volume::{Concept, MOST_SEGMENTS, Segment};

use super::light::Scales;
use super::{VolumeInfo, layers};

/// The tissues of a pipeline, resolved for a volume. `tissue` in the library says what is done with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Classification {
    /// The tissues, in the order of the layers.
    pub tissues: Vec<Tissue>,
}

/// A tissue: what belongs to it, and how much.
#[derive(Debug, Clone, PartialEq)]
pub struct Tissue {
    /// Name, label, colour and concept.
    pub segment: Segment,
    /// The membership function over value (HU) and gradient magnitude (HU/mm), from 0 to 1, as the extinction of a
    /// transfer function.
    membership: TransferFunction,
    /// The layer's highest extinction, 1/mm, which decides between tissues of equal membership.
    pub peak_extinction_per_mm: f64,
    /// Steps that clean its labels, in order.
    pub clean: Vec<CleanStep>,
}

/// A step that cleans the labels of one tissue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CleanStep {
    /// Keeps the part with the most voxels.
    LargestPart,
    /// Keeps parts of at least this volume, ml.
    SmallestPartMl(f64),
    /// Takes in what the tissue encloses on all sides.
    FillHoles,
    /// Leaves out what lies outside the body.
    Body,
    /// Grows by a ball of this radius, mm, and shrinks by it.
    ClosingMm(f64),
    /// Gives each voxel to the majority of the box that reaches this far from it, mm.
    MajorityMm(f64),
}

impl Classification {
    /// The tissues of a spec for a volume whose values are [interpreted](Spec::interpret).
    ///
    /// # Errors
    /// `Fault::Spec` for a pipeline without layers, a layer that nothing can belong to, two tissues of one name or label, and
    /// cleaning of a layer that there is not; and as [`Plan::new`](super::Plan::new) for the layers themselves.
    pub fn new(spec: &Spec, volume: &VolumeInfo) -> Result<Self> {
        if volume.storage.rgba_encoding().is_some() {
            return Err(spec.error("volume", "a volume of colours has no values to classify by"));
        }
        if volume.uneven_slices_mm.is_some() {
            return Err(spec.error("volume.slices", "labels are for slices at even distances"));
        }
        let domain = layers::domain(&spec.pipeline);
        let resolved = layers::resolve(spec, volume, domain[1][1], Scales::NONE)?;
        if resolved.is_empty() {
            return Err(spec.error("transfer_function", "there is no layer to classify by").expected("at least one"));
        }
        if resolved.len() > MOST_SEGMENTS {
            return Err(spec.error("transfer_function", "a label map has at most 255 tissues"));
        }
        let labels = labels(spec, &resolved)?;
        let mut tissues = Vec::new();
        for (i, ((written, loaded), layer)) in spec.layers().zip(&resolved).enumerate() {
            let key_path = format!("transfer_function.{i}");
            let preset = loaded.map(|loaded| &loaded.preset);
            let picture = TransferFunction::new(domain[0], domain[1][1], layer.terms.clone())?;
            let peak = peak(&picture);
            let shapes = preset.and_then(|preset| preset.classify.as_ref());
            let terms = match (shapes, loaded) {
                (Some(widgets), Some(loaded)) => {
                    let unscaled = LayerSpec { opacity_scale: None, ..written.clone() };
                    layers::shapes(widgets, &unscaled, domain[1][1]).map_err(|error| error.at(&loaded.path))?
                }
                _ => layer.terms.clone(),
            };
            let membership = normalised(domain, &terms)?.ok_or_else(|| {
                spec.error(&key_path, "nothing can belong to this layer: its opacity is 0 everywhere")
                    .remedy("give it opacity, or remove it")
            })?;
            let segment = Segment {
                name: layer.name.clone(),
                label: labels[i],
                color_srgb: color_srgb(peak),
                concept: layer.tissue.as_ref().and_then(|tissue| {
                    let code = tissue.snomed.clone()?;
                    Some(Concept { code, meaning: tissue.meaning.clone().unwrap_or_else(|| layer.name.clone()) })
                }),
            };
            let clean = spec.pipeline.clean.get(&layer.name).or_else(|| spec.pipeline.clean.get("all"));
            let clean = clean.into_iter().flatten().map(|step| CleanStep::from(*step)).collect();
            tissues.push(Tissue { segment, membership, peak_extinction_per_mm: peak.extinction_per_mm, clean });
        }
        refuse_strangers(spec, &tissues)?;
        Ok(Classification { tissues })
    }

    /// The same tissues by their value alone: the gradient axis is left out.
    ///
    /// # Errors
    /// None for a classification that this module made.
    pub fn without_gradient(&self) -> Result<Self> {
        let tissues = self.tissues.iter().map(|tissue| {
            let membership = value_alone(&tissue.membership)?;
            Ok(Tissue { membership, ..tissue.clone() })
        });
        Ok(Classification { tissues: tissues.collect::<Result<_>>()? })
    }
}

impl Tissue {
    /// Membership at a value (HU) and a gradient magnitude (HU/mm), from 0 to 1.
    pub fn membership(&self, value: f64, gradient_per_mm: f64) -> f64 {
        self.membership.evaluate(value, gradient_per_mm).extinction_per_mm
    }

    /// The membership function, as the extinction of a transfer function.
    pub fn membership_function(&self) -> &TransferFunction {
        &self.membership
    }
}

impl From<CleanSpec> for CleanStep {
    fn from(spec: CleanSpec) -> Self {
        match spec {
            CleanSpec::LargestPart => CleanStep::LargestPart,
            CleanSpec::SmallestPartMl(ml) => CleanStep::SmallestPartMl(ml),
            CleanSpec::FillHoles => CleanStep::FillHoles,
            CleanSpec::Body => CleanStep::Body,
            CleanSpec::ClosingMm(mm) => CleanStep::ClosingMm(mm),
            CleanSpec::MajorityMm(mm) => CleanStep::MajorityMm(mm),
        }
    }
}

/// Where a transfer function absorbs most: at a knot, since it is bilinear between knots.
pub(super) fn peak(function: &TransferFunction) -> Optics {
    let mut peak = Optics::NOTHING;
    for value in function.value_knots() {
        for gradient in function.gradient_knots() {
            for (value_side, gradient_side) in SIDES {
                let optics = function.evaluate_side(value, value_side, gradient, gradient_side);
                if optics.extinction_per_mm > peak.extinction_per_mm {
                    peak = optics;
                }
            }
        }
    }
    peak
}

const SIDES: [(Side, Side); 4] =
    [(Side::Left, Side::Left), (Side::Left, Side::Right), (Side::Right, Side::Left), (Side::Right, Side::Right)];

/// The extinction of these terms as a share of its peak; `None` where it is 0 everywhere.
fn normalised([window, gradient_range]: [[f64; 2]; 2], terms: &[Term]) -> Result<Option<TransferFunction>> {
    let highest = peak(&TransferFunction::new(window, gradient_range[1], terms.to_vec())?).extinction_per_mm;
    if highest <= 0.0 {
        return Ok(None);
    }
    let share = |knot: &Knot| Knot {
        value: knot.value,
        optics: Optics { extinction_per_mm: knot.optics.extinction_per_mm / highest, emission_per_mm: [0.0; 3] },
    };
    let terms = terms.iter().map(|term| {
        let curve = Curve::new(term.curve.knots().iter().map(share).collect())?;
        Ok(Term { curve, weight: term.weight.clone() })
    });
    TransferFunction::new(window, gradient_range[1], terms.collect::<Result<_>>()?).map(Some)
}

/// At each value the highest membership over all gradients, linear between knots.
fn value_alone(membership: &TransferFunction) -> Result<TransferFunction> {
    let gradients = membership.gradient_knots();
    let highest = |value, value_side| {
        let at = |&gradient: &f64| {
            let sides = [Side::Left, Side::Right].map(|gradient_side| {
                membership.evaluate_side(value, value_side, gradient, gradient_side).extinction_per_mm
            });
            sides[0].max(sides[1])
        };
        let extinction_per_mm = gradients.iter().map(at).fold(0.0, f64::max);
        Knot { value, optics: Optics { extinction_per_mm, emission_per_mm: [0.0; 3] } }
    };
    let knots = membership.value_knots().into_iter().flat_map(|v| [highest(v, Side::Left), highest(v, Side::Right)]);
    let term = Term { curve: Curve::new(knots.collect())?, weight: None };
    TransferFunction::new(membership.window(), membership.gradient_range_per_mm(), vec![term])
}

/// Straight colour in sRGB of what absorbs; grey for what does not.
fn color_srgb(optics: Optics) -> [f64; 3] {
    if optics.extinction_per_mm <= 0.0 {
        return [0.5; 3];
    }
    let [r, g, b] = optics.emission_per_mm.map(|q| (q / optics.extinction_per_mm).clamp(0.0, 1.0) as f32);
    let [r, g, b, _] = srgb::encode8([r, g, b, 1.0]);
    [r, g, b].map(|channel| f64::from(channel) / 255.0)
}

/// The label of each layer: that of its preset, or the lowest above all of those.
fn labels(spec: &Spec, layers: &[layers::Layer]) -> Result<Vec<u16>> {
    let given = |layer: &layers::Layer| layer.tissue.as_ref().map(|tissue| tissue.label);
    let mut next = layers.iter().filter_map(given).max().unwrap_or(0);
    let mut owners = BTreeMap::new();
    let mut labels = Vec::new();
    for (i, layer) in layers.iter().enumerate() {
        let label = match given(layer) {
            Some(label) => label,
            None => {
                next = next.checked_add(1).ok_or_else(|| Error::new(Fault::Spec, "there is no label left"))?;
                next
            }
        };
        if let Some(other) = owners.insert(label, &layer.name) {
            return Err(spec
                .error(&format!("transfer_function.{i}"), "two layers have the same label")
                .found(format!("{label} for {other} and for {}", layer.name))
                .remedy("classify by one of them, or by a preset of your own with a tissue.label of its own"));
        }
        labels.push(label);
    }
    Ok(labels)
}

/// Cleaning must be of a layer that there is.
fn refuse_strangers(spec: &Spec, tissues: &[Tissue]) -> Result<()> {
    let names = || tissues.iter().map(|tissue| tissue.segment.name.as_str());
    match spec.pipeline.clean.keys().find(|name| *name != "all" && names().all(|known| known != *name)) {
        None => Ok(()),
        Some(name) => Err(spec
            .error(&format!("clean.{name}"), "there is no layer of this name")
            .expected(format!("one of all, {}", names().collect::<Vec<_>>().join(", ")))),
    }
}
