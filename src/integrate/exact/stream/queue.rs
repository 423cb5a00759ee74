//! Cells between the steps of a round.

/// Cells that a round works off together: enough to fill registers, few enough to stay in the first-level cache.
pub(super) const CELLS: usize = 256;

/// Room for a whole register after the last cell.
pub(super) const ROOM: usize = CELLS + 16;

/// Cells that rays have written down, in the order in which each ray passes them.
#[derive(Debug)]
pub(super) struct Passed {
    pub(super) count: usize,
    /// Place in memory of the lower corner.
    pub(super) base: [i32; ROOM],
    /// Lower corner, voxel indices.
    pub(super) cell: [[i32; ROOM]; 3],
    /// Entry and exit, in `[0, 1]³` of the cell.
    pub(super) from: [[f32; ROOM]; 3],
    pub(super) to: [[f32; ROOM]; 3],
    /// Length, mm.
    pub(super) length_mm: [f32; ROOM],
    /// Which ray, by its seat.
    pub(super) seat: [i32; ROOM],
    /// Where the ray leaves the cell, mm from where it entered the volume.
    pub(super) exit_mm: [f32; ROOM],
}

impl Passed {
    pub(super) fn new() -> Self {
        Passed {
            count: 0,
            base: [0; ROOM],
            cell: [[0; ROOM]; 3],
            from: [[0.0; ROOM]; 3],
            to: [[0.0; ROOM]; 3],
            length_mm: [0.0; ROOM],
            seat: [0; ROOM],
            exit_mm: [0.0; ROOM],
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

/// What the cells passed do to light; nothing in those that were not shown.
#[derive(Debug)]
pub(super) struct Results {
    pub(super) radiance: [[f32; CELLS]; 3],
    pub(super) absorbed: [f32; CELLS],
    /// Infinite where the cell must be integrated again.
    pub(super) error: [f32; CELLS],
    /// Pieces integrated.
    pub(super) pieces: [f32; CELLS],
    /// Bit by bit, whether a cell has a result: something may show in it.
    pub(super) shown: [u64; CELLS / 64],
}

impl Results {
    pub(super) fn new() -> Self {
        Results {
            radiance: [[0.0; CELLS]; 3],
            absorbed: [0.0; CELLS],
            error: [0.0; CELLS],
            pieces: [0.0; CELLS],
            shown: [0; CELLS / 64],
        }
    }

    /// Forgets all results.
    pub(super) fn clear(&mut self) {
        self.shown.fill(0);
    }

    /// The cells that have results, in order.
    #[inline(always)]
    pub(super) fn slots(&self) -> impl Iterator<Item = usize> {
        self.shown.iter().enumerate().flat_map(|(word, &bits)| {
            std::iter::successors((bits != 0).then_some(bits), |&rest| {
                Some(rest & (rest - 1)).filter(|&rest| rest != 0)
            })
            .map(move |rest| 64 * word + rest.trailing_zeros() as usize)
        })
    }
}
