//! The widgets of layers one by one, as weights over value and gradient magnitude: for pictures of where they lie.

use super::light::Scales;
use super::{VolumeInfo, classification, layers};
use crate::error::Result;
use crate::image::srgb;
use crate::spec::{LayerSpec, LoadedPreset, Preset, Spec, Widget};
use crate::transfer::{Curve, Knot, Optics, Term, TransferFunction};

/// The widgets of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerWidgets {
    /// Name of its preset, or `layer 2` for the second one where it is written in the pipeline.
    pub name: String,
    /// Those that show anything.
    pub widgets: Vec<WidgetWeight>,
}

/// A widget as a weight.
#[derive(Debug, Clone, PartialEq)]
pub struct WidgetWeight {
    /// Its colour where it shows most, sRGB in [0, 1].
    pub color_srgb: [f64; 3],
    /// The weight, as the extinction of a transfer function.
    weight: TransferFunction,
}

impl WidgetWeight {
    /// The extinction, or the emission of a widget that only emits, as a share of its own peak: from 0 to 1.
    pub fn at(&self, value: f64, gradient_per_mm: f64) -> f64 {
        self.weight.evaluate(value, gradient_per_mm).extinction_per_mm
    }
}

/// The widgets of all layers for a volume whose values are [interpreted](Spec::interpret), with the scale, shift and colour
/// of their layers. Layers of attenuation have none.
///
/// # Errors
/// As [`Plan::new`](super::Plan::new) for the layers.
pub fn widgets(spec: &Spec, volume: &VolumeInfo) -> Result<Vec<LayerWidgets>> {
    let mut found = Vec::new();
    for (i, (written, loaded)) in spec.layers().enumerate() {
        let (key_path, name) = (format!("transfer_function.{i}"), format!("layer {}", i + 1));
        let place = layers::Place { key_path: &key_path, name: &name };
        let all = loaded.map(|loaded| &loaded.preset.widgets).or(written.widgets.as_ref());
        let mut widgets = Vec::new();
        for widget in all.into_iter().flatten() {
            let (written, loaded) = alone(written, loaded, widget);
            let layer = layers::layer(spec, volume, &written, loaded.as_ref(), place, f64::MAX, Scales::NONE)?;
            widgets.extend(weight(&layer.terms)?);
        }
        if !widgets.is_empty() {
            let name = loaded.map_or(name.as_str(), |loaded| &loaded.preset.name).to_owned();
            found.push(LayerWidgets { name, widgets });
        }
    }
    Ok(found)
}

/// The same layer with one widget only.
fn alone(written: &LayerSpec, loaded: Option<&LoadedPreset>, widget: &Widget) -> (LayerSpec, Option<LoadedPreset>) {
    let one = || vec![widget.clone()];
    match loaded {
        Some(loaded) => {
            let preset = Preset { widgets: one(), ..loaded.preset.clone() };
            (written.clone(), Some(LoadedPreset { preset, ..loaded.clone() }))
        }
        None => (LayerSpec { widgets: Some(one()), ..written.clone() }, None),
    }
}

/// The terms as a share of their peak; `None` for those that show nothing.
fn weight(terms: &[Term]) -> Result<Option<WidgetWeight>> {
    let knots = || terms.iter().flat_map(|term| term.curve.knots());
    let absorbs = knots().any(|knot| knot.optics.extinction_per_mm > 0.0);
    let strength =
        |optics: Optics| if absorbs { optics.extinction_per_mm } else { optics.emission_per_mm.iter().sum() };
    let Some(domain) = domain(terms) else { return Ok(None) };
    let mapped = |map: &dyn Fn(Optics) -> Optics| -> Result<TransferFunction> {
        let terms = terms.iter().map(|term| {
            let knot = |knot: &Knot| Knot { value: knot.value, optics: map(knot.optics) };
            let curve = Curve::new(term.curve.knots().iter().map(knot).collect())?;
            Ok(Term { curve, weight: term.weight.clone() })
        });
        TransferFunction::new(domain.0, domain.1, terms.collect::<Result<_>>()?)
    };
    let strengths = mapped(&|optics| Optics { extinction_per_mm: strength(optics), ..optics })?;
    let peak = classification::peak(&strengths);
    if peak.extinction_per_mm <= 0.0 {
        return Ok(None);
    }
    let share = |optics| Optics::colored(strength(optics) / peak.extinction_per_mm, [0.0; 3]);
    Ok(Some(WidgetWeight { color_srgb: color(peak, absorbs), weight: mapped(&share)? }))
}

/// Colour of what absorbs, which is its emission over its extinction; of what only emits, as bright as can be.
fn color(peak: Optics, absorbs: bool) -> [f64; 3] {
    let brightest = peak.emission_per_mm.into_iter().fold(0.0, f64::max);
    let one = if absorbs { peak.extinction_per_mm } else { brightest };
    peak.emission_per_mm.map(|q| if one > 0.0 { srgb::encode((q / one).min(1.0)) } else { 0.5 })
}

/// Window and gradient range that hold all knots; `None` where there are none.
fn domain(terms: &[Term]) -> Option<([f64; 2], f64)> {
    let positions = || terms.iter().flat_map(|term| term.curve.positions());
    let (low, high) = (positions().reduce(f64::min)?, positions().reduce(f64::max)?);
    let gradients = terms.iter().flat_map(|term| &term.weight).flat_map(|weight| weight.positions());
    // One more beyond each end: there the function is what it is for ever.
    Some(([low - 1.0, high + 1.0], gradients.fold(0.0, f64::max) + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};
    use glam::DVec3;
    use std::path::Path;

    fn of(layers: &str) -> Vec<LayerWidgets> {
        let text = format!("version: 1\nvolume: {{ phantom: head }}\ntransfer_function: {layers}\n");
        let spec = Spec::from_text(&text, Path::new("widgets.yaml"), &[]).expect("a valid pipeline");
        let grid = Grid::axis_aligned([1, 1, 1], DVec3::ONE).unwrap();
        let volume = Volume::new(grid, Samples::I16(vec![0]), Rescale::IDENTITY, Quantity::Hu).unwrap();
        widgets(&spec, &VolumeInfo::from(&volume)).expect("valid layers")
    }

    #[test]
    fn a_widget_is_a_share_of_its_own_peak() {
        let found = of("[{ preset: bone, opacity_scale: 0.1 }]");
        let [bone] = &found[..] else { panic!("one layer, found {found:?}") };
        assert_eq!((bone.name.as_str(), bone.widgets.len()), ("bone", 2));
        let surface = &bone.widgets[0];
        assert!((surface.at(400.0, 400.0) - 1.0).abs() < 1e-12, "on the plateau: {}", surface.at(400.0, 400.0));
        assert!((surface.at(250.0, 400.0) - 0.5).abs() < 1e-12, "half way up: {}", surface.at(250.0, 400.0));
        assert_eq!((surface.at(100.0, 400.0), surface.at(400.0, 30.0)), (0.0, 0.0), "outside");
        let [r, g, b] = surface.color_srgb.map(|channel| (255.0 * channel).round());
        assert_eq!([r, g, b], [243.0, 230.0, 204.0], "#f3e6cc");
    }

    #[test]
    fn scale_and_shift_move_it_and_light_of_its_own_counts() {
        let glow = "{ rectangle: { hu: [0, 100] }, emission_per_mm: { color: \"#00ff00\", strength: 3 } }";
        let found = of(&format!("[{{ widgets: [{glow}], scale: 2, shift_hu: 1000 }}]"));
        let widget = &found[0].widgets[0];
        assert_eq!(found[0].name, "layer 1");
        assert_eq!([999.0, 1001.0, 1199.0, 1201.0].map(|hu| widget.at(hu, 5.0)), [0.0, 1.0, 1.0, 0.0]);
        let [r, g, b] = widget.color_srgb;
        assert!(r == 0.0 && (g - 1.0).abs() < 1e-12 && b == 0.0, "green, found {r} {g} {b}");
    }

    #[test]
    fn what_shows_nothing_and_attenuation_are_left_out() {
        assert_eq!(of("[{ preset: bone, opacity_scale: 0 }, { attenuation: { kev: 70 } }]"), []);
    }
}
