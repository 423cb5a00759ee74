//! Pictures that are not of light: one number of the values along a ray, or level surfaces.
//!
//! Cubics are taken apart at their critical points; nothing is skipped by corners or coefficients, and crossings are found
//! by bisection.

use glam::DVec3;

use super::Oracle;
use super::bernstein::Cubic;
use super::cell::{Cell, along};
use super::path::{Passage, Path};
use super::roots::{critical_points, crossing};
use crate::scene::{Ray, Surface, ValueModel, ValueOf};

/// One number of the values along a ray, or `None` if it misses the volume.
pub(super) fn number(oracle: &Oracle<'_>, model: &ValueModel, ray: &Ray) -> Option<f64> {
    let (mut most, mut least, mut total, mut length_mm) = (f64::NEG_INFINITY, f64::INFINITY, 0.0, 0.0);
    for (passage, value) in passages(oracle, ray) {
        for [from, to] in critical_points(&value.0).stretches() {
            for v in [value.at(from), value.at(to)] {
                most = f64::max(most, v);
                least = f64::min(least, v);
            }
        }
        total += value.mean() * passage.length_mm;
        length_mm += passage.length_mm;
    }
    (length_mm > 0.0).then_some(match model.of {
        ValueOf::Maximum => most,
        ValueOf::Minimum => least,
        ValueOf::Mean => total / length_mm,
    })
}

/// Premultiplied linear RGBA of the level surfaces along a ray.
pub(super) fn surfaces(oracle: &Oracle<'_>, surfaces: &[Surface], ray: &Ray) -> [f64; 4] {
    let (mut rgb, mut transmittance) = ([0.0; 3], 1.0);
    let mut inside: Vec<Option<bool>> = vec![None; surfaces.len()];
    for (passage, value) in passages(oracle, ray) {
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
            let (reflected, highlight) = match &oracle.scene.shading {
                Some(shading) => shading.factors(g, ray.direction),
                None => ([1.0; 3], [0.0; 3]),
            };
            for c in 0..3 {
                rgb[c] += transmittance * opacity * (color[c] * reflected[c] + highlight[c]);
            }
            transmittance *= 1.0 - opacity;
        }
    }
    let [r, g, b] = rgb;
    [r, g, b, 1.0 - transmittance]
}

fn passages<'a>(oracle: &'a Oracle<'_>, ray: &Ray) -> impl Iterator<Item = (Passage, Cubic)> + 'a {
    let path = Path::new(oracle.volume.grid(), ray, 0.0, f64::INFINITY);
    let path = path.map(|path| path.through(oracle.volume.slices()));
    path.into_iter().flat_map(|path| path.passages().collect::<Vec<_>>()).map(|passage| {
        let values = Cell::new(oracle.volume, passage.cell).values();
        (passage, along(&values, &passage))
    })
}
