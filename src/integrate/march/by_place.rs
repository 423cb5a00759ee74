//! Which transfer function holds at a place: the scene's everywhere, or one by the class of the nearest voxel.

use crate::classify::{Classifier, Rgbs};
use crate::field::{Cell, Macrocells};
use crate::volume::{Classes, Grid};

/// Looks up the transfer function that holds at a place. Chosen by type, once per frame.
pub(in super::super) trait ByPlace: Sync {
    /// Appended to the name of the classifier.
    const SUFFIX: &'static str;
    /// Whether the gradient magnitude matters.
    const READS_GRADIENT: bool;

    /// Emission and extinction in a cell for a stored value and a gradient magnitude in HU/mm.
    fn classify_in(&self, cell: &Cell, stored: f32, gradient_per_mm: f32) -> Rgbs<f32>;

    /// True if nothing absorbs or emits in a block of cells, by its number, for any value and gradient magnitude in these
    /// closed ranges `[low, high]`.
    fn is_empty_in(&self, block: usize, stored: [f32; 2], gradient_per_mm: [f32; 2]) -> bool;
}

impl<C: Classifier<f32>> ByPlace for C {
    const SUFFIX: &'static str = "";
    const READS_GRADIENT: bool = C::READS_GRADIENT;

    #[inline(always)]
    fn classify_in(&self, _: &Cell, stored: f32, gradient_per_mm: f32) -> Rgbs<f32> {
        self.classify(stored, gradient_per_mm)
    }

    fn is_empty_in(&self, _: usize, stored: [f32; 2], gradient_per_mm: [f32; 2]) -> bool {
        self.is_empty(stored, gradient_per_mm)
    }
}

/// A transfer function for each class.
#[derive(Debug, Clone)]
pub(in super::super) struct Masked<'a, C> {
    classifiers: Vec<C>,
    classes: &'a [u8],
    dims: [usize; 3],
    /// Per block of cells, the set of classes of its voxels, those on its upper faces included.
    present: Vec<ClassSet>,
}

/// A bit for each class.
type ClassSet = [u64; 4];

impl<'a, C> Masked<'a, C> {
    /// Classifiers by class.
    pub(in super::super) fn new(classifiers: Vec<C>, classes: &'a Classes, grid: &Grid) -> Self {
        let (classes, dims) = (classes.values(), grid.dims());
        Masked { classifiers, classes, dims, present: classes_in_blocks(classes, dims) }
    }

    fn class(&self, [i, j, k]: [usize; 3]) -> usize {
        let [nx, ny, _] = self.dims;
        usize::from(self.classes[i + nx * (j + ny * k)])
    }
}

fn classes_in_blocks(classes: &[u8], dims: [usize; 3]) -> Vec<ClassSet> {
    let [nx, ny, nz] = dims;
    let blocks = Macrocells::blocks_of(dims);
    let mut present = vec![[0; 4]; blocks.iter().product()];
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let class = classes[i + nx * (j + ny * k)];
                // A voxel on the face between blocks counts for all of them.
                let [x, y, z] = [0, 1, 2].map(|a| blocks_with([i, j, k][a], blocks[a]));
                for block_k in z {
                    for block_j in y.clone() {
                        for block_i in x.clone() {
                            let set = &mut present[block_i + blocks[0] * (block_j + blocks[1] * block_k)];
                            set[usize::from(class) / 64] |= 1 << (class % 64);
                        }
                    }
                }
            }
        }
    }
    present
}

/// The blocks along an axis that a voxel is a corner of cells of.
fn blocks_with(voxel: usize, blocks: usize) -> std::ops::RangeInclusive<usize> {
    let cells = 1 << Macrocells::LOG2_CELLS;
    let upper = (voxel / cells).min(blocks - 1);
    let on_face = voxel.is_multiple_of(cells) && upper * cells == voxel;
    (if on_face { upper.saturating_sub(1) } else { upper })..=upper
}

impl<C: Classifier<f32>> ByPlace for Masked<'_, C> {
    const SUFFIX: &'static str = "-masked";
    const READS_GRADIENT: bool = C::READS_GRADIENT;

    #[inline(always)]
    fn classify_in(&self, cell: &Cell, stored: f32, gradient_per_mm: f32) -> Rgbs<f32> {
        // Half-way the upper voxel is nearest; along an axis of one voxel the fraction is 0.
        let nearest = std::array::from_fn(|a| cell.corner[a] + usize::from(cell.fraction[a] >= 0.5));
        self.classifiers[self.class(nearest)].classify(stored, gradient_per_mm)
    }

    fn is_empty_in(&self, block: usize, stored: [f32; 2], gradient_per_mm: [f32; 2]) -> bool {
        let set = self.present[block];
        let is_present = |class: usize| set[class / 64] >> (class % 64) & 1 == 1;
        let present = self.classifiers.iter().enumerate().filter(|(class, _)| is_present(*class));
        present.map(|(_, classifier)| classifier).all(|classifier| classifier.is_empty(stored, gradient_per_mm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_holds_the_classes_of_all_corners_of_its_cells() {
        for dims in [[17, 9, 1], [16, 8, 10], [2, 30, 3], [1, 1, 1]] {
            let count: usize = dims.iter().product();
            let classes: Vec<u8> = (0..count).map(|i| ((i * 7919) % 251) as u8).collect();
            let present = classes_in_blocks(&classes, dims);
            let blocks = Macrocells::blocks_of(dims);
            for (b, set) in present.iter().enumerate() {
                let block = [b % blocks[0], b / blocks[0] % blocks[1], b / (blocks[0] * blocks[1])];
                let corner_of = |voxel: usize, a: usize| (8 * block[a]..=8 * block[a] + 8).contains(&voxel);
                for class in 0..251_usize {
                    let expected = (0..count).any(|i| {
                        let voxel = [i % dims[0], i / dims[0] % dims[1], i / (dims[0] * dims[1])];
                        usize::from(classes[i]) == class && (0..3).all(|a| corner_of(voxel[a], a))
                    });
                    let found = set[class / 64] >> (class % 64) & 1 == 1;
                    assert_eq!(found, expected, "{dims:?}, block {block:?}, class {class}");
                }
            }
        }
    }
}
