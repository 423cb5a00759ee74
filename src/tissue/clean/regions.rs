//! Steps by connected parts.

use crate::tissue::Mask;
use crate::tissue::parts::{Joined, Part, Parts};

/// Keeps the part with the most voxels; of equals, the one whose first voxel comes first.
pub(super) fn keep_largest(mask: &mut Mask) {
    let parts = parts(mask);
    let Some(most) = parts.parts().iter().map(|part| part.voxels).max() else { return };
    let kept = parts.parts().iter().position(|part| part.voxels == most);
    keep(mask, &parts, |n, _| Some(n) == kept);
}

/// Keeps parts of at least so many voxels.
pub(super) fn keep_of_at_least(mask: &mut Mask, voxels: f64) {
    let parts = parts(mask);
    // A volume in ml is rarely a whole number of voxels; where it is one, rounding must not decide.
    keep(mask, &parts, |_, part| part.voxels as f64 >= voxels * (1.0 - 1e-9));
}

/// Takes in each part of the outside that does not reach the border of the volume.
pub(super) fn fill_holes(mask: &mut Mask) {
    fill(mask, Joined::InVolume);
}

/// Takes in each part of a slice's outside that does not reach the border of the slice.
pub(super) fn fill_holes_of_slices(mask: &mut Mask) {
    fill(mask, Joined::InSlices);
}

fn fill(mask: &mut Mask, joined: Joined) {
    let holes = Parts::new(mask.dims, joined, |index| u8::from(!mask.inside[index]));
    holes.for_each_run(|run, part| {
        if !holes.parts()[part].on_border {
            mask.inside[run].fill(true);
        }
    });
}

fn parts(mask: &Mask) -> Parts {
    Parts::new(mask.dims, Joined::InVolume, |index| u8::from(mask.inside[index]))
}

fn keep(mask: &mut Mask, parts: &Parts, keeps: impl Fn(usize, &Part) -> bool) {
    parts.for_each_run(|run, part| {
        if !keeps(part, &parts.parts()[part]) {
            mask.inside[run].fill(false);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mask of one slice, `#` inside.
    fn mask(rows: &[&str]) -> Mask {
        let inside = rows.iter().flat_map(|row| row.bytes().map(|b| b == b'#')).collect();
        Mask { dims: [rows[0].len(), rows.len(), 1], inside }
    }

    fn text(mask: &Mask) -> Vec<String> {
        let row = |row: &[bool]| row.iter().map(|inside| if *inside { '#' } else { '.' }).collect();
        mask.inside.chunks(mask.dims[0]).map(row).collect()
    }

    #[test]
    fn small_parts_go_and_the_largest_stays() {
        let start = mask(&["##..#", "##..#", "....#", "#...."]);
        let mut two = start.clone();
        keep_of_at_least(&mut two, 3.0);
        assert_eq!(text(&two), ["##..#", "##..#", "....#", "....."]);
        let mut one = start.clone();
        keep_largest(&mut one);
        assert_eq!(text(&one), ["##...", "##...", ".....", "....."]);
        let mut none = start;
        keep_of_at_least(&mut none, 5.0);
        assert_eq!(none.count(), 0, "no part has five voxels");
    }

    #[test]
    fn a_hole_is_closed_on_all_sides() {
        let mut slice = mask(&["#####", "#...#", "###.#", "##.##", "#####"]);
        fill_holes_of_slices(&mut slice);
        assert_eq!(slice.count(), 25, "holes of {:?}", text(&slice));
        let mut open = mask(&["##.##", "#..##", "#####"]);
        let before = open.clone();
        fill_holes_of_slices(&mut open);
        assert_eq!(open, before, "open to the border");
        let mut ring = mask(&["###", "#.#", "###"]);
        fill_holes(&mut ring);
        assert_eq!(ring.count(), 8, "in a volume of one slice everything reaches the border along k");
    }
}
