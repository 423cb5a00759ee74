//! A ray through the lattice: where it enters each cell and leaves it.

use glam::DVec3;

use crate::scene::Ray;
use crate::volume::{Grid, Slices};

/// A ray inside the domain, in voxel indices.
#[derive(Debug, Clone, Copy)]
pub(super) struct Path<'a> {
    dims: [usize; 3],
    /// Places of slices at uneven distances.
    slices: Option<&'a [f64]>,
    /// Index at parameter 0.
    origin: DVec3,
    /// Index steps per mm.
    step_per_mm: DVec3,
    /// Where the path begins and ends, mm.
    ends_mm: [f64; 2],
    /// Distance of parameter 0 from the ray's origin, mm.
    zero_mm: f64,
}

/// The part of a path in one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Passage {
    /// Lowest corner of the cell.
    pub(super) cell: [usize; 3],
    /// Where the path enters, from the cell's lowest corner, each in [0, 1].
    pub(super) entry: [f64; 3],
    /// Where it leaves.
    pub(super) exit: [f64; 3],
    /// Length, mm.
    pub(super) length_mm: f64,
    /// Distance of the entry from the ray's origin, mm.
    pub(super) from_mm: f64,
}

impl<'a> Path<'a> {
    /// The part of a ray between `from_mm` and `to_mm` that lies in the domain, or `None` if it is empty or a point.
    pub(super) fn new(grid: &Grid, ray: &Ray, from_mm: f64, to_mm: f64) -> Option<Self> {
        // The parameter is counted from the point next to the domain's centre, so that a far origin costs no digits.
        let center_mm = (grid.center_mm() - ray.origin_mm).dot(ray.direction);
        let corner = grid.index_to_lps_mm().translation;
        let start = DVec3::from_array(std::array::from_fn(|a| {
            multiply_add(center_mm, ray.direction[a], ray.origin_mm[a], -corner[a])
        }));
        let to_index = grid.lps_mm_to_index().matrix3;
        let path = Path {
            dims: grid.dims(),
            slices: None,
            origin: to_index * start,
            step_per_mm: to_index * ray.direction,
            ends_mm: [from_mm.max(0.0) - center_mm, to_mm - center_mm],
            zero_mm: center_mm,
        };
        path.inside(grid)
    }

    /// The part between `from_mm` and `to_mm` of the ray from a lattice point in a direction. Its index is exact, so that a
    /// ray along the border of the domain does not leave it by rounding.
    pub(super) fn from_index(grid: &Grid, origin: DVec3, direction: DVec3, [from_mm, to_mm]: [f64; 2]) -> Option<Self> {
        let path = Path {
            dims: grid.dims(),
            slices: None,
            origin,
            step_per_mm: grid.lps_mm_to_index().matrix3 * direction,
            ends_mm: [from_mm.max(0.0), to_mm],
            zero_mm: 0.0,
        };
        path.inside(grid)
    }

    /// The part inside the domain, or `None` if it is empty or a point.
    fn inside(self, grid: &Grid) -> Option<Self> {
        let Path { origin, step_per_mm, ends_mm: [mut first, mut last], .. } = self;
        let (low, high) = grid.index_bounds();
        for a in 0..3 {
            if step_per_mm[a] == 0.0 {
                // Outside a slab along which the ray runs; inside, 0/0 must not be computed.
                if !(low[a] <= origin[a] && origin[a] <= high[a]) {
                    return None;
                }
                continue;
            }
            let x = (low[a] - origin[a]) / step_per_mm[a];
            let y = (high[a] - origin[a]) / step_per_mm[a];
            first = first.max(x.min(y));
            last = last.min(x.max(y));
        }
        (first < last).then_some(Path { ends_mm: [first, last], ..self })
    }

    /// The same path through a lattice whose slices lie at these places.
    pub(super) fn through(mut self, slices: Option<&'a Slices>) -> Self {
        self.slices = slices.map(Slices::positions);
        self
    }

    /// The cells in order. Each crossing of a face is computed from the origin, never from the crossing before it.
    pub(super) fn passages(&self) -> impl Iterator<Item = Passage> + '_ {
        let mut faces: [Faces<'_>; 3] = std::array::from_fn(|a| Faces::new(self, a));
        let [mut here, end] = self.ends_mm;
        std::iter::from_fn(move || {
            while here < end {
                let next = faces.iter().fold(end, |t, f| t.min(f.next_mm));
                for face in &mut faces {
                    face.pass(next);
                }
                if next > here {
                    let passage = self.passage(here, next);
                    here = next;
                    return Some(passage);
                }
            }
            None
        })
    }

    fn passage(&self, from_mm: f64, to_mm: f64) -> Passage {
        let mut passage = Passage {
            cell: [0; 3],
            entry: [0.0; 3],
            exit: [0.0; 3],
            length_mm: to_mm - from_mm,
            from_mm: from_mm + self.zero_mm,
        };
        let middle = 0.5 * (from_mm + to_mm);
        for a in 0..3 {
            if self.dims[a] == 1 {
                continue;
            }
            // The middle decides: it is as far from the faces as the path gets. Cells are half-open, the last is closed.
            let highest = self.dims[a] - 2;
            let (cell, low, height) = match self.slices_across(a) {
                None => {
                    let cell = self.index(middle, a).floor().clamp(0.0, highest as f64);
                    (cell as usize, cell, 1.0)
                }
                Some(places) => {
                    let below = places.iter().filter(|&&place| place <= self.index(middle, a)).count();
                    let cell = below.clamp(1, highest + 1) - 1;
                    (cell, places[cell], places[cell + 1] - places[cell])
                }
            };
            passage.cell[a] = cell;
            passage.entry[a] = ((self.index(from_mm, a) - low) / height).clamp(0.0, 1.0);
            passage.exit[a] = ((self.index(to_mm, a) - low) / height).clamp(0.0, 1.0);
        }
        passage
    }

    fn slices_across(&self, axis: usize) -> Option<&'a [f64]> {
        self.slices.filter(|_| axis == 2)
    }

    fn index(&self, s_mm: f64, axis: usize) -> f64 {
        self.origin[axis] + s_mm * self.step_per_mm[axis]
    }
}

/// `t·d + o + c` with one rounding error of its own: the product and sums are exact to twice the precision.
fn multiply_add(t: f64, d: f64, o: f64, c: f64) -> f64 {
    let (product, product_error) = (t * d, t.mul_add(d, -(t * d)));
    let (first, first_error) = two_sum(o, c);
    let (sum, sum_error) = two_sum(product, first);
    sum + (sum_error + (product_error + first_error))
}

/// The rounded sum and its rounding error (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// The faces across one axis that lie ahead.
#[derive(Debug, Clone, Copy)]
struct Faces<'a> {
    slices: Option<&'a [f64]>,
    origin: f64,
    step_per_mm: f64,
    /// Number of the next face; beyond the lattice there is none.
    number: f64,
    next_mm: f64,
}

impl<'a> Faces<'a> {
    fn new(path: &Path<'a>, axis: usize) -> Self {
        let (origin, step_per_mm) = (path.origin[axis], path.step_per_mm[axis]);
        let slices = path.slices_across(axis);
        let mut faces = Faces { slices, origin, step_per_mm, number: 0.0, next_mm: f64::INFINITY };
        if path.dims[axis] > 1 && step_per_mm != 0.0 {
            // Too early, whatever the rounding; `pass` leaves behind what is not ahead.
            faces.number = match slices {
                None => path.index(path.ends_mm[0], axis).round() - 2.0 * step_per_mm.signum(),
                Some(_) if step_per_mm > 0.0 => 0.0,
                Some(places) => (places.len() - 1) as f64,
            };
            faces.next_mm = faces.crossing_mm();
            faces.pass(path.ends_mm[0]);
        }
        faces
    }

    fn crossing_mm(&self) -> f64 {
        let index = match self.slices {
            None => self.number,
            Some(places) if self.number >= 0.0 => places.get(self.number as usize).copied().unwrap_or(f64::INFINITY),
            Some(_) => f64::NEG_INFINITY,
        };
        (index - self.origin) / self.step_per_mm
    }

    /// Leaves all faces up to `s_mm` behind.
    fn pass(&mut self, s_mm: f64) {
        while self.next_mm <= s_mm {
            self.number += self.step_per_mm.signum();
            self.next_mm = self.crossing_mm();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(dims: [usize; 3], origin: [f64; 3], direction: [f64; 3]) -> Option<Path<'static>> {
        let grid = Grid::axis_aligned(dims, DVec3::ONE).unwrap();
        let ray = Ray { origin_mm: origin.into(), direction: DVec3::from_array(direction).normalize() };
        Path::new(&grid, &ray, 0.0, f64::INFINITY)
    }

    fn cells(path: &Path<'_>) -> Vec<[usize; 3]> {
        path.passages().map(|p| p.cell).collect()
    }

    #[test]
    fn passages_join_and_cover_the_path() {
        let path = path([5, 7, 4], [-3.0, 1.3, -2.2], [0.7, 0.5, 0.6]).unwrap();
        let passages: Vec<Passage> = path.passages().collect();
        let length: f64 = passages.iter().map(|p| p.length_mm).sum();
        assert!((length - (path.ends_mm[1] - path.ends_mm[0])).abs() < 1e-14, "found {length}");
        for pair in passages.windows(2) {
            for a in 0..3 {
                let (leave, enter) =
                    (pair[0].cell[a] as f64 + pair[0].exit[a], pair[1].cell[a] as f64 + pair[1].entry[a]);
                assert!((leave - enter).abs() < 1e-14, "axis {a}: left at {leave}, entered at {enter}");
            }
        }
    }

    #[test]
    fn a_diagonal_through_corners_passes_the_diagonal_cells_only() {
        let path = path([4, 4, 4], [-1.0; 3], [1.0; 3]).unwrap();
        let cells = cells(&path);
        assert!(cells.starts_with(&[[0; 3]]) && cells.ends_with(&[[2; 3]]), "found {cells:?}");
    }

    #[test]
    fn along_a_face_the_upper_cell_is_taken_and_along_the_last_face_the_last() {
        assert_eq!(cells(&path([3, 3, 3], [-1.0, 1.0, 1.0], [1.0, 0.0, 0.0]).unwrap()), [[0, 1, 1], [1, 1, 1]]);
        assert_eq!(cells(&path([3, 3, 3], [-1.0, 2.0, 0.0], [1.0, 0.0, 0.0]).unwrap()), [[0, 1, 0], [1, 1, 0]]);
        assert!(path([3, 3, 3], [-1.0, 2.0 + 1e-9, 0.0], [1.0, 0.0, 0.0]).is_none(), "beyond the last face");
    }

    #[test]
    fn axes_of_one_voxel_are_as_thick_as_their_spacing() {
        let through = path([1, 1, 1], [0.2, 0.1, -9.0], [0.0, 0.0, 1.0]).unwrap();
        let passages: Vec<Passage> = through.passages().collect();
        assert_eq!(passages.len(), 1);
        assert_eq!(passages[0].length_mm, 1.0);
        assert!(path([1, 1, 1], [0.6, 0.1, -9.0], [0.0, 0.0, 1.0]).is_none());
    }

    #[test]
    fn a_far_origin_costs_no_digits() {
        let direction = DVec3::new(0.6, 0.0, 0.8);
        let grid = Grid::axis_aligned([51, 51, 51], DVec3::ONE).unwrap();
        let target = DVec3::new(20.0, 25.0, 30.0);
        let near = Path::new(&grid, &Ray { origin_mm: target - 128.0 * direction, direction }, 0.0, 1e9).unwrap();
        // A power of two as distance, so that the far origin itself is as exact as the near one can be.
        let origin_mm = target - 1_048_576.0 * direction;
        let far = Path::new(&grid, &Ray { origin_mm, direction }, 0.0, 1e9).unwrap();
        let drift = (far.origin - near.origin).cross(near.step_per_mm).length();
        assert!(drift < 2e-10, "the rays lie {drift:e} apart; rounding of the origin alone allows 1.2e-10");
    }

    #[test]
    fn distances_are_counted_from_the_rays_origin() {
        let far = path([3, 3, 3], [-7.0, 1.2, 1.3], [1.0, 0.0, 0.0]).unwrap();
        assert_eq!(far.passages().map(|p| p.from_mm).collect::<Vec<_>>(), [7.0, 8.0]);
    }

    #[test]
    fn a_ray_from_a_border_voxel_along_the_border_stays_inside() {
        // 9.1 mm over 0.7 mm is more than 13 in floating point.
        let grid = Grid::axis_aligned([14, 14, 3], DVec3::splat(0.7)).unwrap();
        let everywhere = [0.0, f64::INFINITY];
        let along = Path::from_index(&grid, DVec3::new(13.0, 2.0, 1.0), DVec3::Y, everywhere).unwrap();
        let passages: Vec<Passage> = along.passages().collect();
        assert_eq!((passages.len(), passages[0].from_mm), (11, 0.0));
        assert!(
            Path::from_index(&grid, DVec3::new(13.0, 2.0, 1.0), DVec3::X, everywhere).is_none(),
            "outwards there is nothing"
        );
    }

    #[test]
    fn behind_and_beyond_are_empty() {
        assert!(path([3, 3, 3], [5.0, 1.0, 1.0], [1.0, 0.0, 0.0]).is_none(), "the volume is behind");
        assert!(path([3, 3, 3], [f64::NAN, 1.0, 1.0], [1.0, 0.0, 0.0]).is_none(), "no number");
        let inside = path([3, 3, 3], [1.5, 1.0, 1.0], [1.0, 0.0, 0.0]).unwrap();
        assert_eq!(inside.passages().map(|p| p.length_mm).sum::<f64>(), 0.5);
    }
}
