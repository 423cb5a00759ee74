//! Cells between the steps of a round.

use super::walk::RAYS;
use crate::integrate::exact::piece::Integral;
use crate::math::bernstein::Cubic;
use crate::simd::{BATCH, Ints, Lanes, Mask};

/// Cells that a round works off together: enough to fill registers, few enough that little is looked at behind opaque ones.
pub(super) const CELLS: usize = 512;

/// Room for a whole register after the last cell.
pub(super) const ROOM: usize = CELLS + 16;

/// Cells in which something may show, as rays passed them: by slot, which is the seat of the ray plus the number of seats times
/// its step. What other slots have is left from earlier rounds.
#[derive(Debug)]
pub(super) struct Passed {
    /// Lower corner, in memory.
    pub(super) base: [i32; CELLS],
    /// Where the ray leaves the cell, mm from where it entered the volume.
    pub(super) exit_mm: [f32; CELLS],
}

impl Passed {
    pub(super) fn new() -> Self {
        Passed { base: [0; CELLS], exit_mm: [0.0; CELLS] }
    }
}

/// Cells in which something may show: the cubics of `F` fields along them.
#[derive(Debug)]
pub(super) struct Shown<const F: usize> {
    pub(super) count: usize,
    /// Which of the cells passed.
    pub(super) slot: [i32; ROOM],
    pub(super) fields: [[[f32; ROOM]; 4]; F],
    /// The interval of each field's lower end, where the cell's pieces are known.
    pub(super) interval: [[i32; ROOM]; F],
    /// Length, mm.
    pub(super) length_mm: [f32; ROOM],
    /// Where the cells are, in lit scenes.
    pub(super) way: Ways,
    /// Whether all of them have neighbours on all sides, in lit scenes.
    pub(super) are_inner: bool,
}

impl<const F: usize> Shown<F> {
    pub(super) fn new() -> Self {
        Shown {
            count: 0,
            slot: [0; ROOM],
            fields: [[[0.0; ROOM]; 4]; F],
            interval: [[0; ROOM]; F],
            length_mm: [0.0; ROOM],
            way: Ways::new(),
            are_inner: true,
        }
    }

    /// Forgets all cells.
    pub(super) fn clear(&mut self) {
        self.count = 0;
        self.are_inner = true;
    }

    /// Which lanes have cells, from a cell on.
    #[inline(always)]
    pub(super) fn are_cells<L: Lanes>(&self, first: usize) -> L::Mask {
        (L::Ints::count() + L::Ints::splat(first as i32)).lt(L::Ints::splat(self.count as i32))
    }

    /// The seats of the rays that pass as many cells as a register has lanes.
    #[inline(always)]
    pub(super) fn seats<L: Lanes>(&self, first: usize) -> L::Ints {
        L::Ints::load(&self.slot[first..]).and(L::Ints::splat(RAYS as i32 - 1))
    }

    /// Appends the chosen ones of a register's cells.
    #[inline(always)]
    pub(super) fn append<L: Lanes>(
        &mut self,
        chosen: L::Mask,
        slot: L::Ints,
        fields: &[Cubic<L>; F],
        interval: Option<&[L::Ints; F]>,
        length_mm: L,
        way: Option<&Way<L>>,
    ) {
        if !chosen.any() {
            return;
        }
        let at = self.count;
        if let Some(way) = way {
            self.way.append(at, chosen, way);
        }
        slot.compress(chosen).store(&mut self.slot[at..]);
        length_mm.compress(chosen).store(&mut self.length_mm[at..]);
        for f in 0..F {
            if let Some(interval) = interval {
                interval[f].compress(chosen).store(&mut self.interval[f][at..]);
            }
            for k in 0..4 {
                fields[f][k].compress(chosen).store(&mut self.fields[f][k][at..]);
            }
        }
        self.count += chosen.bits().count_ones() as usize;
    }
}

/// The way of a ray through a cell.
pub(super) struct Way<L: Lanes> {
    /// Lower corner of the cell, in memory.
    pub(super) base: L::Ints,
    /// Entry and exit, in `[0, 1]³` of the cell.
    pub(super) from: [L; 3],
    pub(super) to: [L; 3],
}

/// Ways through cells.
#[derive(Debug)]
pub(super) struct Ways {
    base: [i32; ROOM],
    from: [[f32; ROOM]; 3],
    to: [[f32; ROOM]; 3],
}

impl Ways {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Ways { base: [0; ROOM], from: [[0.0; ROOM]; 3], to: [[0.0; ROOM]; 3] }
    }

    #[inline(always)]
    fn append<L: Lanes>(&mut self, at: usize, chosen: L::Mask, way: &Way<L>) {
        way.base.compress(chosen).store(&mut self.base[at..]);
        for a in 0..3 {
            way.from[a].compress(chosen).store(&mut self.from[a][at..]);
            way.to[a].compress(chosen).store(&mut self.to[a][at..]);
        }
    }

    /// As many as a register has lanes.
    #[inline(always)]
    pub(super) fn load<L: Lanes>(&self, first: usize) -> Way<L> {
        let mut way = Way { base: L::Ints::load(&self.base[first..]), from: [L::ZERO; 3], to: [L::ZERO; 3] };
        for a in 0..3 {
            way.from[a] = L::load(&self.from[a][first..]);
            way.to[a] = L::load(&self.to[a][first..]);
        }
        way
    }
}

/// What the cells passed do to light, by slot.
#[derive(Debug)]
pub(super) struct Results {
    /// Radiance in red, green and blue, and what is absorbed.
    pub(super) light: [[f32; 4]; CELLS],
    /// Infinite where the cell must be integrated again.
    pub(super) error: [f32; CELLS],
    /// Variance of what the nodes of pieces miss; 0 where errors are proven.
    pub(super) variance: [f32; CELLS],
    /// Pieces integrated; 0 where nothing shows, and where nothing else is said.
    pub(super) pieces: [f32; CELLS],
}

impl Results {
    pub(super) fn new() -> Self {
        Results { light: [[0.0; 4]; CELLS], error: [0.0; CELLS], variance: [0.0; CELLS], pieces: [0.0; CELLS] }
    }

    /// From a slot on, cells will have so many pieces.
    #[inline(always)]
    pub(super) fn expect<L: Lanes>(&mut self, slot: usize, pieces: L) {
        pieces.store(&mut self.pieces[slot..]);
    }

    /// Sets those of some lanes' cells, which are in these slots. How many pieces they have has been said where it is not given.
    #[inline(always)]
    pub(super) fn put<L: Lanes>(
        &mut self,
        lanes: L::Mask,
        slots: &[i32],
        integral: &Integral<L>,
        variance: Option<L>,
        pieces: Option<L>,
    ) {
        let of_lanes = OfLanes::new(integral, variance, pieces);
        let mut left = lanes.bits();
        // As most are: nothing to look for, and nothing to wait for.
        if left == <L::Mask as Mask>::ALL.bits() {
            for (k, &slot) in slots[..L::LANES].iter().enumerate() {
                self.set(slot, &of_lanes, k);
            }
            return;
        }
        while left != 0 {
            let k = left.trailing_zeros() as usize % BATCH;
            left &= left - 1;
            self.set(slots[k], &of_lanes, k);
        }
    }

    #[inline(always)]
    fn set(&mut self, slot: i32, of_lanes: &OfLanes, k: usize) {
        let slot = slot as usize % CELLS;
        self.light[slot] = of_lanes.light[k];
        self.error[slot] = of_lanes.error[k];
        if let Some(variance) = &of_lanes.variance {
            self.variance[slot] = variance[k];
        }
        if let Some(pieces) = &of_lanes.pieces {
            self.pieces[slot] = pieces[k];
        }
    }

    /// Forgets all results.
    pub(super) fn clear(&mut self) {
        self.pieces.fill(0.0);
    }
}

/// What the cells in a register's lanes do to light, as [`Results`] keep it.
struct OfLanes {
    light: [[f32; 4]; BATCH],
    error: [f32; BATCH],
    variance: Option<[f32; BATCH]>,
    pieces: Option<[f32; BATCH]>,
}

impl OfLanes {
    #[inline(always)]
    fn new<L: Lanes>(integral: &Integral<L>, variance: Option<L>, pieces: Option<L>) -> Self {
        let [r, g, b] = integral.radiance;
        let mut light = [[0.0; 4]; BATCH];
        // Summed over pieces, it may be more by a rounding.
        L::store_vectors([r, g, b, integral.absorbed.min(L::ONE)], &mut light);
        OfLanes { light, error: stored(integral.error), variance: variance.map(stored), pieces: pieces.map(stored) }
    }
}

#[inline(always)]
fn stored<L: Lanes>(x: L) -> [f32; BATCH] {
    let mut numbers = [0.0; BATCH];
    x.store(&mut numbers);
    numbers
}
