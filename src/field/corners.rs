//! The corners of cells in memory.

use crate::math::each;

/// Where in memory the corners of a cell are, for anything that is stored per voxel, x fastest, then y, then z.
#[derive(Debug, Clone, Copy)]
pub struct Corners {
    strides: [usize; 3],
    /// From a cell's lower corner to its eight corners; corner `c` is the upper one along axis `a` if bit `a` of `c` is set.
    offsets: [usize; 8],
}

impl Corners {
    /// The corners on a lattice of `dims` voxels; along an axis of one voxel both ends of a cell are that voxel.
    pub fn new(dims: [usize; 3]) -> Self {
        let [nx, ny, _] = dims;
        let strides = [1, nx, nx * ny];
        let step = |c: usize, a: usize| if dims[a] == 1 || c >> a & 1 == 0 { 0 } else { strides[a] };
        Corners { strides, offsets: each(|c| step(c, 0) + step(c, 1) + step(c, 2)) }
    }

    /// Places of the corners of the cell with this lower corner.
    #[inline(always)]
    pub fn of(&self, [i, j, k]: [usize; 3]) -> [usize; 8] {
        let [sx, sy, sz] = self.strides;
        let base = i * sx + j * sy + k * sz;
        each(|c| base + self.offsets[c])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_counted_x_fastest_and_a_single_voxel_is_its_own_neighbour() {
        assert_eq!(Corners::new([5, 4, 3]).of([1, 2, 0]), [11, 12, 16, 17, 31, 32, 36, 37]);
        assert_eq!(Corners::new([5, 1, 3]).of([1, 0, 1]), [6, 7, 6, 7, 11, 12, 11, 12]);
    }
}
