//! A class for each voxel, which a mask tells apart.

use super::Volume;
use crate::error::{Error, Fault, Result};

/// The class of each voxel, x fastest, then y, then z: one byte per voxel.
///
/// **Definition.** A point has the class of the lattice point nearest to it, halfway between two that of the upper one: along
/// each axis the class changes where the continuous index passes `i + 1/2`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Classes {
    values: Vec<u8>,
    count: usize,
}

impl Classes {
    /// The class of each voxel, x fastest.
    pub fn values(&self) -> &[u8] {
        &self.values
    }

    /// One more than the highest class.
    pub fn count(&self) -> usize {
        self.count
    }
}

impl Volume {
    /// The same volume with a class for each voxel, x fastest.
    ///
    /// # Errors
    /// `Fault::Input` if there are not as many as voxels.
    pub fn with_classes(mut self, values: Vec<u8>) -> Result<Self> {
        if values.len() != self.grid.voxel_count() {
            return Err(Error::new(Fault::Input, "the number of classes does not match the grid")
                .found(format!("{} classes", values.len()))
                .expected(format!("{} for {:?} voxels", self.grid.voxel_count(), self.grid.dims())));
        }
        let count = values.iter().max().map_or(0, |&most| usize::from(most) + 1);
        self.classes = Some(Classes { values, count });
        Ok(self)
    }

    /// The class of each voxel, where there are classes.
    pub fn classes(&self) -> Option<&Classes> {
        self.classes.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};

    #[test]
    fn there_is_one_class_for_each_voxel() {
        let grid = Grid::axis_aligned([3, 1, 1], DVec3::ONE).expect("a valid grid");
        let made = || Volume::new(grid, Samples::I16(vec![0; 3]), Rescale::IDENTITY, Quantity::Hu).expect("valid");
        let volume = made().with_classes(vec![0, 4, 1]).expect("three classes for three voxels");
        assert_eq!(volume.classes().map(|c| (c.count(), c.values())), Some((5, &[0, 4, 1][..])));
        assert!(made().with_classes(vec![0; 2]).is_err(), "one is missing");
        assert_eq!(made().classes(), None);
    }
}
