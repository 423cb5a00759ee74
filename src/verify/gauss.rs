//! A fourth-order march, in f64: two-point Gauss collocation on each interval.
//!
//! With `T' = −σT` and `C' = qT` along the ray, the stages of an interval of length `h` solve
//! `T_i = T − h Σ_j a_ij σ_j T_j`, two linear equations; then `T −= h/2 Σ σ_i T_i` and `C += h/2 Σ q_i T_i` (Hairer, Nørsett and
//! Wanner, *Solving ordinary differential equations I*, II.7). Knots and faces cap it at order 2 as they do any fixed step.

use glam::DVec3;

use super::manufactured::rays;
use crate::error::Result;
use crate::scene::{Ray, Scene};
use crate::transfer::Optics;
use crate::volume::{Grid, Volume};

/// Places of the two nodes in an interval, as shares of it: 1/2 ∓ √3/6.
const NODES: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];

/// Every pixel of a scene by fixed steps of at most `step_mm`, equal along each ray. No shading, no gradient.
pub(super) fn render(volume: &Volume, scene: &Scene, step_mm: f64) -> Result<Vec<[f64; 4]>> {
    let function = &scene.transfer_function;
    let at = |point_mm: DVec3| function.evaluate(interpolate(volume, point_mm), 0.0);
    Ok(rays(scene).map(|ray| integrate(volume.grid(), &ray, step_mm, at)).collect())
}

/// The picture of optics given in space, in the domain of a grid.
pub(super) fn integrate(grid: &Grid, ray: &Ray, step_mm: f64, optics: impl Fn(DVec3) -> Optics) -> [f64; 4] {
    let Some([from_mm, to_mm]) = chord_mm(grid, ray) else { return [0.0; 4] };
    let intervals = ((to_mm - from_mm) / step_mm).ceil().max(1.0);
    let h = (to_mm - from_mm) / intervals;
    let (mut transmittance, mut color) = (1.0, [0.0; 3]);
    for i in 0..intervals as usize {
        let start_mm = from_mm + i as f64 * h;
        let stages = NODES.map(|node| optics(ray.origin_mm + (start_mm + node * h) * ray.direction));
        let [t0, t1] = stage_transmittances(stages.map(|o| h * o.extinction_per_mm)).map(|t| t * transmittance);
        for (c, sum) in color.iter_mut().enumerate() {
            *sum += 0.5 * h * (stages[0].emission_per_mm[c] * t0 + stages[1].emission_per_mm[c] * t1);
        }
        transmittance -= 0.5 * h * (stages[0].extinction_per_mm * t0 + stages[1].extinction_per_mm * t1);
    }
    let [r, g, b] = color;
    [r, g, b, 1.0 - transmittance]
}

/// Transmittances at the nodes for a transmittance of 1 at the start, by Cramer's rule on `(I + A diag(x)) T = 1`.
fn stage_transmittances([x0, x1]: [f64; 2]) -> [f64; 2] {
    let root = 3.0_f64.sqrt() / 6.0;
    let [a, b] = [1.0 + 0.25 * x0, (0.25 - root) * x1];
    let [c, d] = [(0.25 + root) * x0, 1.0 + 0.25 * x1];
    let determinant = a * d - b * c;
    [(d - b) / determinant, (a - c) / determinant]
}

/// Where a ray enters and leaves the domain of a grid, mm along it and in front of its origin.
pub fn chord_mm(grid: &Grid, ray: &Ray) -> Option<[f64; 2]> {
    let origin = grid.lps_mm_to_index().transform_point3(ray.origin_mm);
    let direction = grid.lps_mm_to_index().transform_vector3(ray.direction);
    let (low, high) = grid.index_bounds();
    let (mut from_mm, mut to_mm) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        if direction[axis] != 0.0 {
            let (a, b) = (low[axis] - origin[axis], high[axis] - origin[axis]);
            let (a, b) = (a / direction[axis], b / direction[axis]);
            (from_mm, to_mm) = (from_mm.max(a.min(b)), to_mm.min(a.max(b)));
        } else if origin[axis] < low[axis] || origin[axis] > high[axis] {
            return None;
        }
    }
    (from_mm < to_mm && to_mm.is_finite()).then_some([from_mm, to_mm])
}

/// The value at a point in LPS mm, trilinear and in f64; a point beyond the domain has the value of its border. At least
/// two voxels along each axis.
/// For even slices only, as the volumes of this module are.
pub fn interpolate(volume: &Volume, point_mm: DVec3) -> f64 {
    let grid = volume.grid();
    let index = grid.lps_mm_to_index().transform_point3(point_mm);
    let corner: [usize; 3] = std::array::from_fn(|a| (index[a].max(0.0) as usize).min(grid.dims()[a] - 2));
    let share: [f64; 3] = std::array::from_fn(|a| (index[a] - corner[a] as f64).clamp(0.0, 1.0));
    let upper = |c: usize, a: usize| c >> a & 1;
    (0..8)
        .map(|c| {
            let weight: f64 = (0..3).map(|a| if upper(c, a) == 1 { share[a] } else { 1.0 - share[a] }).product();
            weight * volume.value(std::array::from_fn(|a| corner[a] + upper(c, a)))
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_long_step_through_fog_is_a_pade_approximant() {
        // Two-point Gauss collocation of e^{-x} is its (2, 2) Padé approximant.
        let grid = Grid::axis_aligned([2; 3], DVec3::splat(3.0)).unwrap();
        let ray = Ray { origin_mm: DVec3::new(-1.0, 1.0, 2.0), direction: DVec3::X };
        let found = integrate(&grid, &ray, 10.0, |_| Optics::colored(0.4, [0.5, 0.0, 1.0]));
        let x = 1.2;
        let alpha = 1.0 - (1.0 - x / 2.0 + x * x / 12.0) / (1.0 + x / 2.0 + x * x / 12.0);
        let expected = [0.5 * alpha, 0.0, alpha, alpha];
        assert!(
            super::super::largest_difference(&[found], &[expected]) < 1e-15,
            "found {found:?}, expected {expected:?}"
        );
    }

    #[test]
    fn the_value_at_a_lattice_point_is_its_own() {
        let volume = super::super::manufactured::sampled(super::super::manufactured::trilinear, 3).unwrap();
        for index in [[0, 0, 0], [2, 1, 0], [2, 2, 2], [1, 1, 1]] {
            let point = volume.grid().index_to_lps_mm().transform_point3(DVec3::from_array(index.map(|i| i as f64)));
            assert_eq!(interpolate(&volume, point), volume.value(index), "voxel {index:?}");
        }
    }
}
