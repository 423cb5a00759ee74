//! Cells between the steps of a round.

use super::walk::RAYS;

/// Cells that a round works off together: enough to fill registers, few enough to stay in the first-level cache.
pub(super) const CELLS: usize = 256;

/// Room for a whole register after the last cell.
pub(super) const ROOM: usize = CELLS + 16;

/// Cells in which something may show, as rays passed them: by slot, which is the seat of the ray plus the number of seats times
/// its step. What other slots have is left from earlier rounds.
#[derive(Debug)]
pub(super) struct Passed {
    /// Place in memory of the lower corner.
    pub(super) base: [i32; CELLS],
    /// Lower corner, voxel indices.
    pub(super) cell: [[i32; CELLS]; 3],
    /// Entry and exit, in `[0, 1]³` of the cell.
    pub(super) from: [[f32; CELLS]; 3],
    pub(super) to: [[f32; CELLS]; 3],
    /// Which ray, by its seat.
    pub(super) seat: [i32; CELLS],
    /// Where the ray leaves the cell, mm from where it entered the volume.
    pub(super) exit_mm: [f32; CELLS],
}

impl Passed {
    pub(super) fn new() -> Self {
        Passed {
            base: [0; CELLS],
            cell: [[0; CELLS]; 3],
            from: [[0.0; CELLS]; 3],
            to: [[0.0; CELLS]; 3],
            seat: std::array::from_fn(|slot| (slot % RAYS) as i32),
            exit_mm: [0.0; CELLS],
        }
    }
}

/// Cells in which something may show: the cubics of `F` fields along them.
#[derive(Debug)]
pub(super) struct Shown<const F: usize> {
    pub(super) count: usize,
    /// Which of the cells passed.
    pub(super) slot: [i32; ROOM],
    pub(super) fields: [[[f32; ROOM]; 4]; F],
    /// The interval of each field; used where it does not change along the cell.
    pub(super) interval: [[i32; ROOM]; F],
    /// Length, mm.
    pub(super) length_mm: [f32; ROOM],
}

impl<const F: usize> Shown<F> {
    pub(super) fn new() -> Self {
        Shown {
            count: 0,
            slot: [0; ROOM],
            fields: [[[0.0; ROOM]; 4]; F],
            interval: [[0; ROOM]; F],
            length_mm: [0.0; ROOM],
        }
    }
}

/// What the cells passed do to light, by slot.
#[derive(Debug)]
pub(super) struct Results {
    pub(super) radiance: [[f32; CELLS]; 3],
    pub(super) absorbed: [f32; CELLS],
    /// Infinite where the cell must be integrated again.
    pub(super) error: [f32; CELLS],
    /// Pieces integrated; 0 where nothing shows, and where nothing else is said.
    pub(super) pieces: [f32; CELLS],
}

impl Results {
    pub(super) fn new() -> Self {
        Results { radiance: [[0.0; CELLS]; 3], absorbed: [0.0; CELLS], error: [0.0; CELLS], pieces: [0.0; CELLS] }
    }

    /// Forgets all results.
    pub(super) fn clear(&mut self) {
        self.pieces.fill(0.0);
    }
}
