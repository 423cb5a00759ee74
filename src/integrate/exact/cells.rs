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
        let (entry, per_mm) = (self.chord.entry_index.to_array(), self.chord.index_per_mm.to_array());
        let last_cell = dims.map(|n| n.saturating_sub(2));
        let falls = per_mm.map(|d| d < 0.0);
        // On a face, the cell that the ray is about to pass.
        let cell = each(|axis| {
            let p = entry[axis];
            match slices {
                Some(places) if axis == 2 => {
                    let passed = places.partition_point(|&face| if falls[axis] { face < p } else { face <= p });
                    passed.saturating_sub(1).min(last_cell[axis])
                }
                _ => (if falls[axis] { p.ceil() - 1.0 } else { p.floor() }).clamp(0.0, last_cell[axis] as f64) as usize,
            }
        });
        let mut segments = Segments {
            entry,
            per_mm,
            enter_mm: self.enter_mm(),
            slices,
            cell,
            low: each(|axis| match slices {
                Some(places) if axis == 2 => places[cell[axis]],
                _ => cell[axis] as f64,
            }),
            step: falls.map(|falls| if falls { -1 } else { 1 }),
            ahead: falls.map(|falls| if falls { 0.0 } else { 1.0 }),
            last: each(|axis| if falls[axis] { 0 } else { last_cell[axis] }),
            next_mm: [f64::INFINITY; 3],
            at_mm: self.enter_mm(),
            exit_mm: self.exit_mm(),
        };
        for axis in (0..3).filter(|&axis| per_mm[axis] != 0.0 && dims[axis] > 1) {
            segments.enter(axis, cell[axis]);
        }
        segments
    }
}

/// Iterator over the [`Segment`]s of a ray. What stays the same along the ray, or follows from the cell before, is not
/// computed anew for each cell: a ray passes hundreds, and in most of them nothing is seen.
#[derive(Debug, Clone)]
pub(super) struct Segments<'a> {
    /// Where the ray enters the domain, as a continuous index.
    entry: [f64; 3],
    /// Its direction, voxels per mm.
    per_mm: [f64; 3],
    /// Where it enters, mm from its origin.
    enter_mm: f64,
    /// Places of slices at uneven distances.
    slices: Option<&'a [f64]>,
    cell: [usize; 3],
    /// Where the cell's lower corner lies, as a continuous index.
    low: [f64; 3],
    /// From a cell to the next along each axis: 1, or -1.
    step: [isize; 3],
    /// From a cell's number along each axis to that of the face that the ray leaves it through: 1, or 0.
    ahead: [f64; 3],
    /// The last cell that the ray comes to along each axis.
    last: [usize; 3],
    /// Where the ray crosses the next face across each axis, mm from its origin.
    next_mm: [f64; 3],
    at_mm: f64,
    exit_mm: f64,
}

impl Segments<'_> {
    /// Comes to a cell along an axis that the ray moves on: where its lower face lies, and where the ray leaves it.
    #[inline(always)]
    fn enter(&mut self, axis: usize, cell: usize) {
        self.cell[axis] = cell;
        // Signed numbers become floating-point ones in one instruction, unsigned ones in five.
        let mut low = cell as i64 as f64;
        let mut face = low + self.ahead[axis];
        if let (2, Some(places)) = (axis, self.slices) {
            low = places[cell];
            face = places[cell + self.ahead[2] as usize];
        }
        self.low[axis] = low;
        self.next_mm[axis] = if cell == self.last[axis] {
            f64::INFINITY
        } else {
            self.enter_mm + (face - self.entry[axis]) / self.per_mm[axis]
        };
    }

    /// The part inside the cell, up to a distance from the ray's origin.
    #[inline(always)]
    fn up_to(&self, exit_mm: f64) -> Segment {
        let inside = |mm: f64| {
            let mm = mm - self.enter_mm;
            each(|axis| self.entry[axis] + mm * self.per_mm[axis] - self.low[axis])
        };
        let (mut from, mut to): ([f64; 3], [f64; 3]) = (inside(self.at_mm), inside(exit_mm));
        if let Some(places) = self.slices {
            let height = places[self.cell[2] + 1] - self.low[2];
            from[2] /= height;
            to[2] /= height;
        }
        // Rounding may leave a trace outside.
        let clamped = |local: [f64; 3]| each(|axis| local[axis].clamp(0.0, 1.0));
        let (from, to) = (clamped(from), clamped(to));
        Segment { cell: self.cell, from, to, length_mm: exit_mm - self.at_mm, exit_mm }
    }
}

impl Iterator for Segments<'_> {
    type Item = Segment;

    #[inline(always)]
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
            let crosses = self.next_mm[axis] < self.exit_mm;
            let exit_mm = if crosses { self.next_mm[axis] } else { self.exit_mm };
            let segment = (exit_mm > self.at_mm).then(|| self.up_to(exit_mm));
            if crosses {
                self.enter(axis, self.cell[axis].wrapping_add_signed(self.step[axis]));
            }
            if segment.is_some() {
                self.at_mm = exit_mm;
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
