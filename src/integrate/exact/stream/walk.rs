//! Rays on their way through the lattice: from face to face where something may show, and over everything else in leaps.
//!
//! All crossings are computed from the ray's entry into the volume, in f64, and never accumulated, so that no error grows
//! along the ray; inside a cell coordinates are in `[0, 1]`, and f32 is enough.

use super::queue::Passed;
use crate::field::Chord;
use crate::integrate::exact::cells::Segment;
use crate::integrate::occupancy::Occupancy;

/// A ray inside a volume.
#[derive(Debug, Clone)]
pub(super) struct Walk {
    /// Entry as a continuous index, and voxels per mm.
    entry: [f64; 3],
    per_mm: [f64; 3],
    /// mm per voxel; infinite along an axis on which the ray does not move.
    mm_per: [f64; 3],
    entry_mm: f64,
    exit_mm: f64,
    /// How far it has come, mm from its origin.
    at_mm: f64,
    /// It stays in the same block, or among empty ones, up to here.
    until_mm: f64,
    cell: [i32; 3],
    last_cell: [i32; 3],
    /// Where it crosses the next face across each axis.
    next_mm: [f64; 3],
}

impl Walk {
    pub(super) fn new(chord: &Chord, dims: [usize; 3]) -> Self {
        let per_mm = chord.index_per_mm.to_array();
        let mut walk = Walk {
            entry: chord.entry_index.to_array(),
            per_mm,
            mm_per: per_mm.map(|d| 1.0 / d),
            entry_mm: chord.entry_mm,
            exit_mm: chord.entry_mm + chord.length_mm,
            at_mm: chord.entry_mm,
            until_mm: chord.entry_mm,
            cell: [0; 3],
            last_cell: dims.map(|n| n as i32 - 2),
            next_mm: [0.0; 3],
        };
        walk.settle();
        walk
    }

    pub(super) fn exit_mm(&self) -> f64 {
        self.exit_mm
    }

    /// The fraction of the ray that lies in front of a point.
    pub(super) fn fraction(&self, at_mm: f64) -> f64 {
        (at_mm - self.entry_mm) / (self.exit_mm - self.entry_mm)
    }

    pub(super) fn is_over(&self) -> bool {
        self.at_mm >= self.exit_mm
    }

    /// Finds the cell at `at_mm`, and its faces; on a face, the cell that the ray is about to pass.
    #[inline(always)]
    fn settle(&mut self) {
        for a in 0..3 {
            let p = self.entry[a] + (self.at_mm - self.entry_mm) * self.per_mm[a];
            let cell = if self.per_mm[a] < 0.0 { p.ceil() - 1.0 } else { p.floor() };
            self.cell[a] = (cell as i32).clamp(0, self.last_cell[a]);
            self.next_mm[a] = self.face_mm(a);
        }
    }

    /// Where it leaves its cell across an axis.
    #[inline(always)]
    fn face_mm(&self, a: usize) -> f64 {
        let (d, c) = (self.per_mm[a], self.cell[a]);
        let leaves = if d < 0.0 { c == 0 } else { c == self.last_cell[a] };
        if d == 0.0 || leaves {
            return f64::INFINITY;
        }
        let face = f64::from(if d < 0.0 { c } else { c + 1 });
        self.entry_mm + (face - self.entry[a]) * self.mm_per[a]
    }

    /// Where it leaves the box of the cells from `low` to before `high`.
    #[inline(always)]
    fn leaves_mm(&self, low: [i32; 3], high: [i32; 3]) -> f64 {
        let mut leaves = self.exit_mm;
        for a in 0..3 {
            let d = self.per_mm[a];
            if d != 0.0 {
                let face = f64::from(if d < 0.0 { low[a] } else { high[a] });
                leaves = leaves.min(self.entry_mm + (face - self.entry[a]) * self.mm_per[a]);
            }
        }
        leaves
    }

    #[inline(always)]
    fn local(&self, mm: f64) -> [f32; 3] {
        crate::math::each(
            #[inline(always)]
            |a| {
                let p = self.entry[a] + (mm - self.entry_mm) * self.per_mm[a];
                (p - f64::from(self.cell[a])).clamp(0.0, 1.0) as f32
            },
        )
    }

    /// Writes down the next cells, at most `most`, leaping over blocks in which nothing shows.
    #[inline(always)]
    pub(super) fn pass(&mut self, occupancy: &Occupancy, ray: u8, most: usize, strides: [i32; 2], passed: &mut Passed) {
        let end = passed.count + most;
        while self.at_mm < self.exit_mm && passed.count < end {
            if self.at_mm >= self.until_mm {
                let (log2_cells, is_empty) = occupancy.around(self.cell);
                let low = self.cell.map(|c| c >> log2_cells << log2_cells);
                let high = low.map(|c| c + (1 << log2_cells));
                let until_mm = self.leaves_mm(low, high);
                if is_empty && until_mm > self.at_mm {
                    self.at_mm = until_mm;
                    self.settle();
                    continue;
                }
                self.until_mm = until_mm;
            }
            let [x, y, z] = self.next_mm;
            let a = if x <= y && x <= z {
                0
            } else if y <= z {
                1
            } else {
                2
            };
            let to_mm = self.next_mm[a].min(self.exit_mm);
            if to_mm > self.at_mm {
                let at = passed.count;
                let (from, to) = (self.local(self.at_mm), self.local(to_mm));
                for b in 0..3 {
                    passed.cell[b][at] = self.cell[b];
                    passed.from[b][at] = from[b];
                    passed.to[b][at] = to[b];
                }
                passed.base[at] = self.cell[0] + strides[0] * self.cell[1] + strides[1] * self.cell[2];
                passed.length_mm[at] = (to_mm - self.at_mm) as f32;
                passed.span_mm[at] = [self.at_mm, to_mm];
                passed.ray[at] = ray;
                passed.count += 1;
                self.at_mm = to_mm;
            }
            if self.next_mm[a] < self.exit_mm {
                self.cell[a] += if self.per_mm[a] < 0.0 { -1 } else { 1 };
                self.next_mm[a] = self.face_mm(a);
            } else {
                self.at_mm = self.exit_mm;
            }
        }
    }

    /// A cell written down, in f64.
    pub(super) fn segment(&self, cell: [i32; 3], [from_mm, to_mm]: [f64; 2]) -> Segment {
        let local = |mm: f64| {
            std::array::from_fn(|a| {
                let p = self.entry[a] + (mm - self.entry_mm) * self.per_mm[a];
                (p - f64::from(cell[a])).clamp(0.0, 1.0)
            })
        };
        Segment {
            cell: cell.map(|c| c as usize),
            from: local(from_mm),
            to: local(to_mm),
            length_mm: to_mm - from_mm,
            exit_mm: to_mm,
        }
    }
}
