//! A preset over value and gradient magnitude as functions of the value alone, and what is lost.
//!
//! **Definition.** `σ̄(v) = ∫ σ(v, g) p(g) dg` with `p(g) = exp(-g / m) / m`, and the same for the emission: gradient
//! magnitudes of a scan are many near 0 and ever fewer above, here with a mean of `m` HU/mm. Each weight `w_k` becomes
//! its mean under `p`, so that the sum of the terms stays piecewise linear; its opacity over the unit distance and its
//! straight colour in sRGB do not, and get knots.

use super::function::{Function, Node};
use super::import::check_bound;
use super::knots::{difference, refine, slab_of, slab_of_srgb};
use super::volume_property::VolumeProperty;
use crate::error::{Error, Fault, Result};
use crate::image::srgb;
use crate::plan::preset_terms;
use crate::spec::{Preset, ValuesName};
use crate::transfer::{Curve, Knot, Optics, Side, Term, Weight};

/// How a preset is projected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProjectSettings {
    /// Mean of the gradient magnitudes over which is averaged, HU/mm, above 0.
    pub mean_gradient_hu_per_mm: f64,
    /// Length that the opacities are those of, mm, above 0.
    pub unit_distance_mm: f64,
    /// Largest deviation from the projected preset, as for an import.
    pub max_deviation: f64,
}

impl Default for ProjectSettings {
    fn default() -> Self {
        ProjectSettings { mean_gradient_hu_per_mm: 50.0, unit_distance_mm: 1.0, max_deviation: 1.0 / 1024.0 }
    }
}

/// A preset as functions of the value.
#[derive(Debug, Clone, PartialEq)]
pub struct Projection {
    /// The functions, for one of the writers.
    pub property: VolumeProperty,
    /// What the missing gradient axis costs.
    pub loss: Loss,
    /// Largest deviation of opacity and light from the projected preset, by lines between points.
    pub max_deviation: f64,
}

/// Difference in opacity of 1 mm between a preset and its projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loss {
    /// The largest, up to 1500 HU/mm.
    pub largest: f64,
    /// Value (HU) and gradient magnitude (HU/mm) of the largest.
    pub at: [f64; 2],
    /// The mean, weighted by `p(g)` and even over the values where the preset or its projection absorbs.
    pub mean: f64,
}

/// Window of values and range of gradient magnitudes of a pipeline that does not say otherwise.
const WINDOW_HU: [f64; 2] = [-1024.0, 3071.0];
const GRADIENT_RANGE: f64 = 1500.0;

/// Projects a preset.
///
/// # Errors
/// `Fault::Spec` for settings out of range; `Fault::Unsupported` for light of its own, which no opacity carries.
pub fn project(preset: &Preset, settings: &ProjectSettings) -> Result<Projection> {
    check_bound(settings.max_deviation)?;
    let lengths = [settings.mean_gradient_hu_per_mm, settings.unit_distance_mm];
    if let Some(wrong) = lengths.iter().find(|x| !(**x > 0.0 && x.is_finite())) {
        let error = Error::new(Fault::Spec, "a mean gradient or a unit distance is out of range");
        return Err(error.found(wrong.to_string()).expected("a number above 0"));
    }
    let terms = preset_terms(preset)?;
    let mean = mean_curve(&terms, settings.mean_gradient_hu_per_mm)?;
    let mean = if preset.values == Some(ValuesName::Arbitrary) { mean } else { within_window(&mean)? };
    refuse_emission(&mean)?;
    let (property, max_deviation) = functions(&mean, preset, settings)?;
    let loss = loss(&terms, &mean, settings.mean_gradient_hu_per_mm);
    Ok(Projection { property, loss, max_deviation })
}

/// The mean of a weight under `p`, in closed form: linear pieces times an exponential.
fn mean_weight(weight: &Weight, m: f64) -> f64 {
    let mut positions: Vec<f64> = weight.positions().filter(|g| *g > 0.0).collect();
    positions.dedup();
    let starts = std::iter::once(0.0).chain(positions.iter().copied());
    let ends = positions.iter().copied().chain([f64::INFINITY]);
    let piece = |(a, b): (f64, f64)| {
        let (from, to) = (weight.at(a, Side::Right), weight.at(b, Side::Left));
        let slope = if b.is_finite() { (to - from) / (b - a) } else { 0.0 };
        let [low, high] = [a, b].map(|g| (-g / m).exp());
        (from + slope * m) * low - (to + slope * m) * high
    };
    starts.zip(ends).map(piece).sum()
}

/// The sum of the terms with their weights averaged.
fn mean_curve(terms: &[Term], m: f64) -> Result<Curve> {
    let weights: Vec<f64> = terms.iter().map(|t| t.weight.as_ref().map_or(1.0, |w| mean_weight(w, m))).collect();
    let mut positions: Vec<f64> = terms.iter().flat_map(|term| term.curve.positions()).collect();
    positions.sort_by(f64::total_cmp);
    positions.dedup();
    let sum = |value: f64, side: Side| {
        let optics =
            terms.iter().zip(&weights).fold(Optics::NOTHING, |sum, (t, &w)| sum.plus(w, t.curve.at(value, side)));
        Knot { value, optics }
    };
    Curve::new(positions.iter().flat_map(|&v| [sum(v, Side::Left), sum(v, Side::Right)]).collect())
}

/// The same with the window's ends as a transfer function has them: beyond, it is as at the end from inside.
fn within_window(curve: &Curve) -> Result<Curve> {
    let [low, high] = WINDOW_HU;
    let inside = curve.knots().iter().copied().filter(|knot| low < knot.value && knot.value < high);
    let end = |value: f64, side: Side| Knot { value, optics: curve.at(value, side) };
    Curve::new([end(low, Side::Right), end(high, Side::Left)].into_iter().chain(inside).collect())
}

fn refuse_emission(curve: &Curve) -> Result<()> {
    let glows = |o: &Optics| o.emission_per_mm.iter().any(|q| *q > o.extinction_per_mm * (1.0 + 1e-9));
    match curve.knots().iter().find(|knot| glows(&knot.optics)) {
        None => Ok(()),
        Some(knot) => {
            Err(Error::new(Fault::Unsupported, "the preset gives light of its own, and a volume property cannot")
                .element("emission_per_mm")
                .found(format!("at {} HU", knot.value))
                .remedy("remove emission_per_mm from a copy of the preset"))
        }
    }
}

/// Straight colour at one end of a piece, linear; where nothing absorbs, the limit from within the piece.
fn color_at(curve: &Curve, [here, side]: [(f64, Side); 2]) -> [f64; 3] {
    let at = |(value, side)| curve.at(value, side);
    let Optics { extinction_per_mm: sigma, emission_per_mm: q } =
        if at(here).extinction_per_mm > 0.0 { at(here) } else { at(side) };
    if sigma > 0.0 { q.map(|q| (q / sigma).min(1.0)) } else { [0.0; 3] }
}

/// Opacity and sRGB colour at both ends of a piece, from within.
fn ends(curve: &Curve, [a, b]: [f64; 2], unit_mm: f64) -> [[f64; 4]; 2] {
    let (left, right) = ((a, Side::Right), (b, Side::Left));
    [[left, right], [right, left]].map(|pair| {
        let [opacity, ..] = slab_of(curve.at(pair[0].0, pair[0].1), unit_mm);
        let [r, g, b] = color_at(curve, pair).map(srgb::encode);
        [opacity, r, g, b]
    })
}

/// The projected preset as VTK's functions, within the bound.
fn functions(curve: &Curve, preset: &Preset, settings: &ProjectSettings) -> Result<(VolumeProperty, f64)> {
    let unit = settings.unit_distance_mm;
    let mut breaks: Vec<f64> = curve.positions().collect();
    breaks.dedup();
    let deviation = |piece: [f64; 2], t: f64| {
        let [from, to] = ends(curve, piece, unit);
        let [opacity, r, g, b]: [f64; 4] = std::array::from_fn(|i| (1.0 - t) * from[i] + t * to[i]);
        let (value, side) =
            if t < 1.0 { (piece[0] + t * (piece[1] - piece[0]), Side::Right) } else { (piece[1], Side::Left) };
        difference(slab_of_srgb(opacity, [r, g, b]), slab_of(curve.at(value, side), unit))
    };
    let refined = refine(&breaks, settings.max_deviation, deviation)?;
    let mut nodes: Vec<(f64, [f64; 4])> = Vec::new();
    let mut push = |x: f64, y: [f64; 4]| match nodes.last() {
        Some((last, same)) if *last == x && *same == y => {}
        // VTK keeps one point per position, so the far side of a jump stands at the next number.
        Some((last, _)) if *last == x => nodes.push((x.next_up(), y)),
        _ => nodes.push((x, y)),
    };
    // Constant before the first knot and after the last, with a jump there if the curve has one.
    let [first, last] = [refined.positions.first(), refined.positions.last()].map(|x| x.copied().unwrap_or(0.0));
    let outside = |x: f64, side: Side| ends(curve, if side == Side::Left { [x - 1.0, x] } else { [x, x + 1.0] }, unit);
    push(first, outside(first, Side::Left)[1]);
    for pair in refined.positions.windows(2) {
        let [from, to] = ends(curve, [pair[0], pair[1]], unit);
        push(pair[0], from);
        push(pair[1], to);
    }
    push(last, outside(last, Side::Right)[0]);
    let property = VolumeProperty {
        name: preset.name.clone(),
        scalar_opacity: Function::new(nodes.iter().map(|(x, y)| Node::linear(*x, [y[0].clamp(0.0, 1.0)])).collect())?,
        gradient_opacity: None,
        color: Function::new(
            nodes.iter().map(|(x, y)| Node::linear(*x, [y[1], y[2], y[3]].map(|c| c.clamp(0.0, 1.0)))).collect(),
        )?,
        unit_distance_mm: Some(unit),
        shading: None,
    };
    Ok((property, refined.max_deviation))
}

/// Compares both on a lattice of values and gradient magnitudes.
fn loss(terms: &[Term], mean: &Curve, m: f64) -> Loss {
    const STEPS: u32 = 256;
    let gradients: Vec<f64> = (0..=STEPS).map(|i| GRADIENT_RANGE * (f64::from(i) / f64::from(STEPS)).powi(2)).collect();
    // Each stands for the range half way to its neighbours.
    let share = |i: usize| {
        let edge = |i: usize| 0.5 * (gradients[i] + gradients[i + 1]);
        let low = if i == 0 { 0.0 } else { edge(i - 1) };
        (-low / m).exp() - if i + 1 == gradients.len() { 0.0 } else { (-edge(i) / m).exp() }
    };
    let knots = mean.knots();
    let (low, high) = (knots[0].value, knots[knots.len() - 1].value);
    let mut loss = Loss { largest: 0.0, at: [low, 0.0], mean: 0.0 };
    let mut values = 0.0f64;
    for i in 0..=4 * STEPS {
        let value = low + (high - low) * f64::from(i) / f64::from(4 * STEPS);
        let projected = slab_of(mean.at(value, Side::Left), 1.0)[0];
        let mut absorbs = projected > 0.0;
        let mut sum = 0.0;
        for (k, &g) in gradients.iter().enumerate() {
            let weight = |t: &Term| t.weight.as_ref().map_or(1.0, |w| w.at(g, Side::Right));
            let optics =
                terms.iter().fold(Optics::NOTHING, |sum, t| sum.plus(weight(t), t.curve.at(value, Side::Left)));
            let opacity = slab_of(optics, 1.0)[0];
            absorbs |= opacity > 0.0;
            let off = (opacity - projected).abs();
            sum += share(k) * off;
            if off > loss.largest {
                loss = Loss { largest: off, at: [value, g], ..loss };
            }
        }
        if absorbs {
            values += 1.0;
            loss.mean += sum;
        }
    }
    loss.mean /= values.max(1.0);
    loss
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_a_weight_is_the_integral() {
        let weight = Weight::new(vec![[0.0, 0.0], [30.0, 1.0], [100.0, 1.0], [100.0, 0.25], [200.0, 0.0]]).unwrap();
        let m = 50.0;
        // By many small steps.
        let steps = 400_000;
        let step = 2000.0 / f64::from(steps);
        let at = |i: u32| (f64::from(i) + 0.5) * step;
        let sum: f64 = (0..steps).map(|i| weight.at(at(i), Side::Right) * (-at(i) / m).exp() / m * step).sum();
        let found = mean_weight(&weight, m);
        assert!((found - sum).abs() < 1e-6, "found {found}, expected {sum}");
        let one = Weight::new(vec![[70.0, 1.0]]).unwrap();
        assert!((mean_weight(&one, m) - 1.0).abs() < 1e-15, "p is a density");
    }
}
