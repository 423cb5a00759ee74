//! The part of space that is shown: an intersection of half-spaces.

use glam::DVec3;

use crate::scene::Ray;

/// The points `x` with `normal · x ≥ offset_mm`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace {
    /// Towards the side that is shown, LPS; of any length but 0.
    pub normal: DVec3,
    /// In units of the normal's length times mm.
    pub offset_mm: f64,
}

/// An intersection of half-spaces; of none, all of space.
///
/// **Definition.** What is outside neither absorbs nor emits and casts no shadow; a face made by clipping has no
/// gradient of its own, and shading there is that of the uncut field. A level surface has no crossing there either: it is
/// open where it is cut.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Clip {
    /// Points in all of these are shown.
    pub half_spaces: Vec<HalfSpace>,
}

impl Clip {
    /// True if a point is shown.
    pub fn contains(&self, point_mm: DVec3) -> bool {
        self.half_spaces.iter().all(|h| h.normal.dot(point_mm) >= h.offset_mm)
    }

    /// The part of a ray that is shown, as distances from its origin, mm: `[from, to]` with `from ≥ 0` and `to` perhaps
    /// infinite; `None` if there is none.
    pub fn interval_mm(&self, ray: &Ray) -> Option<[f64; 2]> {
        let [mut from, mut to] = [0.0_f64, f64::INFINITY];
        for HalfSpace { normal, offset_mm } in &self.half_spaces {
            let (speed, ahead) = (normal.dot(ray.direction), offset_mm - normal.dot(ray.origin_mm));
            if speed > 0.0 {
                from = from.max(ahead / speed);
            } else if speed < 0.0 {
                to = to.min(ahead / speed);
            } else if ahead > 0.0 {
                return None;
            }
        }
        (from < to).then_some([from, to])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slab_leaves_the_part_of_a_ray_between_its_faces() {
        let between = |low: f64, high: f64| Clip {
            half_spaces: vec![
                HalfSpace { normal: DVec3::X, offset_mm: low },
                HalfSpace { normal: -2.0 * DVec3::X, offset_mm: -2.0 * high },
            ],
        };
        let ray = Ray { origin_mm: DVec3::new(-1.0, 5.0, 5.0), direction: DVec3::new(0.6, 0.8, 0.0) };
        let [from, to] = between(2.0, 5.0).interval_mm(&ray).expect("the ray passes the slab");
        assert!((from - 5.0).abs() < 1e-12 && (to - 10.0).abs() < 1e-12, "found {from} to {to}, expected 5 to 10");
        let along = Ray { direction: DVec3::Y, ..ray };
        assert_eq!(between(2.0, 5.0).interval_mm(&along), None, "beside the slab");
        assert_eq!(between(-2.0, 5.0).interval_mm(&along), Some([0.0, f64::INFINITY]), "within it");
        assert_eq!(between(5.0, 2.0).interval_mm(&ray), None, "an empty slab");
        assert_eq!(Clip::default().interval_mm(&ray), Some([0.0, f64::INFINITY]), "nothing is cut off");
    }
}
