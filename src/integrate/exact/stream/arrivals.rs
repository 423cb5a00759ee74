//! Rays before they take a seat: on their way to where something may show.
//!
//! Most leaps are made before a ray first comes to anything, and many rays never do. Made side by side by rays that all have to, they
//! hold up nobody who has cells to pass.

use super::seats::Walks;
use crate::field::Chords;
use crate::integrate::occupancy::Occupancy;
use crate::scene::Rays;
use crate::simd::{BATCH, Lanes};
use crate::volume::Grid;

/// Rays of a tile, a few of which have come to where something may show, or through the volume without.
pub(super) struct Arrivals<'r> {
    grid: &'r Grid,
    chords: &'r Chords,
    /// Numbers of the rays that have not set out.
    waiting: std::ops::Range<usize>,
    pub(super) walks: Walks<BATCH>,
    numbers: [usize; BATCH],
    count: usize,
    next: usize,
}

impl<'r> Arrivals<'r> {
    pub(super) fn new(grid: &'r Grid, chords: &'r Chords, rays: &Rays) -> Self {
        let walks = Walks::new(grid.dims());
        Arrivals { grid, chords, waiting: 0..rays.len(), walks, numbers: [0; BATCH], count: 0, next: 0 }
    }

    /// The next ray that meets the volume: its number, and its place in `walks`.
    #[inline(always)]
    pub(super) fn next<L: Lanes>(&mut self, occupancy: &Occupancy) -> Option<(usize, usize)> {
        if self.next == self.count {
            self.set_out::<L>(occupancy);
        }
        let place = self.next;
        (place < self.count).then(|| {
            self.next += 1;
            (self.numbers[place], place)
        })
    }

    #[inline(always)]
    fn set_out<L: Lanes>(&mut self, occupancy: &Occupancy) {
        (self.next, self.count) = (0, 0);
        let (low, high) = self.grid.index_bounds();
        while self.count < BATCH {
            let Some(number) = self.waiting.next() else { break };
            if let Some(mut chord) = self.chords.get(number) {
                chord.entry_index = chord.entry_index.clamp(low, high);
                self.walks.enter(self.count, &chord);
                self.numbers[self.count] = number;
                self.count += 1;
            }
        }
        if self.count > 0 {
            self.walks.leap::<L>(occupancy);
        }
    }
}
