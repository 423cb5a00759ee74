//! The lattice and its affine map to the patient.

use glam::{DAffine3, DMat3, DVec3};

use crate::error::{Error, Fault, Result};

/// A lattice of voxels and the affine map from voxel index to LPS millimetres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    dims: [usize; 3],
    index_to_lps_mm: DAffine3,
    lps_mm_to_index: DAffine3,
}

impl Grid {
    /// A lattice of `dims` voxels; the columns of the affine's matrix are the steps in mm along i, j and k.
    ///
    /// # Errors
    /// `Fault::Geometry` for an axis of no voxels, numbers that are not finite, or a map without an inverse.
    pub fn new(dims: [usize; 3], index_to_lps_mm: DAffine3) -> Result<Self> {
        if dims.contains(&0) {
            return Err(Error::new(Fault::Geometry, "the volume has an axis of no voxels")
                .found(format!("{} x {} x {}", dims[0], dims[1], dims[2])));
        }
        let matrix = index_to_lps_mm.matrix3;
        let volume_of_axes = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
        // Relative to the axes' lengths, so that spacings of nanometres and of metres are judged alike.
        let flatness = matrix.determinant().abs() / volume_of_axes;
        if !index_to_lps_mm.is_finite() || !flatness.is_finite() || flatness < 1e-6 {
            return Err(Error::new(Fault::Geometry, "the voxel axes do not span space")
                .found(format!("steps of {:?}, {:?} and {:?} mm", matrix.x_axis, matrix.y_axis, matrix.z_axis))
                .expected("three finite steps that do not lie in one plane"));
        }
        Ok(Grid { dims, index_to_lps_mm, lps_mm_to_index: index_to_lps_mm.inverse() })
    }

    /// A lattice along the patient's axes with the first voxel at the origin.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn axis_aligned(dims: [usize; 3], spacing_mm: DVec3) -> Result<Self> {
        Grid::new(dims, DAffine3::from_scale(spacing_mm))
    }

    /// Number of voxels along i, j and k.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Number of voxels in all.
    pub fn voxel_count(&self) -> usize {
        self.dims.iter().product()
    }

    /// Voxel index to LPS millimetres.
    pub fn index_to_lps_mm(&self) -> DAffine3 {
        self.index_to_lps_mm
    }

    /// Voxel index to LPS millimetres as three rows of four numbers, `[r0 r1 r2 t]`, as files and programs exchange it.
    pub fn index_to_lps_mm_rows(&self) -> [[f64; 4]; 3] {
        let DAffine3 { matrix3: m, translation: t } = self.index_to_lps_mm;
        std::array::from_fn(|row| [m.x_axis[row], m.y_axis[row], m.z_axis[row], t[row]])
    }

    /// LPS millimetres to voxel index.
    pub fn lps_mm_to_index(&self) -> DAffine3 {
        self.lps_mm_to_index
    }

    /// Length in mm of one step along i, j and k.
    pub fn spacing_mm(&self) -> DVec3 {
        let m = self.index_to_lps_mm.matrix3;
        DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length())
    }

    /// Volume in mm³ that a voxel stands for.
    pub fn voxel_mm3(&self) -> f64 {
        self.index_to_lps_mm.matrix3.determinant().abs()
    }

    /// The map of a gradient per index step to a gradient per mm: the inverse transpose of the affine's matrix, so that
    /// the gradient stays a covector under rotation, anisotropic spacing, shear and reflection.
    pub fn gradient_to_per_mm(&self) -> DMat3 {
        self.lps_mm_to_index.matrix3.transpose()
    }

    /// Linear index of a voxel.
    pub fn flatten(&self, [i, j, k]: [usize; 3]) -> usize {
        let [nx, ny, nz] = self.dims;
        assert!(i < nx && j < ny && k < nz, "voxel ({i}, {j}, {k}) lies outside {nx} x {ny} x {nz}");
        i + nx * (j + ny * k)
    }

    /// Voxel of a linear index; the inverse of [`Grid::flatten`].
    pub fn unflatten(&self, index: usize) -> [usize; 3] {
        let [nx, ny, _] = self.dims;
        [index % nx, index / nx % ny, index / (nx * ny)]
    }

    /// Lowest and highest continuous index of the domain: `[0, n-1]`, or `[-1/2, 1/2]` along an axis of one voxel.
    pub fn index_bounds(&self) -> (DVec3, DVec3) {
        let low = self.dims.map(|n| if n == 1 { -0.5 } else { 0.0 });
        let high = self.dims.map(|n| if n == 1 { 0.5 } else { (n - 1) as f64 });
        (DVec3::from_array(low), DVec3::from_array(high))
    }

    /// The eight corners of the domain, LPS mm.
    pub fn corners_mm(&self) -> [DVec3; 8] {
        let (low, high) = self.index_bounds();
        std::array::from_fn(|c| {
            let pick = |bit: usize, a: f64, b: f64| if c & bit == 0 { a } else { b };
            let index = DVec3::new(pick(1, low.x, high.x), pick(2, low.y, high.y), pick(4, low.z, high.z));
            self.index_to_lps_mm.transform_point3(index)
        })
    }

    /// Length of the longest chord of the domain, mm: the longest of the four diagonals of a parallelepiped.
    pub fn longest_chord_mm(&self) -> f64 {
        let corners_mm = self.corners_mm();
        (0..4).map(|c| corners_mm[c].distance(corners_mm[7 - c])).fold(0.0, f64::max)
    }

    /// Centre of the domain, LPS mm.
    pub fn center_mm(&self) -> DVec3 {
        let (low, high) = self.index_bounds();
        self.index_to_lps_mm.transform_point3(0.5 * (low + high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_chord_is_the_longest_diagonal() {
        let grid = Grid::axis_aligned([4, 5, 13], DVec3::ONE).unwrap();
        assert_eq!(grid.longest_chord_mm(), 13.0);
    }

    #[test]
    fn gradient_of_a_linear_field_is_its_coefficient_under_shear() {
        let m = DMat3::from_cols(DVec3::new(0.3, 0.1, 0.0), DVec3::new(-0.2, 0.5, 0.3), DVec3::new(0.0, 0.7, -5.0));
        let grid = Grid::new([4, 4, 4], DAffine3::from_mat3_translation(m, DVec3::new(7.0, -3.0, 2.0))).unwrap();
        let a = DVec3::new(3.0, -2.0, 0.5);
        let at = |i: DVec3| a.dot(grid.index_to_lps_mm().transform_point3(i));
        let per_index =
            DVec3::new(at(DVec3::X) - at(DVec3::ZERO), at(DVec3::Y) - at(DVec3::ZERO), at(DVec3::Z) - at(DVec3::ZERO));
        let per_mm = grid.gradient_to_per_mm() * per_index;
        assert!((per_mm - a).length() < 1e-12, "found {per_mm:?}, expected {a:?}");
    }

    #[test]
    fn flat_axes_and_empty_axes_are_refused() {
        let flat = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 1e-9));
        assert!(Grid::new([2, 2, 2], DAffine3::from_mat3(flat)).is_err(), "three steps in one plane");
        assert!(Grid::axis_aligned([2, 0, 2], DVec3::ONE).is_err(), "no voxels along j");
        assert!(Grid::axis_aligned([2, 2, 2], DVec3::splat(1e-7)).is_ok(), "small voxels are fine");
    }
}
