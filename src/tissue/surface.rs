//! The area of the surface between voxels of a tissue and others.
//!
//! **Cauchy–Crofton.** A line in a direction `u` crosses a surface `∫ |n·u| dS` times per area of the plane across it, and the
//! mean of `|n·u|` over all directions is 1/2. So the area is twice the mean, over directions, of the crossings counted along
//! the lines of the lattice in that direction, each times the area a line stands for (Lehmann and Legland 2012,
//! hdl.handle.net/10380/3342). Thirteen directions are counted: to the voxels that share a face, an edge or a corner. The
//! lattice may be anisotropic or sheared, for directions are weighted by the share of the sphere that is nearest to them.

use glam::{DVec3, IVec3};
use rayon::prelude::*;

use crate::volume::{Grid, LabelMap};

/// Points on the sphere that weights are counted with: their error is far below that of thirteen directions.
const SPHERE_POINTS: usize = 20_000;

/// Voxels of a row that are compared at once: most neighbours are alike.
const BLOCK: usize = 64;

/// Area in mm² of the surface of each segment. Where the volume ends is no surface.
pub(super) fn areas_mm2(map: &LabelMap) -> Vec<f64> {
    let directions = directions();
    let areas_per_crossing = areas_per_crossing_mm2(map.grid(), &directions);
    let crossings = crossings(map, &directions);
    let area = |n: usize| crossings.iter().zip(&areas_per_crossing).map(|(of, area)| of[n + 1] as f64 * area).sum();
    (0..map.segments().len()).map(area).collect()
}

/// One of each pair of opposite steps to a neighbour.
fn directions() -> Vec<IVec3> {
    let steps = (0..27).map(|n| IVec3::new(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
    // Those that come later in memory, so that each pair of voxels is counted once.
    steps.filter(|s| (s.z, s.y, s.x) > (0, 0, 0)).collect()
}

/// What a crossing along each direction adds to the area.
fn areas_per_crossing_mm2(grid: &Grid, directions: &[IVec3]) -> Vec<f64> {
    let steps: Vec<DVec3> = directions.iter().map(|d| grid.index_to_lps_mm().matrix3 * d.as_dvec3()).collect();
    let units: Vec<DVec3> = steps.iter().map(|step| step.normalize()).collect();
    let mut nearest = vec![0_usize; steps.len()];
    for n in 0..SPHERE_POINTS {
        // A Fibonacci lattice: equal areas, evenly spread.
        let z = 1.0 - (2 * n + 1) as f64 / SPHERE_POINTS as f64;
        let turn = n as f64 * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let point = DVec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z);
        let along = |d: &usize| units[*d].dot(point).abs();
        let best = (0..units.len()).max_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(0);
        nearest[best] += 1;
    }
    let share = |n: usize| nearest[n] as f64 / SPHERE_POINTS as f64;
    steps.iter().enumerate().map(|(n, step)| 2.0 * share(n) * grid.voxel_mm3() / step.length()).collect()
}

/// For each direction, how often each segment (and 0, none) is entered or left.
fn crossings(map: &LabelMap, directions: &[IVec3]) -> Vec<Vec<u64>> {
    let [nx, ny, nz] = map.grid().dims();
    let voxels = map.voxels();
    let count = |k: usize| {
        let mut of_slice = vec![vec![0_u64; map.segments().len() + 1]; directions.len()];
        for (j, (d, step)) in (0..ny).flat_map(|j| directions.iter().enumerate().map(move |step| (j, step))) {
            let (Some(other_j), Some(other_k)) =
                (j.checked_add_signed(step.y as isize), k.checked_add_signed(step.z as isize))
            else {
                continue;
            };
            if other_j >= ny || other_k >= nz {
                continue;
            }
            let (row, other) = (&voxels[nx * (j + ny * k)..][..nx], &voxels[nx * (other_j + ny * other_k)..][..nx]);
            let (row, other) = match step.x {
                0 => (row, other),
                1 => (&row[..nx - 1], &other[1..]),
                _ => (&row[1..], &other[..nx - 1]),
            };
            let unlike = row.chunks(BLOCK).zip(other.chunks(BLOCK)).filter(|(a, b)| a != b);
            for (&a, &b) in unlike.flat_map(|(a, b)| a.iter().zip(b)).filter(|(a, b)| a != b) {
                of_slice[d][usize::from(a)] += 1;
                of_slice[d][usize::from(b)] += 1;
            }
        }
        of_slice
    };
    let zero = || vec![vec![0_u64; map.segments().len() + 1]; directions.len()];
    let add = |mut sum: Vec<Vec<u64>>, more: Vec<Vec<u64>>| {
        sum.iter_mut().flatten().zip(more.iter().flatten()).for_each(|(sum, more)| *sum += more);
        sum
    };
    (0..nz).into_par_iter().map(count).reduce(zero, add)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::Segment;
    use glam::{DAffine3, DMat3};

    fn area(grid: Grid, inside: impl Fn(DVec3) -> bool) -> f64 {
        let at = |index: usize| grid.index_to_lps_mm().transform_point3(grid.unflatten(index).map(|i| i as f64).into());
        let voxels = (0..grid.voxel_count()).map(|index| u8::from(inside(at(index)))).collect();
        let segment = Segment { name: "ball".into(), label: 1, color_srgb: [1.0; 3], concept: None };
        areas_mm2(&LabelMap::new(grid, vec![segment], voxels).unwrap())[0]
    }

    fn assert_within(found: f64, expected: f64, share: f64, what: &str) {
        let off = (found / expected - 1.0).abs();
        assert!(off < share, "{what}: found {found:.1} mm², expected {expected:.1} mm² within {share}");
    }

    #[test]
    fn a_ball_has_its_area_on_any_lattice() {
        let expected = 4.0 * std::f64::consts::PI * 144.0;
        let upright = Grid::axis_aligned([41, 41, 41], DVec3::splat(0.7)).unwrap();
        assert_within(area(upright, |p| p.distance(DVec3::splat(14.0)) < 12.0), expected, 0.02, "isotropic");
        let flat = Grid::axis_aligned([41, 41, 15], DVec3::new(0.7, 0.7, 2.0)).unwrap();
        assert_within(area(flat, |p| p.distance(DVec3::splat(14.0)) < 12.0), expected, 0.02, "thick slices");
        let matrix = DMat3::from_cols(DVec3::new(0.7, 0.0, 0.0), DVec3::new(0.0, 0.7, 0.0), DVec3::new(0.0, 0.3, 1.0));
        let sheared = Grid::new([41, 60, 29], DAffine3::from_mat3(matrix)).unwrap();
        assert_within(area(sheared, |p| p.distance(DVec3::new(14.0, 23.0, 14.0)) < 12.0), expected, 0.02, "sheared");
    }

    #[test]
    fn a_thin_sheet_has_two_sides() {
        let grid = Grid::axis_aligned([40, 40, 9], DVec3::ONE).unwrap();
        // A plane along the lattice is what thirteen directions know least.
        assert_within(area(grid, |p| p.z == 4.0), 2.0 * 40.0 * 40.0, 0.12, "a sheet one voxel thick");
    }
}
