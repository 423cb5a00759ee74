//! Rays on their way through the lattice, side by side: from face to face where something may show, and over everything else
//! in leaps.
//!
//! A few steps at a time are made in f32 from a place known in f64, and so are the coordinates in cells.

use super::queue::CELLS;
use super::seats::Walks;
use crate::integrate::occupancy::Occupancy;
use crate::simd::{Doubles, Ints, Lanes, Mask, TWO_BATCHES};

/// Rays in flight at a time: twice as many as the widest register has lanes, so that a round has cells for all registers, and still
/// no ray is walked far behind what may turn out to be opaque.
pub(super) const RAYS: usize = TWO_BATCHES;

/// Steps of a ray in a round, a cell at most each. No ray's rounds depend on the rays beside it; few, since what lies behind
/// an opaque cell is looked at in vain.
pub(super) const STEPS: usize = CELLS / RAYS;

/// Steps that rays walk ahead before anything is read: memory is slow, and many reads at a time hide that.
pub(super) const AHEAD: usize = 4;

/// Leaps of a ray in a step, at most.
const LEAPS: usize = 2;

/// Of what is left of a ray, what is walked: short of the border by more than the rounding of [`AHEAD`] steps, behind which there
/// is no cell.
const INSIDE: f64 = 1.0 - 4.0 * f32::EPSILON as f64;

impl<const N: usize> Walks<N> {
    /// Lets all rays leap as long as nothing shows.
    #[inline(always)]
    pub(super) fn leap<L: Lanes>(&mut self, occupancy: &Occupancy) {
        for first in (0..N).step_by(L::LANES) {
            let lines = Lines::<L>::load(self, first);
            let mut at = Cells::<L>::load(self, first);
            let mut leapt = at.from_mm.lt(at.from_mm);
            loop {
                let leaps = lines.leap(&mut at, occupancy, <L::Mask as Mask>::ALL);
                if !leaps.any() {
                    break;
                }
                leapt = leapt.or(leaps);
            }
            if leapt.any() {
                lines.land(&mut at, leapt);
                at.store(self, first);
            }
        }
    }

    /// Walks all rays on by a round. `pass` is given what the rays of some lanes pass at several steps, and the slot of the first
    /// ray at the first step: that of a ray at a step is its seat, plus the number of seats times the step.
    #[inline(always)]
    pub(super) fn pass<L: Lanes>(
        &mut self,
        occupancy: &Occupancy,
        mut pass: impl FnMut(&Lines<L>, &[Cells<L>; AHEAD], usize),
    ) {
        self.settled_mm = self.at_mm;
        for first in (0..N).step_by(L::LANES) {
            let lines = Lines::<L>::load(self, first);
            let mut at = Cells::<L>::load(self, first);
            let mut cells = [at; AHEAD];
            for n in (0..STEPS).step_by(AHEAD) {
                lines.settle(&mut at);
                let mut looks = <L::Mask as Mask>::ALL;
                for passed in &mut cells {
                    // Who is where something may show looks around again in the next such steps, who has just leapt in the next one.
                    looks = lines.step(&mut at, occupancy, looks);
                    *passed = at;
                    lines.go_on(&mut at);
                }
                pass(&lines, &cells, first + n * N);
                if !at.from_mm.lt(at.rest_mm).any() {
                    break;
                }
            }
            lines.settle(&mut at);
            at.store(self, first);
        }
    }
}

/// Where as many rays as a register has lanes are.
#[derive(Clone, Copy)]
pub(super) struct Cells<L: Lanes> {
    rising: [L::Ints; 3],
    /// Which rays pass a cell.
    pub(super) passes: L::Mask,
    /// Place in memory of the cell's lower corner.
    pub(super) base: L::Ints,
    /// From where distances are counted for a few steps, mm from where rays entered the volume.
    origin_mm: L::Doubles,
    /// Where rays enter and leave the cell, where they cross the next faces, and where they leave the volume.
    pub(super) from_mm: L,
    pub(super) to_mm: L,
    next_mm: [L; 3],
    rest_mm: L,
}

impl<L: Lanes> Cells<L> {
    #[inline(always)]
    fn load<const N: usize>(walks: &Walks<N>, first: usize) -> Self {
        let nothing = L::Ints::splat(0);
        let mut cells = Cells {
            rising: [nothing; 3],
            passes: nothing.lt(nothing),
            base: L::Ints::load(&walks.base[first..]),
            origin_mm: L::Doubles::load(&walks.at_mm[first..]),
            from_mm: L::ZERO,
            to_mm: L::ZERO,
            next_mm: [L::ZERO; 3],
            rest_mm: L::ONE,
        };
        for a in 0..3 {
            cells.rising[a] = L::Ints::load(&walks.cell[a][first..]);
        }
        cells
    }

    #[inline(always)]
    fn store<const N: usize>(&self, walks: &mut Walks<N>, first: usize) {
        self.origin_mm.store(&mut walks.at_mm[first..]);
        self.base.store(&mut walks.base[first..]);
        for a in 0..3 {
            self.rising[a].store(&mut walks.cell[a][first..]);
        }
    }

    /// Where rays leave their cells, mm from where they entered the volume.
    #[inline(always)]
    pub(super) fn exit_mm(&self) -> L {
        L::from_doubles(self.origin_mm) + self.to_mm
    }
}

/// What does not change along as many rays as a register has lanes.
pub(super) struct Lines<L: Lanes> {
    entry: [L::Doubles; 3],
    per_mm: [L::Doubles; 3],
    mm_per: [L::Doubles; 3],
    face_zero_mm: [L::Doubles; 3],
    mm_per_face: [L; 3],
    leaves_at: [L; 3],
    less_per_mm: [L; 3],
    falls: [L::Mask; 3],
    last_cell: [L::Ints; 3],
    strides: [L::Ints; 3],
    exit_mm: L::Doubles,
}

impl<L: Lanes> Lines<L> {
    #[inline(always)]
    fn load<const N: usize>(walks: &Walks<N>, first: usize) -> Self {
        let (zero, nothing) = (L::Doubles::splat(0.0), L::Ints::splat(0));
        let none = nothing.lt(nothing);
        let mut lines = Lines {
            entry: [zero; 3],
            per_mm: [zero; 3],
            mm_per: [zero; 3],
            face_zero_mm: [zero; 3],
            mm_per_face: [L::ZERO; 3],
            leaves_at: [L::ZERO; 3],
            less_per_mm: [L::ZERO; 3],
            falls: [none; 3],
            last_cell: [nothing; 3],
            strides: [nothing; 3],
            exit_mm: L::Doubles::load(&walks.exit_mm[first..]),
        };
        for (a, stride) in walks.strides().into_iter().enumerate() {
            let falls = L::Ints::load(&walks.falls[a][first..]).lt(nothing);
            lines.entry[a] = L::Doubles::load(&walks.entry[a][first..]);
            lines.per_mm[a] = L::Doubles::load(&walks.per_mm[a][first..]);
            lines.mm_per[a] = L::Doubles::load(&walks.mm_per[a][first..]);
            lines.face_zero_mm[a] = L::Doubles::load(&walks.face_zero_mm[a][first..]);
            lines.mm_per_face[a] = L::from_doubles(lines.mm_per[a]);
            lines.leaves_at[a] = L::load(&walks.leaves_at[a][first..]);
            let per_mm = L::from_doubles(lines.per_mm[a]);
            lines.less_per_mm[a] = L::select(falls, -per_mm, per_mm);
            lines.falls[a] = falls;
            lines.last_cell[a] = L::Ints::select(falls, L::Ints::splat(-1), L::Ints::splat(walks.last_cell(a)));
            lines.strides[a] = L::Ints::select(falls, L::Ints::splat(-stride), L::Ints::splat(stride));
        }
        lines
    }

    /// Counts distances from where rays are.
    #[inline(always)]
    fn settle(&self, at: &mut Cells<L>) {
        let at_mm = at.origin_mm + at.from_mm.to_doubles();
        // Nobody stays a rounding short of the border.
        at.origin_mm = L::Doubles::select(at.from_mm.lt(at.rest_mm), at_mm, self.exit_mm);
        at.from_mm = L::ZERO;
        at.rest_mm = L::from_doubles((self.exit_mm - at.origin_mm) * L::Doubles::splat(INSIDE));
        for a in 0..3 {
            at.next_mm[a] = self.next_mm(at, a);
        }
    }

    /// Lets those leap that look around, and finds where rays leave the cells they have come to. Says which have leapt.
    #[inline(always)]
    fn step(&self, at: &mut Cells<L>, occupancy: &Occupancy, looks: L::Mask) -> L::Mask {
        let none = at.from_mm.lt(at.from_mm);
        let (mut leapt, mut leaps) = (none, none);
        if looks.any() {
            for _ in 0..LEAPS {
                leaps = self.leap(at, occupancy, looks);
                leapt = leapt.or(leaps);
                if !leaps.any() {
                    break;
                }
            }
        }
        if leapt.any() {
            self.land(at, leapt);
        }
        let [x, y, z] = at.next_mm;
        let to_mm = x.min(y).min(z).min(at.rest_mm);
        // Where rays are that have just leapt is not known yet; they stay there.
        at.to_mm = L::select(leaps, at.from_mm, to_mm);
        at.passes = at.from_mm.lt(at.to_mm);
        leapt
    }

    /// Goes on to the next cells.
    #[inline(always)]
    fn go_on(&self, at: &mut Cells<L>) {
        let goes_on = at.to_mm.lt(at.rest_mm);
        for a in 0..3 {
            // Across an edge or a corner, along several axes at once.
            let moved = goes_on.and(at.next_mm[a].le(at.to_mm));
            at.rising[a] = L::Ints::select(moved, at.rising[a] + L::Ints::splat(1), at.rising[a]);
            at.base = L::Ints::select(moved, at.base + self.strides[a], at.base);
            at.next_mm[a] = L::select(moved, at.next_mm[a] + self.mm_per_face[a], at.next_mm[a]);
        }
        at.from_mm = at.from_mm.max(at.to_mm);
    }

    /// Leaps over the empty cubes that rays have come to; says which did.
    #[inline(always)]
    fn leap(&self, at: &mut Cells<L>, occupancy: &Occupancy, looks: L::Mask) -> L::Mask {
        let log2_cells = occupancy.around::<L>(self.cell(at));
        let is_empty = looks.and(L::Ints::splat(0).lt(log2_cells)).and(at.from_mm.lt(at.rest_mm));
        if !is_empty.any() {
            return is_empty;
        }
        let at_mm = at.origin_mm + at.from_mm.to_doubles();
        let mut leaves_mm = self.exit_mm;
        for a in 0..3 {
            let face = at.rising[a].without_low_bits(log2_cells) + log2_cells.power_of_two();
            leaves_mm = leaves_mm.min(self.crossing_mm(a, face));
        }
        let leaps = is_empty.and(at_mm.lt(leaves_mm));
        at.origin_mm = L::Doubles::select(leaps, leaves_mm, at.origin_mm);
        at.from_mm = L::select(leaps, L::ZERO, at.from_mm);
        let rest_mm = (self.exit_mm - leaves_mm) * L::Doubles::splat(INSIDE);
        at.rest_mm = L::select(leaps, L::from_doubles(rest_mm), at.rest_mm);
        for a in 0..3 {
            let place = leaves_mm.mul_plus(self.per_mm[a], self.entry[a]);
            let cell = place.floor().to_ints().min(self.last_cell[a]);
            at.rising[a] = L::Ints::select(leaps, cell, at.rising[a]);
        }
        leaps
    }

    /// Finds what follows from the cells that rays have leapt to.
    #[inline(always)]
    fn land(&self, at: &mut Cells<L>, leapt: L::Mask) {
        for a in 0..3 {
            at.next_mm[a] = L::select(leapt, self.next_mm(at, a), at.next_mm[a]);
        }
        let [i, j, k] = self.cell(at);
        // The strides' sizes, whatever their signs.
        let [_, row, slab] = self.strides;
        let (row, slab) = (row.max(L::Ints::splat(0) - row), slab.max(L::Ints::splat(0) - slab));
        at.base = L::Ints::select(leapt, i + j * row + k * slab, at.base);
    }

    /// The lower corners of cells, voxel indices.
    #[inline(always)]
    pub(super) fn cell(&self, at: &Cells<L>) -> [L::Ints; 3] {
        let mut cell = at.rising;
        for a in 0..3 {
            cell[a] = L::Ints::select(self.falls[a], L::Ints::splat(-1) - cell[a], cell[a]);
        }
        cell
    }

    /// Coordinates in `[0, 1]³` of cells, at a distance that is counted as theirs are.
    #[inline(always)]
    pub(super) fn coordinates(&self, cells: &Cells<L>, at_mm: L) -> [L; 3] {
        let mut coordinates = [L::ZERO; 3];
        for a in 0..3 {
            let x = self.leaves_at[a].minus_product(cells.next_mm[a] - at_mm, self.less_per_mm[a]);
            coordinates[a] = x.max(L::ZERO).min(L::ONE);
        }
        coordinates
    }

    /// Where rays cross the next face across an axis.
    #[inline(always)]
    fn next_mm(&self, at: &Cells<L>, a: usize) -> L {
        L::from_doubles(self.crossing_mm(a, at.rising[a] + L::Ints::splat(1)) - at.origin_mm)
    }

    /// Where rays cross a face across an axis, mm from where they entered the volume.
    #[inline(always)]
    fn crossing_mm(&self, a: usize, face: L::Ints) -> L::Doubles {
        L::Doubles::from_ints(face).mul_plus(self.mm_per[a], self.face_zero_mm[a])
    }
}
