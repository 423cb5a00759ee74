//! Cells in which something may show, on their way to be looked into: registers full of them, whichever rays pass them.

use super::walk::{AHEAD, Cells};
use crate::simd::{BATCH, Ints, Lanes, Mask};

/// Room for the cells that waited, those that rays pass at a few steps, and a whole register behind the last.
const ROOM: usize = (1 + AHEAD + 1) * BATCH;

/// Cells that wait, in the order in which they were passed.
#[derive(Debug)]
pub(super) struct Candidates {
    pub(super) count: usize,
    /// Whether all of them, and all before them, have neighbours on all sides, in lit scenes.
    pub(super) are_inner: bool,
    /// Which of the cells passed.
    pub(super) slot: [i32; ROOM],
    /// Lower corner, in memory.
    pub(super) base: [i32; ROOM],
    /// Where rays enter and leave the cell, and where they cross the next faces, mm from a place near by.
    ends_mm: [[f32; ROOM]; 2],
    next_mm: [[f32; ROOM]; 3],
    /// Lower corner, voxel indices; of fields that are made of it alone.
    cell: [[i32; ROOM]; 3],
}

impl Candidates {
    pub(super) fn new() -> Self {
        Candidates {
            count: 0,
            are_inner: true,
            slot: [0; ROOM],
            base: [0; ROOM],
            ends_mm: [[0.0; ROOM]; 2],
            next_mm: [[0.0; ROOM]; 3],
            cell: [[0; ROOM]; 3],
        }
    }

    /// Begins a round.
    pub(super) fn clear(&mut self) {
        self.count = 0;
        self.are_inner = true;
    }

    /// Appends the chosen ones of a register's cells, the first lane's slot being `slot`.
    #[inline(always)]
    pub(super) fn append<L: Lanes>(
        &mut self,
        chosen: L::Mask,
        slot: usize,
        cells: &Cells<L>,
        cell: Option<[L::Ints; 3]>,
    ) {
        let at = self.count;
        let slots = L::Ints::count() + L::Ints::splat(slot as i32);
        slots.compress(chosen).store(&mut self.slot[at..]);
        cells.base.compress(chosen).store(&mut self.base[at..]);
        cells.from_mm.compress(chosen).store(&mut self.ends_mm[0][at..]);
        cells.to_mm.compress(chosen).store(&mut self.ends_mm[1][at..]);
        for a in 0..3 {
            cells.next_mm[a].compress(chosen).store(&mut self.next_mm[a][at..]);
            if let Some(cell) = cell {
                cell[a].compress(chosen).store(&mut self.cell[a][at..]);
            }
        }
        self.count += chosen.bits().count_ones() as usize;
    }

    #[inline(always)]
    pub(super) fn ends_mm<L: Lanes>(&self, first: usize) -> [L; 2] {
        [L::load(&self.ends_mm[0][first..]), L::load(&self.ends_mm[1][first..])]
    }

    #[inline(always)]
    pub(super) fn next_mm<L: Lanes>(&self, first: usize) -> [L; 3] {
        let [x, y, z] = &self.next_mm;
        [L::load(&x[first..]), L::load(&y[first..]), L::load(&z[first..])]
    }

    #[inline(always)]
    pub(super) fn cell<L: Lanes>(&self, first: usize) -> [L::Ints; 3] {
        let [x, y, z] = &self.cell;
        [L::Ints::load(&x[first..]), L::Ints::load(&y[first..]), L::Ints::load(&z[first..])]
    }

    /// Forgets the first cells; fewer than a register's are left, or none.
    #[inline(always)]
    pub(super) fn forget(&mut self, first: usize) {
        self.count = self.count.saturating_sub(first);
        if self.count == 0 {
            return;
        }
        let left = first..first + BATCH;
        for row in [&mut self.slot, &mut self.base].into_iter().chain(&mut self.cell) {
            row.copy_within(left.clone(), 0);
        }
        for row in self.ends_mm.iter_mut().chain(&mut self.next_mm) {
            row.copy_within(left.clone(), 0);
        }
    }
}
