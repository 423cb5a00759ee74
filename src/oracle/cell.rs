//! The field in one cell: values and gradients at its corners, and any trilinear field along a path as a cubic.

use glam::DVec3;

use super::bernstein::{Bernstein, Cubic};
use super::path::Passage;
use crate::volume::Volume;

/// A cell of a volume. Corner `c` lies at the upper end of axis `a` where bit `a` of `c` is set.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell<'a> {
    volume: &'a Volume,
    corners: [[usize; 3]; 8],
}

impl<'a> Cell<'a> {
    /// The cell with this lowest corner; along an axis of one voxel both ends are that voxel.
    pub(super) fn new(volume: &'a Volume, lowest: [usize; 3]) -> Self {
        let dims = volume.grid().dims();
        let corners = std::array::from_fn(|c| std::array::from_fn(|a| (lowest[a] + (c >> a & 1)).min(dims[a] - 1)));
        Cell { volume, corners }
    }

    /// The lattice points at the corners.
    pub(super) fn corners(&self) -> [[usize; 3]; 8] {
        self.corners
    }

    /// Values at the corners.
    pub(super) fn values(&self) -> [f64; 8] {
        self.corners.map(|c| self.volume.value(c))
    }

    /// Gradients at the corners, per mm in LPS.
    pub(super) fn gradients_per_mm(&self) -> [DVec3; 8] {
        self.corners.map(|c| gradient_per_mm(self.volume, c))
    }
}

/// Difference between the neighbours of a lattice point over their distance, one-sided at the border, 0 along an axis of
/// one voxel; per mm in LPS.
fn gradient_per_mm(volume: &Volume, voxel: [usize; 3]) -> DVec3 {
    let grid = volume.grid();
    let per_index = std::array::from_fn(|a| {
        let (mut low, mut high) = (voxel, voxel);
        low[a] = voxel[a].saturating_sub(1);
        high[a] = (voxel[a] + 1).min(grid.dims()[a] - 1);
        let steps = match volume.slices() {
            Some(slices) if a == 2 => slices.positions()[high[a]] - slices.positions()[low[a]],
            _ => (high[a] - low[a]) as f64,
        };
        if steps == 0.0 { 0.0 } else { (volume.value(high) - volume.value(low)) / steps }
    });
    grid.gradient_to_per_mm() * DVec3::from_array(per_index)
}

/// The trilinear function of these corner values along a passage: its polar form at the mixed ends of the passage.
pub(super) fn along(corners: &[f64; 8], passage: &Passage) -> Cubic {
    let (p, q) = (passage.entry, passage.exit);
    let between = |a: f64, b: f64, t: f64| a + t * (b - a);
    let at = |x: f64, y: f64, z: f64| {
        let row = |c: usize| between(corners[c], corners[c + 1], x);
        between(between(row(0), row(2), y), between(row(4), row(6), y), z)
    };
    // A mean that keeps equal numbers as they are.
    let mean = |a: f64, b: f64, c: f64| a + ((b - a) + (c - a)) / 3.0;
    Bernstein([
        at(p[0], p[1], p[2]),
        mean(at(q[0], p[1], p[2]), at(p[0], q[1], p[2]), at(p[0], p[1], q[2])),
        mean(at(p[0], q[1], q[2]), at(q[0], p[1], q[2]), at(q[0], q[1], p[2])),
        at(q[0], q[1], q[2]),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Grid, Quantity, Rescale, Samples};
    use glam::{DAffine3, DMat3};

    #[test]
    fn a_trilinear_field_along_a_path_is_the_cubic() {
        let corners = [3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0, 6.0];
        let passage =
            Passage { cell: [0; 3], entry: [0.1, 0.9, 0.0], exit: [0.8, 0.2, 1.0], length_mm: 1.0, from_mm: 0.0 };
        let cubic = along(&corners, &passage);
        for t in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let x: [f64; 3] = std::array::from_fn(|a| (1.0 - t) * passage.entry[a] + t * passage.exit[a]);
            let expected: f64 = (0..8)
                .map(|c| (0..3).map(|a| if c >> a & 1 == 1 { x[a] } else { 1.0 - x[a] }).product::<f64>() * corners[c])
                .sum();
            assert!((cubic.at(t) - expected).abs() < 3e-15, "at {t}: found {}, expected {expected}", cubic.at(t));
        }
    }

    #[test]
    fn the_gradient_of_a_linear_field_is_its_coefficient_also_at_the_border() {
        let m = DMat3::from_cols(DVec3::new(0.3, 0.1, 0.0), DVec3::new(-0.2, 0.5, 0.3), DVec3::new(0.0, 0.7, -5.0));
        let grid = Grid::new([3, 2, 4], DAffine3::from_mat3_translation(m, DVec3::new(7.0, -3.0, 2.0))).unwrap();
        let a = DVec3::new(30.0, -20.0, 5.0);
        let sample = |i: usize| {
            let voxel = grid.unflatten(i).map(|x| x as f64);
            a.dot(grid.index_to_lps_mm().transform_point3(voxel.into())) as f32
        };
        let samples = Samples::F32((0..24).map(sample).collect());
        let volume = Volume::new(grid, samples, Rescale::IDENTITY, Quantity::Hu).unwrap();
        for lowest in [[0, 0, 0], [1, 0, 2]] {
            for g in Cell::new(&volume, lowest).gradients_per_mm() {
                // Samples of about 100 in f32 leave a gradient uncertain by a few 1e-5 per index step.
                assert!((g - a).length() < 1e-3, "found {g}, expected {a}");
            }
        }
    }
}
