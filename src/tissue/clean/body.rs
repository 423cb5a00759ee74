//! The body: what is not air around it, nor the table beneath it.

use std::ops::Range;

use super::regions;
use crate::error::{Error, Fault, Result};
use crate::tissue::Mask;
use crate::volume::{Quantity, Volume};

/// Half way from air to soft tissue, HU.
const SURFACE_HU: f64 = -500.0;

/// The largest part of what is denser than half way from air to soft tissue, with everything that it encloses in a slice:
/// lung and bowel, which in a volume are open to the air at its ends.
pub(super) fn of(volume: &Volume) -> Result<Body> {
    if volume.quantity() != Quantity::Hu {
        return Err(Error::new(Fault::Unsupported, "the body is found by HU, and the values are of unknown unit")
            .element("clean: body")
            .remedy("write volume: { values: hu } or a shift_hu, or leave the step out"));
    }
    let (samples, rescale) = (volume.samples(), volume.rescale());
    let mut body = Mask::new(volume.grid(), |index| rescale.value(samples.stored(index)) >= SURFACE_HU);
    regions::keep_largest(&mut body);
    regions::fill_holes_of_slices(&mut body);
    Ok(Body::of_mask(&body))
}

/// The voxels of the body as runs of linear indices: a body has few, so that it may be kept while tissues are cleaned.
pub(super) struct Body {
    runs: Vec<Range<usize>>,
}

impl Body {
    fn of_mask(mask: &Mask) -> Self {
        let mut runs = Vec::new();
        let mut index = 0;
        for run in mask.inside.chunk_by(|a, b| a == b) {
            if run[0] {
                runs.push(index..index + run.len());
            }
            index += run.len();
        }
        Body { runs }
    }

    /// Takes out of a mask what is not of the body.
    pub(super) fn keep(&self, mask: &mut Mask) {
        let mut outside = 0;
        for run in &self.runs {
            mask.inside[outside..run.start].fill(false);
            outside = run.end;
        }
        mask.inside[outside..].fill(false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Grid, Rescale, Samples};
    use glam::DVec3;

    #[test]
    fn lung_is_of_the_body_and_the_table_is_not() {
        let dims = [12, 10, 3];
        let grid = Grid::axis_aligned(dims, DVec3::ONE).unwrap();
        let hu = |index: usize| {
            let [i, j, _] = grid.unflatten(index);
            let within = |low: usize, high: usize| (low..=high).contains(&i) && (low..=high).contains(&j);
            match () {
                () if within(3, 4) => -900,
                () if within(1, 6) => 40,
                () if j == 8 => 0,
                () => -1000,
            }
        };
        let samples = Samples::I16((0..360).map(hu).collect());
        let volume = Volume::new(grid, samples, Rescale::IDENTITY, Quantity::Hu).unwrap();
        let mut body = Mask::new(&grid, |_| true);
        of(&volume).unwrap().keep(&mut body);
        assert_eq!(body.count(), 36 * 3, "the body is 6 x 6 in each of three slices");
        assert!(body.inside[grid.flatten([3, 3, 0])], "lung, though it reaches the first slice");
        assert!(!body.inside[grid.flatten([3, 8, 0])], "the table");
        assert!(of(&volume.with_quantity(Quantity::Arbitrary)).is_err(), "no HU, no body");
    }
}
