//! Pictures that are not of light: one number of what lies along a ray, or level surfaces.
//!
//! Cubics are taken apart at their critical points; nothing is skipped by corners or coefficients, and crossings are found
//! by bisection.

use glam::DVec3;

use super::Oracle;
use super::bernstein::Cubic;
use super::cell::{Cell, along};
use super::depth;
use super::path::Passage;
use super::roots::{critical_points, crossing};
use crate::scene::{Ray, Surface, ValueModel, ValueOf};

/// One number of what lies along a ray, or `None` if it misses the volume.
pub(super) fn number(oracle: &Oracle<'_>, model: &ValueModel, ray: &Ray) -> Option<f64> {
    if model.of.reads_transfer_function() {
        return depth::optical_depth(oracle, ray);
    }
    // Between neighbours of these the value is monotone.
    let (mut turns, mut total, mut length_mm) = (Vec::new(), 0.0, 0.0);
    for (passage, value) in passages(oracle, ray).flatten() {
        for [from, to] in critical_points(&value.0).stretches() {
            turns.extend([value.at(from), value.at(to)]);
        }
        total += value.mean() * passage.length_mm;
        length_mm += passage.length_mm;
    }
    let most = turns.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = turns.iter().copied().fold(f64::INFINITY, f64::min);
    (length_mm > 0.0).then_some(match model.of {
        ValueOf::Maximum => most,
        ValueOf::Minimum => least,
        ValueOf::Mean => total / length_mm,
        ValueOf::LocalMaximum { threshold } => local_maximum(&turns, threshold, model.smallest_fall()).unwrap_or(most),
        ValueOf::Sum | ValueOf::OpticalDepth => total,
    })
}

/// The largest value before the first fall from at least `threshold`.
fn local_maximum(turns: &[f64], threshold: f64, fall: f64) -> Option<f64> {
    let so_far = turns.iter().scan(f64::NEG_INFINITY, |most, &v| {
        *most = most.max(v);
        Some((*most, v))
    });
    so_far.into_iter().find(|&(most, v)| most >= threshold && v < most - fall).map(|(most, _)| most)
}

/// Premultiplied linear RGBA of the level surfaces along a ray.
pub(super) fn surfaces(oracle: &Oracle<'_>, surfaces: &[Surface], ray: &Ray) -> [f64; 4] {
    let (mut rgb, mut transmittance) = ([0.0; 3], 1.0);
    let mut inside: Vec<Option<bool>> = vec![None; surfaces.len()];
    for shown in passages(oracle, ray) {
        let Some((passage, value)) = shown else {
            // What is hidden has no inside, and its border is no crossing.
            inside.fill(None);
            continue;
        };
        let mut found: Vec<(f64, usize)> = Vec::new();
        for (n, surface) in surfaces.iter().enumerate() {
            let is_inside = |t: f64| value.at(t) >= surface.value;
            let mut state = inside[n].unwrap_or(is_inside(0.0));
            for [from, to] in critical_points(&value.0).stretches() {
                if is_inside(to) != state {
                    let at = crossing(|t| value.at(t) - surface.value, from, to);
                    found.push((at.unwrap_or(from), n));
                    state = !state;
                }
            }
            inside[n] = Some(state);
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (t, n) in found {
            let Surface { opacity, color, .. } = surfaces[n];
            let gradients = Cell::new(oracle.volume, passage.cell).gradients_per_mm();
            let g = DVec3::from_array(std::array::from_fn(|a| along(&gradients.map(|g| g[a]), &passage).at(t)));
            let at_mm = passage.from_mm + t * passage.length_mm;
            let (reflected, added) = oracle.scene.factors(ray, at_mm, g, |_| 1.0);
            for c in 0..3 {
                rgb[c] += transmittance * opacity * (color[c] * reflected[c] + added[c]);
            }
            transmittance *= 1.0 - opacity;
        }
    }
    let [r, g, b] = rgb;
    [r, g, b, 1.0 - transmittance]
}

/// The values along the passages of a ray; `None` for a hidden one.
fn passages<'a>(oracle: &'a Oracle<'_>, ray: &Ray) -> impl Iterator<Item = Option<(Passage, Cubic)>> + 'a {
    let path = oracle.path(ray, 0.0, f64::INFINITY);
    let passages = path.into_iter().flat_map(|path| path.passages().collect::<Vec<_>>());
    passages.flat_map(|passage| oracle.functions.along(passage)).map(|(passage, patches)| {
        patches?;
        let values = Cell::new(oracle.volume, passage.cell).values();
        Some((passage, along(&values, &passage)))
    })
}
