//! Rays inside a volume, one per seat.
//!
//! Distances are counted from where a ray enters the volume, and crossings are computed from there in f64, so that no error grows
//! along the ray.
//!
//! Every ray is made to rise: along an axis on which it falls, cells and faces are counted downwards from 0, cell `c` being
//! cell `−1 − c` of the lattice. Aligned blocks of `2^n` cells stay aligned blocks.

use super::walk::RAYS;
use crate::field::Chord;
use crate::integrate::exact::cells::Segment;
use crate::simd::{Doubles, Lanes};

/// Where a ray crosses the faces across an axis on which it does not move: beyond everything, and finite, since it is
/// multiplied by 0.
const NEVER_MM: f64 = 1e30;

/// A ray that moves less than this along an axis, voxels, is taken not to: the values along it change by less than rounding.
const STILL: f64 = 1e-7;

/// A leap that ends so little before a face, voxels, ends behind it; much more than rounding.
const NUDGE: f64 = 1e-9;

/// Rays inside a volume, one for each of `N` seats. Cells, faces and places along an axis are those of the rising ray.
#[derive(Debug)]
pub(super) struct Walks<const N: usize = RAYS> {
    /// Entry as a continuous index, a [`NUDGE`] on where it moves, and voxels per mm.
    pub(super) entry: [[f64; N]; 3],
    pub(super) per_mm: [[f64; N]; 3],
    /// mm per voxel, and where each would cross face 0 across each axis, mm; 0 and [`NEVER_MM`] where it does not move.
    pub(super) mm_per: [[f64; N]; 3],
    pub(super) face_zero_mm: [[f64; N]; 3],
    /// The coordinate in a cell of the lattice, in `[0, 1]`, where it is left through the next face.
    pub(super) leaves_at: [[f32; N]; 3],
    /// -1 where a ray falls, 0 where it rises.
    pub(super) falls: [[i32; N]; 3],
    /// Length inside the volume.
    pub(super) exit_mm: [f64; N],
    /// 1 over that, 1/mm.
    pub(super) per_length_mm: [f64; N],
    /// How far each has come.
    pub(super) at_mm: [f64; N],
    /// How far each had come a round before.
    pub(super) settled_mm: [f64; N],
    pub(super) cell: [[i32; N]; 3],
    /// Place in memory of the cell's lower corner.
    pub(super) base: [i32; N],
    pub(super) dims: [i32; 3],
}

impl<const N: usize> Walks<N> {
    /// Nobody in a lattice of `dims` voxels.
    pub(super) fn new(dims: [usize; 3]) -> Self {
        Walks {
            entry: [[0.0; N]; 3],
            per_mm: [[0.0; N]; 3],
            mm_per: [[0.0; N]; 3],
            face_zero_mm: [[0.0; N]; 3],
            leaves_at: [[0.0; N]; 3],
            falls: [[0; N]; 3],
            exit_mm: [0.0; N],
            per_length_mm: [0.0; N],
            at_mm: [0.0; N],
            settled_mm: [0.0; N],
            cell: [[0; N]; 3],
            base: [0; N],
            dims: dims.map(|n| n as i32),
        }
    }

    /// The last cell before the border along an axis.
    #[inline(always)]
    pub(super) fn last_cell(&self, a: usize) -> i32 {
        self.dims[a] - 2
    }

    /// From a cell to the next along each axis in memory.
    #[inline(always)]
    pub(super) fn strides(&self) -> [i32; 3] {
        let [nx, ny, _] = self.dims;
        [1, nx, nx * ny]
    }

    /// Seats a ray where it enters the volume.
    #[inline(always)]
    pub(super) fn enter(&mut self, seat: usize, chord: &Chord) {
        self.at_mm[seat] = 0.0;
        self.base[seat] = 0;
        let mut exit_mm = chord.length_mm;
        for (a, stride) in self.strides().into_iter().enumerate() {
            let (p, d) = (chord.entry_index[a], chord.index_per_mm[a]);
            let falls = d < 0.0;
            // On a face, the cell that the ray is about to pass; at the border, the one inside.
            let cell = if falls { p.ceil() - 1.0 } else { p.floor() };
            let cell = (cell as i32).clamp(0, self.last_cell(a));
            self.base[seat] += stride * cell;
            let (rising, last_cell) = if falls { (-1 - cell, -1) } else { (cell, self.last_cell(a)) };
            self.cell[a][seat] = rising;
            self.falls[a][seat] = -i32::from(falls);
            let p = if falls { -p } else { p };
            self.entry[a][seat] = p;
            if d.abs() * chord.length_mm < STILL {
                self.per_mm[a][seat] = 0.0;
                self.mm_per[a][seat] = 0.0;
                self.face_zero_mm[a][seat] = NEVER_MM;
                self.leaves_at[a][seat] = (p.abs() - f64::from(cell)) as f32;
            } else {
                self.per_mm[a][seat] = d.abs();
                self.mm_per[a][seat] = 1.0 / d.abs();
                self.face_zero_mm[a][seat] = -p * self.mm_per[a][seat];
                self.entry[a][seat] = p + NUDGE;
                self.leaves_at[a][seat] = if falls { 0.0 } else { 1.0 };
                // No ray steps over the border, whatever rounding does.
                exit_mm = exit_mm.min(self.crossing_mm(seat, a, last_cell + 1));
            }
        }
        self.exit_mm[seat] = exit_mm;
        self.per_length_mm[seat] = 1.0 / exit_mm;
    }

    /// Seats a ray where it is among others.
    #[inline(always)]
    pub(super) fn take<const M: usize>(&mut self, seat: usize, others: &Walks<M>, from: usize) {
        for a in 0..3 {
            self.entry[a][seat] = others.entry[a][from];
            self.per_mm[a][seat] = others.per_mm[a][from];
            self.mm_per[a][seat] = others.mm_per[a][from];
            self.face_zero_mm[a][seat] = others.face_zero_mm[a][from];
            self.leaves_at[a][seat] = others.leaves_at[a][from];
            self.falls[a][seat] = others.falls[a][from];
            self.cell[a][seat] = others.cell[a][from];
        }
        self.exit_mm[seat] = others.exit_mm[from];
        self.per_length_mm[seat] = others.per_length_mm[from];
        self.at_mm[seat] = others.at_mm[from];
        self.base[seat] = others.base[from];
    }

    /// Frees a seat.
    pub(super) fn leave(&mut self, seat: usize) {
        self.at_mm[seat] = self.exit_mm[seat];
    }

    /// Whether a ray has left the volume.
    pub(super) fn is_over(&self, seat: usize) -> bool {
        self.exit_mm[seat] <= self.at_mm[seat]
    }

    /// Which rays have left the volume, from a seat on.
    #[inline(always)]
    pub(super) fn are_over<L: Lanes>(&self, first: usize) -> L::Mask {
        L::Doubles::load(&self.exit_mm[first..]).le(L::Doubles::load(&self.at_mm[first..]))
    }

    /// Lengths inside the volume, mm.
    pub(super) fn lengths_mm(&self) -> &[f64; N] {
        &self.exit_mm
    }

    /// 1 over the lengths inside the volume, 1/mm.
    pub(super) fn per_lengths_mm(&self) -> &[f64; N] {
        &self.per_length_mm
    }

    /// 1 over the length inside the volume, 1/mm.
    pub(super) fn per_length_mm(&self, seat: usize) -> f64 {
        self.per_length_mm[seat]
    }

    /// The fraction of a ray that it had passed when its cells were last composited.
    pub(super) fn done(&self, seat: usize) -> f64 {
        self.fraction(seat, self.settled_mm[seat])
    }

    /// The fraction of a ray that lies in front of a distance from its entry.
    pub(super) fn fraction(&self, seat: usize, at_mm: f64) -> f64 {
        at_mm * self.per_length_mm[seat]
    }

    /// Where a ray crosses a face across an axis.
    #[inline(always)]
    fn crossing_mm(&self, seat: usize, a: usize, face: i32) -> f64 {
        self.face_zero_mm[a][seat] + f64::from(face) * self.mm_per[a][seat]
    }

    /// A cell of the lattice that a ray has passed, in f64; distances are those from the ray's entry.
    pub(super) fn segment(&self, seat: usize, cell: [i32; 3]) -> Segment {
        let (mut from_mm, mut to_mm) = (0.0f64, self.exit_mm[seat]);
        for a in (0..3).filter(|&a| self.per_mm[a][seat] != 0.0) {
            let rising = cell[a] ^ self.falls[a][seat];
            from_mm = from_mm.max(self.crossing_mm(seat, a, rising));
            to_mm = to_mm.min(self.crossing_mm(seat, a, rising + 1));
        }
        let local = |mm: f64| {
            std::array::from_fn(|a| {
                let falls = self.falls[a][seat];
                let left = (self.crossing_mm(seat, a, (cell[a] ^ falls) + 1) - mm) * self.per_mm[a][seat];
                let x = match (self.per_mm[a][seat] == 0.0, falls) {
                    (true, _) => self.entry[a][seat].abs() - f64::from(cell[a]),
                    (_, 0) => 1.0 - left,
                    _ => left,
                };
                x.clamp(0.0, 1.0)
            })
        };
        Segment {
            cell: cell.map(|c| c as usize),
            from: local(from_mm),
            to: local(to_mm),
            length_mm: (to_mm - from_mm).max(0.0),
            exit_mm: to_mm,
        }
    }
}
