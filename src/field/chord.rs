//! Where a ray is inside the volume.

use glam::DVec3;

use crate::scene::{Clip, Ray};
use crate::volume::Grid;

/// The part of a ray inside the domain, clipped, in f64 and from its own entry, so that the distance of the camera costs no
/// precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chord {
    /// Entry, as a distance along the ray, mm.
    pub entry_mm: f64,
    /// Length inside the domain, mm; above 0.
    pub length_mm: f64,
    /// Entry, as a continuous voxel index.
    pub entry_index: DVec3,
    /// Direction, voxels per mm.
    pub index_per_mm: DVec3,
}

impl Chord {
    /// The part of `ray` inside the domain, not clipped away and in front of its origin; `None` if it has no length.
    ///
    /// Slabs (Kay and Kajiya 1986) in index space, where the domain is a box whatever the shear. An axis the ray does not
    /// move on is a test of its own, so that 0 · ∞ cannot arise.
    #[inline(always)]
    pub fn new(grid: &Grid, clip: &Clip, ray: Ray) -> Option<Self> {
        let to_index = grid.lps_mm_to_index();
        let origin = to_index.transform_point3(ray.origin_mm);
        let direction = to_index.transform_vector3(ray.direction);
        let (low, high) = grid.index_bounds();
        // What is clipped is a slab too; nothing clipped is all that is ahead.
        let [mut entry_mm, mut exit_mm] = clip.interval_mm(&ray)?;
        for a in 0..3 {
            if direction[a] == 0.0 {
                if origin[a] < low[a] || origin[a] > high[a] {
                    return None;
                }
                continue;
            }
            let (s, t) = ((low[a] - origin[a]) / direction[a], (high[a] - origin[a]) / direction[a]);
            entry_mm = entry_mm.max(s.min(t));
            exit_mm = exit_mm.min(s.max(t));
        }
        let length_mm = exit_mm - entry_mm;
        (length_mm > 0.0 && length_mm.is_finite()).then(|| Chord {
            entry_mm,
            length_mm,
            entry_index: origin + entry_mm * direction,
            index_per_mm: direction,
        })
    }

    /// The part inside the domain of a ray from a continuous index; `None` if it has no length. The entry is exact, so that a
    /// ray along the border does not leave it by rounding.
    pub fn from_index(grid: &Grid, entry_index: DVec3, direction: DVec3) -> Option<Self> {
        let index_per_mm = grid.lps_mm_to_index().transform_vector3(direction);
        let (low, high) = grid.index_bounds();
        let mut length_mm = f64::INFINITY;
        for a in (0..3).filter(|&a| index_per_mm[a] != 0.0) {
            let face = if index_per_mm[a] < 0.0 { low[a] } else { high[a] };
            length_mm = length_mm.min((face - entry_index[a]) / index_per_mm[a]);
        }
        (length_mm > 0.0 && length_mm.is_finite()).then_some(Chord {
            entry_mm: 0.0,
            length_mm,
            entry_index,
            index_per_mm,
        })
    }

    /// What is left of it from a distance along the ray on, mm; `None` if that is nothing.
    pub fn beyond_mm(self, from_mm: f64) -> Option<Self> {
        let skipped_mm = (from_mm - self.entry_mm).max(0.0);
        (skipped_mm < self.length_mm).then(|| Chord {
            entry_mm: self.entry_mm + skipped_mm,
            length_mm: self.length_mm - skipped_mm,
            entry_index: self.index_at(skipped_mm),
            ..self
        })
    }

    /// Continuous voxel index at a distance from the entry.
    #[inline(always)]
    pub fn index_at(&self, mm: f64) -> DVec3 {
        self.entry_index + mm * self.index_per_mm
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::HalfSpace;

    fn grid() -> Grid {
        Grid::axis_aligned([11, 21, 31], DVec3::new(1.0, 0.5, 2.0)).unwrap()
    }

    fn chord(origin_mm: DVec3, direction: DVec3) -> Option<Chord> {
        Chord::new(&grid(), &Clip::default(), Ray { origin_mm, direction: direction.normalize() })
    }

    #[test]
    fn along_an_axis() {
        let c = chord(DVec3::new(5.0, 5.0, -7.0), DVec3::Z).unwrap();
        assert_eq!((c.entry_mm, c.length_mm), (7.0, 60.0));
        assert_eq!(c.entry_index, DVec3::new(5.0, 10.0, 0.0));
        let back = chord(DVec3::new(5.0, 5.0, 67.0), -DVec3::Z).unwrap();
        assert_eq!((back.entry_mm, back.length_mm), (7.0, 60.0));
    }

    #[test]
    fn from_inside_it_begins_at_the_origin() {
        let c = chord(DVec3::new(5.0, 5.0, 20.0), DVec3::Z).unwrap();
        assert_eq!((c.entry_mm, c.length_mm), (0.0, 40.0));
    }

    #[test]
    fn behind_beside_and_touching_are_missed() {
        assert_eq!(chord(DVec3::new(5.0, 5.0, 61.0), DVec3::Z), None, "behind");
        assert_eq!(chord(DVec3::new(10.1, 5.0, -1.0), DVec3::Z), None, "beside, parallel to a face");
        assert_eq!(chord(DVec3::new(-1.0, -1.0, 5.0), DVec3::new(1.0, -1.0, 0.0)), None, "away");
        assert_eq!(chord(DVec3::new(-1.0, 1.0, 5.0), DVec3::new(1.0, -1.0, 0.0)), None, "a point of an edge");
    }

    #[test]
    fn on_a_face_and_nearly_parallel_are_met() {
        assert!(chord(DVec3::new(10.0, 5.0, -1.0), DVec3::Z).is_some(), "on the upper face");
        assert!(chord(DVec3::new(0.0, 0.0, -1.0), DVec3::Z).is_some(), "on an edge");
        for tiny in [1e-12, 1e-30, 1e-300, -1e-300] {
            let c = chord(DVec3::new(5.0, 5.0, -1.0), DVec3::new(tiny, tiny, 1.0)).unwrap();
            assert!((c.length_mm - 60.0).abs() < 1e-9, "{tiny:e}: length {}", c.length_mm);
        }
    }

    #[test]
    fn a_far_camera_costs_nothing() {
        let near = chord(DVec3::new(5.0, 5.0, 30.0) - 100.0 * DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.6, 0.0, 0.8));
        let far = chord(DVec3::new(5.0, 5.0, 30.0) - 1e6 * DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.6, 0.0, 0.8));
        let (near, far) = (near.unwrap(), far.unwrap());
        assert!((near.length_mm - far.length_mm).abs() < 1e-8, "{} and {}", near.length_mm, far.length_mm);
        assert!((near.entry_index - far.entry_index).length() < 1e-8, "{} and {}", near.entry_index, far.entry_index);
    }

    #[test]
    fn from_a_border_voxel_along_the_border_it_stays_inside() {
        // 9.1 mm over 0.7 mm is more than 13 in floating point.
        let grid = Grid::axis_aligned([14, 14, 1], DVec3::splat(0.7)).unwrap();
        let length = |direction| Chord::from_index(&grid, DVec3::new(13.0, 2.0, 0.0), direction).map(|c| c.length_mm);
        assert!(length(DVec3::Y).is_some_and(|l| (l - 7.7).abs() < 1e-12), "found {:?}", length(DVec3::Y));
        assert!(length(DVec3::Z).is_some_and(|l| (l - 0.35).abs() < 1e-12), "half of one voxel");
        assert_eq!(length(DVec3::X), None, "outwards there is nothing");
    }

    #[test]
    fn an_axis_of_one_voxel_is_as_thick_as_its_spacing() {
        let flat = Grid::axis_aligned([4, 4, 1], DVec3::new(1.0, 1.0, 5.0)).unwrap();
        let ray = Ray { origin_mm: DVec3::new(1.0, 1.0, -50.0), direction: DVec3::Z };
        assert!((Chord::new(&flat, &Clip::default(), ray).unwrap().length_mm - 5.0).abs() < 1e-12);
    }

    #[test]
    fn clipping_moves_the_ends_and_nothing_else() {
        let clip = |normal: DVec3, offset_mm| Clip { half_spaces: vec![HalfSpace { normal, offset_mm }] };
        let ray = Ray { origin_mm: DVec3::new(5.0, 5.0, -7.0), direction: DVec3::Z };
        let cut = |clip: &Clip| Chord::new(&grid(), clip, ray);
        let whole = cut(&Clip::default());
        let front = cut(&clip(DVec3::Z, 12.0)).unwrap();
        assert_eq!((front.entry_mm, front.length_mm, front.entry_index.z), (19.0, 48.0, 6.0));
        let back = cut(&clip(-DVec3::Z, -12.0)).unwrap();
        assert_eq!((back.entry_mm, back.length_mm, back.entry_index.z), (7.0, 12.0, 0.0));
        assert_eq!(cut(&clip(DVec3::Z, 61.0)), None, "all of it");
        assert_eq!(cut(&clip(DVec3::X, 6.0)), None, "beside the ray");
        assert_eq!(cut(&clip(DVec3::new(1.0, 0.0, 1.0), -9.0)), whole, "to the bit where nothing is cut off");
    }

    #[test]
    fn a_far_camera_costs_nothing_behind_a_clip_either() {
        let direction = DVec3::new(0.6, 0.0, 0.8);
        let clip = Clip { half_spaces: vec![HalfSpace { normal: DVec3::new(0.2, 0.1, 1.0), offset_mm: 21.0 }] };
        let from = |mm: f64| Ray { origin_mm: DVec3::new(5.0, 5.0, 30.0) - mm * direction, direction };
        let [near, far] = [100.0, 1e6].map(|mm| Chord::new(&grid(), &clip, from(mm)).unwrap());
        assert!((near.length_mm - far.length_mm).abs() < 1e-8, "{} and {}", near.length_mm, far.length_mm);
        assert!((near.entry_index - far.entry_index).length() < 1e-8, "{} and {}", near.entry_index, far.entry_index);
    }
}
