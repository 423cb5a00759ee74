//! A grid as VTK places images: spacing along three perpendicular axes that are right-handed, and a rigid motion.

use glam::{DAffine3, DMat3, DVec3};

use crate::error::{Error, Fault, Result};
use crate::volume::Grid;

/// Cosine between two axes above which the grid counts as sheared.
const SHEAR: f64 = 1e-6;

/// Where an image lies: `motion · (spacing · index)`, with the slices in reverse order if the grid is left-handed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub(super) spacing_mm: DVec3,
    pub(super) motion: DAffine3,
    dims: [usize; 3],
    reversed: bool,
}

impl Frame {
    /// The frame of a grid.
    ///
    /// # Errors
    /// `Fault::Unsupported` for a sheared grid.
    pub(super) fn new(grid: &Grid) -> Result<Self> {
        let spacing_mm = grid.spacing_mm();
        let DAffine3 { matrix3: m, translation } = grid.index_to_lps_mm();
        let mut axes = DMat3::from_cols(m.x_axis / spacing_mm.x, m.y_axis / spacing_mm.y, m.z_axis / spacing_mm.z);
        let cosines = [axes.x_axis.dot(axes.y_axis), axes.y_axis.dot(axes.z_axis), axes.z_axis.dot(axes.x_axis)];
        if let Some(cosine) = cosines.into_iter().find(|c| c.abs() > SHEAR) {
            return Err(Error::new(Fault::Unsupported, "VTK has no sheared images")
                .element("the volume's axes")
                .found(format!("two axes at {:.3} degrees", cosine.acos().to_degrees()))
                .expected("90 degrees"));
        }
        let dims = grid.dims();
        let reversed = axes.determinant() < 0.0;
        let mut origin = translation;
        if reversed {
            origin += (dims[2] - 1) as f64 * m.z_axis;
            axes.z_axis = -axes.z_axis;
        }
        Ok(Frame { spacing_mm, motion: DAffine3::from_mat3_translation(axes, origin), dims, reversed })
    }

    /// A range of continuous indices `[low, high]` along an axis of the grid, in the order of this frame.
    pub(super) fn range(&self, axis: usize, [low, high]: [f64; 2]) -> [f64; 2] {
        let last = (self.dims[axis] - 1) as f64;
        if axis == 2 && self.reversed { [last - high, last - low] } else { [low, high] }
    }

    /// Voxels in the order of this frame.
    pub(super) fn ordered(&self, voxels: &[f32]) -> Vec<f32> {
        let slice = self.dims[0] * self.dims[1];
        if self.reversed { voxels.chunks(slice).rev().flatten().copied().collect() } else { voxels.to_vec() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_left_handed_grid_is_the_same_voxels_at_the_same_places() {
        let m = DMat3::from_cols(DVec3::new(0.0, 2.0, 0.0), DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 0.0, 3.0));
        assert!(m.determinant() < 0.0, "left-handed");
        let grid = Grid::new([2, 2, 3], DAffine3::from_mat3_translation(m, DVec3::new(5.0, 6.0, 7.0))).unwrap();
        let frame = Frame::new(&grid).unwrap();
        let voxels: Vec<f32> = (0..12).map(|i| i as f32).collect();
        let ordered = frame.ordered(&voxels);
        assert!(frame.motion.matrix3.determinant() > 0.0, "right-handed");
        for (i, &found) in ordered.iter().enumerate() {
            let [x, y, z] = grid.unflatten(i);
            let at = frame.motion.transform_point3(frame.spacing_mm * DVec3::new(x as f64, y as f64, z as f64));
            let index = grid.lps_mm_to_index().transform_point3(at).round();
            let same = voxels[grid.flatten([index.x as usize, index.y as usize, index.z as usize])];
            assert_eq!(found, same, "the voxel at {at}");
        }
    }

    #[test]
    fn shear_is_refused() {
        let m = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(0.0, 0.3, 1.0));
        let grid = Grid::new([2, 2, 2], DAffine3::from_mat3(m)).unwrap();
        assert!(Frame::new(&grid).unwrap_err().to_string().contains("sheared"));
    }
}
