//! Media given at the voxels: emission and extinction are interpolated at each sample.

use glam::Vec4;

use super::medium::Pointwise;
use crate::classify::Rgbs;
use crate::error::Result;
use crate::field::{Corners, Position};
use crate::integrate::shade::Course;
use crate::integrate::texels::Texels;

/// A medium given at the voxels; shading is in the texels already.
pub(in super::super) struct AtVoxels<T> {
    corners: Corners,
    texels: T,
}

impl<T: Texels<f32>> AtVoxels<T> {
    /// The medium of these texels, x fastest, then y, then z.
    ///
    /// # Errors
    /// `Fault::Limit` for an axis longer than positions can address.
    pub(in super::super) fn new(texels: T, dims: [usize; 3]) -> Result<Self> {
        Position::check(dims)?;
        Ok(AtVoxels { corners: Corners::new(dims), texels })
    }

    /// True if the voxel in this place of memory absorbs or emits.
    pub(in super::super) fn is_lit(&self, voxel: usize) -> bool {
        self.texels.optics(voxel) != [0.0; 4]
    }
}

impl<T: Texels<f32>> Pointwise for AtVoxels<T> {
    type Aim = ();

    fn aim(&self, _: &Course, (): &mut ()) {}

    #[inline(always)]
    fn sample(&self, (): &(), position: Position, _: f64) -> Rgbs<f32> {
        let cell = position.even_cell();
        let [u, v, w] = cell.fraction;
        let at = self.corners.of(cell.corner).map(|voxel| Vec4::from_array(self.texels.optics(voxel)));
        let row = |c: usize| at[c] + (at[c + 1] - at[c]) * u;
        let (front, back) = (row(0) + (row(2) - row(0)) * v, row(4) + (row(6) - row(4)) * v);
        // Rounding may leave a trace below 0.
        (front + (back - front) * w).max(Vec4::ZERO).to_array()
    }
}
