//! Which tissue each voxel belongs to.

use super::Grid;
use crate::error::{Error, Fault, Result};

/// Most tissues of a label map: what a voxel holds is one byte.
pub const MOST_SEGMENTS: usize = 255;

/// Voxels of a row that are passed over at once if none of them is of a tissue.
const BLOCK: usize = 64;

/// One tissue of a label map.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Its name, unique in the map.
    pub name: String,
    /// Its number in files, from 1, unique in the map.
    pub label: u16,
    /// Its colour in sRGB, each channel from 0 to 1.
    pub color_srgb: [f64; 3],
    /// Its SNOMED CT concept.
    pub concept: Option<Concept>,
}

/// A SNOMED CT concept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Concept {
    /// Identifier, digits only.
    pub code: String,
    /// What it stands for, in words.
    pub meaning: String,
}

/// A lattice of voxels, each of which belongs to one segment or to none.
///
/// A voxel holds the position of its segment in [`LabelMap::segments`], counted from 1, and 0 for none. What number a
/// file gives it ([`Segment::label`]) is another matter, so that 255 segments of any numbers fit into a byte per voxel.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelMap {
    grid: Grid,
    segments: Vec<Segment>,
    voxels: Vec<u8>,
}

impl LabelMap {
    /// A map of `voxels` (x fastest) on `grid`.
    ///
    /// # Errors
    /// `Fault::Input` for a number of voxels that is not that of the grid, a voxel of no segment, more than 255
    /// segments, or two of one name or label, or a label of 0.
    pub fn new(grid: Grid, segments: Vec<Segment>, voxels: Vec<u8>) -> Result<Self> {
        let wrong = |what: &str, found: String| Err(Error::new(Fault::Input, what.to_owned()).found(found));
        if voxels.len() != grid.voxel_count() {
            return wrong("the number of labels does not match the grid", format!("{} labels", voxels.len()));
        }
        if segments.len() > MOST_SEGMENTS {
            return wrong("a label map has at most 255 tissues", format!("{} tissues", segments.len()));
        }
        for (n, segment) in segments.iter().enumerate() {
            let same = |other: &&Segment| other.name == segment.name || other.label == segment.label;
            if let Some(other) = segments[..n].iter().find(same) {
                let found = format!("{} ({}) and {} ({})", other.name, other.label, segment.name, segment.label);
                return wrong("two tissues have the same name or label", found);
            }
            if segment.label == 0 {
                return wrong("a tissue has the label 0, which means none", segment.name.clone());
            }
        }
        match voxels.iter().find(|&&v| usize::from(v) > segments.len()) {
            Some(v) => wrong("a voxel belongs to a tissue that there is not", format!("tissue {v}")),
            None => Ok(LabelMap { grid, segments, voxels }),
        }
    }

    /// Lattice, tissues and voxels.
    pub fn into_parts(self) -> (Grid, Vec<Segment>, Vec<u8>) {
        (self.grid, self.segments, self.voxels)
    }

    /// Lattice and affine.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The tissues.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// For each voxel, x fastest, the position of its segment counted from 1, or 0.
    pub fn voxels(&self) -> &[u8] {
        &self.voxels
    }

    /// The number that files give a voxel of this content.
    pub fn label_of(&self, voxel: u8) -> u16 {
        match voxel {
            0 => 0,
            n => self.segments[usize::from(n) - 1].label,
        }
    }

    /// Position of the segment of this name, counted from 1.
    pub fn position_of(&self, name: &str) -> Option<u8> {
        let position = self.segments.iter().position(|segment| segment.name == name)?;
        u8::try_from(position + 1).ok()
    }

    /// Lowest and highest voxel index along i, j and k of the voxels of each segment, `None` for one without voxels.
    pub fn bounds(&self) -> Vec<Option<[[usize; 2]; 3]>> {
        let [nx, ny, _] = self.grid.dims();
        let mut bounds: Vec<Option<[[usize; 2]; 3]>> = vec![None; self.segments.len()];
        for (row, line) in self.voxels.chunks(nx).enumerate() {
            let (j, k) = (row % ny, row / ny);
            let blocks = line.chunks(BLOCK).enumerate().filter(|(_, block)| **block != [0; BLOCK][..block.len()]);
            let voxels = blocks.flat_map(|(n, block)| block.iter().enumerate().map(move |(i, v)| (n * BLOCK + i, *v)));
            for (i, voxel) in voxels.filter(|(_, voxel)| *voxel != 0) {
                let bound = bounds[usize::from(voxel) - 1].get_or_insert([[i, i], [j, j], [k, k]]);
                for (range, at) in bound.iter_mut().zip([i, j, k]) {
                    *range = [range[0].min(at), range[1].max(at)];
                }
            }
        }
        bounds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn segment(name: &str, label: u16) -> Segment {
        Segment { name: name.to_owned(), label, color_srgb: [1.0; 3], concept: None }
    }

    fn grid() -> Grid {
        Grid::axis_aligned([3, 2, 1], DVec3::ONE).unwrap()
    }

    #[test]
    fn bounds_hold_the_voxels_and_nothing_more() {
        let segments = vec![segment("a", 7), segment("b", 300)];
        let map = LabelMap::new(grid(), segments, vec![0, 0, 1, 0, 1, 1]).unwrap();
        assert_eq!(map.bounds(), [Some([[1, 2], [0, 1], [0, 0]]), None]);
        assert_eq!((map.label_of(2), map.label_of(0), map.position_of("b")), (300, 0, Some(2)));
    }

    #[test]
    fn what_contradicts_itself_is_refused() {
        let map = |segments, voxels| LabelMap::new(grid(), segments, voxels);
        assert!(map(vec![segment("a", 1)], vec![0; 5]).is_err(), "five labels for six voxels");
        assert!(map(vec![segment("a", 1)], vec![2; 6]).is_err(), "a second tissue that there is not");
        assert!(map(vec![segment("a", 0)], vec![0; 6]).is_err(), "label 0");
        assert!(map(vec![segment("a", 1), segment("b", 1)], vec![0; 6]).is_err(), "one label twice");
        assert!(map(vec![segment("a", 1), segment("a", 2)], vec![0; 6]).is_err(), "one name twice");
        assert!(map(vec![segment("a", 1), segment("b", 2)], vec![2; 6]).is_ok(), "nothing wrong with this");
    }
}
