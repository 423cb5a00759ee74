//! The cells that a ray passes, with its entry and exit in each cell's own coordinates.
//!
//! All crossings are computed from the ray's entry into the volume, in f64, and never accumulated, so that no error grows
//! along the ray; inside a cell coordinates are in `[0, 1]`, and f32 is enough.
//!
//! A face across an axis is a plane of lattice points: across k at its place in a table where slices are uneven.

use glam::DVec3;

use crate::field::Chord;
use crate::math::each;
use crate::scene::{Clip, Ray, Scene};
use crate::volume::{Grid, Slices, Volume};

/// Where rays are followed: the hull of a lattice, less what is clipped away.
#[derive(Debug, Clone, Copy)]
pub(super) struct Domain<'a> {
    grid: &'a Grid,
    clip: &'a Clip,
    /// Places of slices at uneven distances.
    slices: Option<&'a [f64]>,
}

impl<'a> Domain<'a> {
    pub(super) fn new(volume: &'a Volume, scene: &'a Scene) -> Self {
        Domain::of(volume, &scene.effects.clip)
    }

    pub(super) fn of(volume: &'a Volume, clip: &'a Clip) -> Self {
        Domain { grid: volume.grid(), clip, slices: volume.slices().map(Slices::positions) }
    }

    /// The part of a ray inside, or `None` if there is none.
    pub(super) fn inside(&self, ray: &Ray) -> Option<IndexRay> {
        let mut chord = Chord::new(self.grid, self.clip, *ray)?;
        let (low, high) = self.grid.index_bounds();
        chord.entry_index = chord.entry_index.clamp(low, high);
        Some(IndexRay { chord })
    }

    /// The part inside the hull of a ray from a lattice point, and where along it nothing is clipped away, mm.
    pub(super) fn inside_from_voxel(&self, voxel: [usize; 3], direction: DVec3) -> Option<(IndexRay, [f64; 2])> {
        let mut index = DVec3::from_array(voxel.map(|i| i as f64));
        if let Some(places) = self.slices {
            index.z = places[voxel[2]];
        }
        let ray = Ray { origin_mm: self.grid.index_to_lps_mm().transform_point3(index), direction };
        let chord = Chord::from_index(self.grid, index, direction)?;
        Some((IndexRay { chord }, self.clip.interval_mm(&ray)?))
    }

    /// The cells of a ray inside, front to back.
    pub(super) fn segments(&self, ray: IndexRay) -> Segments<'a> {
        ray.segments(self.grid.dims(), self.slices)
    }
}

/// A ray inside a volume.
#[derive(Debug, Clone, Copy)]
pub(super) struct IndexRay {
    chord: Chord,
}

/// The part of a ray inside one cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    /// Lower corner, voxel index.
    pub(super) cell: [usize; 3],
    /// Entry, in `[0, 1]³` of the cell.
    pub(super) from: [f64; 3],
    /// Exit, in `[0, 1]³` of the cell.
    pub(super) to: [f64; 3],
    /// Length, mm.
    pub(super) length_mm: f64,
    /// Distance of the exit from the ray's origin, mm.
    pub(super) exit_mm: f64,
}

impl Segment {
    /// The part between two places in `[0, 1]` of the segment.
    pub(super) fn part(&self, [begin, end]: [f64; 2]) -> Segment {
        let place = |u: f64| std::array::from_fn(|a| self.from[a] + u * (self.to[a] - self.from[a]));
        Segment {
            cell: self.cell,
            from: place(begin),
            to: place(end),
            length_mm: (end - begin) * self.length_mm,
            exit_mm: self.exit_mm - (1.0 - end) * self.length_mm,
        }
    }
}

impl IndexRay {
    /// Where it enters, mm from its origin.
    pub(super) fn enter_mm(&self) -> f64 {
        self.chord.entry_mm
    }

    /// Where it leaves.
    pub(super) fn exit_mm(&self) -> f64 {
        self.chord.entry_mm + self.chord.length_mm
    }

    /// Length inside the domain, mm.
    pub(super) fn length_mm(&self) -> f64 {
        self.chord.length_mm
    }

    /// The cells of the ray in a lattice of `dims` voxels, front to back; without gaps or overlaps, none of length 0.
    /// `slices` are the places of slices at uneven distances.
    fn segments(self, dims: [usize; 3], slices: Option<&[f64]>) -> Segments<'_> {
        let last_cell = dims.map(|n| n.saturating_sub(2));
        let mut cell = [0; 3];
        let next_mm = [f64::INFINITY; 3];
        for axis in 0..3 {
            let p = self.chord.entry_index[axis];
            // On a face, the cell that the ray is about to pass.
            let falls = self.chord.index_per_mm[axis] < 0.0;
            cell[axis] = match slices {
                Some(places) if axis == 2 => {
                    let passed = places.partition_point(|&face| if falls { face < p } else { face <= p });
                    passed.saturating_sub(1).min(last_cell[axis])
                }
                _ => (if falls { p.ceil() - 1.0 } else { p.floor() }).clamp(0.0, last_cell[axis] as f64) as usize,
            };
        }
        let (at_mm, exit_mm) = (self.enter_mm(), self.exit_mm());
        let faces = [[0.0; 2]; 3];
        let mut segments = Segments { ray: self, last_cell, dims, slices, cell, faces, next_mm, at_mm, exit_mm };
        for axis in 0..3 {
            segments.enter(axis);
        }
        segments
    }
}

/// Iterator over the [`Segment`]s of a ray.
#[derive(Debug, Clone)]
pub(super) struct Segments<'a> {
    ray: IndexRay,
    last_cell: [usize; 3],
    dims: [usize; 3],
    /// Places of slices at uneven distances.
    slices: Option<&'a [f64]>,
    cell: [usize; 3],
    /// Where the cell's lower and upper face across each axis lie, as continuous indices: known from the step before, so that
    /// even slices pay one test a cell for those that are not.
    faces: [[f64; 2]; 3],
    /// Where the ray crosses the next face across each axis, mm from its origin.
    next_mm: [f64; 3],
    at_mm: f64,
    exit_mm: f64,
}

impl Segments<'_> {
    /// Looks up the faces of a cell that the ray has come to along an axis, and where it leaves through one of them.
    #[inline(always)]
    fn enter(&mut self, axis: usize) {
        let c = self.cell[axis];
        self.faces[axis] = match self.slices {
            Some(places) if axis == 2 && c + 1 < places.len() => [places[c], places[c + 1]],
            _ => [c as f64, c as f64 + 1.0],
        };
        let d = self.ray.chord.index_per_mm[axis];
        let falls = d < 0.0;
        let leaves_domain = if falls { c == 0 } else { c >= self.last_cell[axis] };
        self.next_mm[axis] = if d == 0.0 || leaves_domain || self.dims[axis] == 1 {
            f64::INFINITY
        } else {
            let [low, high] = self.faces[axis];
            let face = if falls { low } else { high };
            self.ray.enter_mm() + (face - self.ray.chord.entry_index[axis]) / d
        };
    }

    #[inline(always)]
    fn local(&self, mm: f64) -> [f64; 3] {
        let p = self.ray.chord.index_at(mm - self.ray.enter_mm());
        let mut local: [f64; 3] = each(|axis| p[axis] - self.faces[axis][0]);
        if self.slices.is_some() {
            let [low, high] = self.faces[2];
            local[2] /= high - low;
        }
        each(|axis| local[axis].clamp(0.0, 1.0))
    }
}

impl Iterator for Segments<'_> {
    type Item = Segment;

    #[inline]
    fn next(&mut self) -> Option<Segment> {
        while self.at_mm < self.exit_mm {
            let [a, b, c] = self.next_mm;
            let axis = if a <= b && a <= c {
                0
            } else if b <= c {
                1
            } else {
                2
            };
            let exit_mm = self.next_mm[axis].min(self.exit_mm);
            let segment = (exit_mm > self.at_mm).then(|| Segment {
                cell: self.cell,
                from: self.local(self.at_mm),
                to: self.local(exit_mm),
                length_mm: exit_mm - self.at_mm,
                exit_mm,
            });
            self.at_mm = exit_mm.max(self.at_mm);
            if self.next_mm[axis] < self.exit_mm {
                if self.ray.chord.index_per_mm[axis] < 0.0 {
                    self.cell[axis] -= 1;
                } else {
                    self.cell[axis] += 1;
                }
                self.enter(axis);
            }
            if segment.is_some() {
                return segment;
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walk(origin: DVec3, direction: DVec3, dims: [usize; 3]) -> Vec<Segment> {
        let grid = Grid::axis_aligned(dims, DVec3::ONE).unwrap();
        let ray = Ray { origin_mm: origin, direction: direction.normalize() };
        let clip = Clip::default();
        let domain = Domain { grid: &grid, clip: &clip, slices: None };
        domain.inside(&ray).map(|r| domain.segments(r).collect()).unwrap_or_default()
    }

    #[test]
    fn segments_join_up_and_cover_the_ray() {
        for (o, d) in [
            (DVec3::new(-5.0, 1.3, 2.2), DVec3::new(1.0, 0.21, -0.13)),
            (DVec3::new(9.0, 9.0, 9.0), DVec3::new(-1.0, -1.0, -1.0)),
            (DVec3::new(2.0, 2.0, -4.0), DVec3::Z),
            (DVec3::new(3.0, 0.0, 9.0), DVec3::new(0.0, 1e-13, -1.0)),
        ] {
            let segments = walk(o, d, [4, 5, 6]);
            assert!(!segments.is_empty(), "{o} {d}");
            for pair in segments.windows(2) {
                let place =
                    |s: &Segment, p: [f64; 3]| DVec3::from_array(std::array::from_fn(|a| p[a] + s.cell[a] as f64));
                let gap = (place(&pair[0], pair[0].to) - place(&pair[1], pair[1].from)).length();
                assert!(gap < 1e-12, "{o} {d}: a gap of {gap:e} between {:?} and {:?}", pair[0], pair[1]);
            }
            assert!(segments.iter().all(|s| s.cell[0] < 3 && s.cell[1] < 4 && s.cell[2] < 5), "inside the lattice");
        }
    }

    #[test]
    fn a_ray_along_the_last_face_stays_in_the_last_cell() {
        let segments = walk(DVec3::new(3.0, 4.0, -1.0), DVec3::Z, [4, 5, 6]);
        assert_eq!(segments.len(), 5);
        assert!(segments.iter().all(|s| s.cell[..2] == [2, 3] && s.from[..2] == [1.0, 1.0]));
    }

    #[test]
    fn one_voxel_axes_are_as_thick_as_their_spacing() {
        let segments = walk(DVec3::new(1.5, 1.5, -9.0), DVec3::Z, [4, 4, 1]);
        assert_eq!(segments.len(), 1);
        assert!((segments[0].length_mm - 1.0).abs() < 1e-12, "{:?}", segments[0]);
        assert!(walk(DVec3::ZERO, DVec3::X, [1, 1, 1]).len() == 1);
    }

    #[test]
    fn rays_that_miss_or_look_away_have_no_segments() {
        assert!(walk(DVec3::new(5.0, 5.0, 50.0), DVec3::Z, [4, 4, 4]).is_empty(), "behind the camera");
        assert!(walk(DVec3::new(-1.0, 1.0, 0.0), DVec3::Y, [4, 4, 4]).is_empty(), "beside it");
    }
}
