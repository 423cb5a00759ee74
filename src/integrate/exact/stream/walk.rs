//! Rays on their way through the lattice, side by side: from face to face where something may show, and over everything else
//! in leaps.
//!
//! All crossings are computed from the ray's entry into the volume, in f64, and never accumulated, so that no error grows
//! along the ray; inside a cell coordinates are in `[0, 1]`, and f32 is enough.

use super::queue::{CELLS, Passed};
use crate::field::Chord;
use crate::integrate::exact::cells::Segment;
use crate::integrate::occupancy::Occupancy;
use crate::simd::{Doubles, Ints, Lanes, Mask};

/// Rays in flight at a time: as many as the widest register has lanes.
pub(super) const RAYS: usize = 16;

/// Steps of a ray in a round: as many as there is room for if each comes to a cell, so that no ray's rounds depend on the rays
/// beside it, and few, since what lies behind an opaque cell is looked at in vain.
pub(super) const STEPS: usize = CELLS / RAYS;

/// Rays inside a volume, one per seat.
#[derive(Debug)]
pub(super) struct Walks {
    /// Entry as a continuous index, and voxels per mm.
    entry: [[f64; RAYS]; 3],
    per_mm: [[f64; RAYS]; 3],
    /// mm per voxel; infinite along an axis on which the ray does not move.
    mm_per: [[f64; RAYS]; 3],
    /// Where each enters and leaves the volume, mm from its origin.
    entry_mm: [f64; RAYS],
    exit_mm: [f64; RAYS],
    /// 1 over the length inside, 1/mm.
    per_length_mm: [f64; RAYS],
    /// How far each has come.
    at_mm: [f64; RAYS],
    /// How far each had come a round before.
    settled_mm: [f64; RAYS],
    /// Each stays in the same block, or among empty ones, up to here.
    until_mm: [f64; RAYS],
    cell: [[i32; RAYS]; 3],
    /// Where each crosses the next face across each axis.
    next_mm: [[f64; RAYS]; 3],
    last_cell: [i32; 3],
    strides: [i32; 2],
}

impl Walks {
    /// Nobody in a lattice of `dims` voxels.
    pub(super) fn new([nx, ny, nz]: [usize; 3]) -> Self {
        Walks {
            entry: [[0.0; RAYS]; 3],
            per_mm: [[0.0; RAYS]; 3],
            mm_per: [[0.0; RAYS]; 3],
            entry_mm: [0.0; RAYS],
            exit_mm: [0.0; RAYS],
            per_length_mm: [0.0; RAYS],
            at_mm: [0.0; RAYS],
            settled_mm: [0.0; RAYS],
            until_mm: [0.0; RAYS],
            cell: [[0; RAYS]; 3],
            next_mm: [[0.0; RAYS]; 3],
            last_cell: [nx, ny, nz].map(|n| n as i32 - 2),
            strides: [nx as i32, (nx * ny) as i32],
        }
    }

    /// Seats a ray where it enters the volume.
    pub(super) fn enter(&mut self, seat: usize, chord: &Chord) {
        self.entry_mm[seat] = chord.entry_mm;
        self.exit_mm[seat] = chord.entry_mm + chord.length_mm;
        self.per_length_mm[seat] = 1.0 / chord.length_mm;
        self.at_mm[seat] = chord.entry_mm;
        self.until_mm[seat] = chord.entry_mm;
        for a in 0..3 {
            let (p, d) = (chord.entry_index[a], chord.index_per_mm[a]);
            self.entry[a][seat] = p;
            self.per_mm[a][seat] = d;
            self.mm_per[a][seat] = 1.0 / d;
            // On a face, the cell that the ray is about to pass.
            let cell = if d < 0.0 { p.ceil() - 1.0 } else { p.floor() };
            self.cell[a][seat] = (cell as i32).clamp(0, self.last_cell[a]);
            self.next_mm[a][seat] = self.face_mm(seat, a, self.cell[a][seat]);
        }
    }

    /// Frees a seat.
    pub(super) fn leave(&mut self, seat: usize) {
        self.at_mm[seat] = self.exit_mm[seat];
    }

    pub(super) fn is_over(&self, seat: usize) -> bool {
        self.at_mm[seat] >= self.exit_mm[seat]
    }

    /// Length inside the volume, mm.
    #[inline(always)]
    pub(super) fn length_mm(&self, seat: usize) -> f64 {
        self.exit_mm[seat] - self.entry_mm[seat]
    }

    /// 1 over the length inside the volume, 1/mm.
    #[inline(always)]
    pub(super) fn per_length_mm(&self, seat: usize) -> f64 {
        self.per_length_mm[seat]
    }

    /// The fraction of a ray that it had passed when its cells were last composited.
    pub(super) fn done(&self, seat: usize) -> f64 {
        self.fraction(seat, self.settled_mm[seat])
    }

    /// The fraction of a ray that lies in front of a distance from its origin.
    pub(super) fn fraction(&self, seat: usize, at_mm: f64) -> f64 {
        (at_mm - self.entry_mm[seat]) * self.per_length_mm[seat]
    }

    /// Where a ray leaves a cell across an axis; infinite for the border and an axis on which it does not move.
    fn face_mm(&self, seat: usize, a: usize, cell: i32) -> f64 {
        let d = self.per_mm[a][seat];
        let leaves = if d < 0.0 { cell == 0 } else { cell == self.last_cell[a] };
        if d == 0.0 || leaves {
            return f64::INFINITY;
        }
        self.crossing_mm(seat, a, if d < 0.0 { cell } else { cell + 1 })
    }

    fn crossing_mm(&self, seat: usize, a: usize, face: i32) -> f64 {
        self.entry_mm[seat] + (f64::from(face) - self.entry[a][seat]) * self.mm_per[a][seat]
    }

    /// A cell that a ray has passed, in f64.
    pub(super) fn segment(&self, seat: usize, cell: [i32; 3]) -> Segment {
        let (mut from_mm, mut to_mm) = (self.entry_mm[seat], self.exit_mm[seat]);
        for (a, &cell) in cell.iter().enumerate() {
            let d = self.per_mm[a][seat];
            to_mm = to_mm.min(self.face_mm(seat, a, cell));
            let enters = if d < 0.0 { cell < self.last_cell[a] } else { cell > 0 };
            if d != 0.0 && enters {
                from_mm = from_mm.max(self.crossing_mm(seat, a, if d < 0.0 { cell + 1 } else { cell }));
            }
        }
        let local = |mm: f64| {
            std::array::from_fn(|a| {
                let p = self.entry[a][seat] + (mm - self.entry_mm[seat]) * self.per_mm[a][seat];
                (p - f64::from(cell[a])).clamp(0.0, 1.0)
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

    /// Writes down the next cells of all rays, leaping over blocks in which nothing shows.
    #[inline(always)]
    pub(super) fn pass<L: Lanes>(&mut self, occupancy: &Occupancy, passed: &mut Passed) {
        passed.count = 0;
        self.settled_mm = self.at_mm;
        for first in (0..RAYS).step_by(L::LANES) {
            let mut group = Group::<L>::load(self, first);
            for _ in 0..STEPS {
                if !group.step(occupancy, passed) {
                    break;
                }
            }
            group.store(self, first);
        }
    }
}

/// As many rays as a register has lanes.
struct Group<L: Lanes> {
    entry: [L::Doubles; 3],
    per_mm: [L::Doubles; 3],
    mm_per: [L::Doubles; 3],
    moves: [L::Mask; 3],
    falls: [L::Mask; 3],
    entry_mm: L::Doubles,
    exit_mm: L::Doubles,
    at_mm: L::Doubles,
    /// Where that is, as a continuous index.
    place: [L::Doubles; 3],
    until_mm: L::Doubles,
    cell: [L::Ints; 3],
    next_mm: [L::Doubles; 3],
    last_cell: [L::Ints; 3],
    strides: [L::Ints; 2],
    seat: L::Ints,
}

impl<L: Lanes> Group<L> {
    #[inline(always)]
    fn load(walks: &Walks, first: usize) -> Self {
        let zero = L::Doubles::splat(0.0);
        let none = zero.lt(zero);
        let mut group = Group {
            entry: [zero; 3],
            per_mm: [zero; 3],
            mm_per: [zero; 3],
            moves: [none; 3],
            falls: [none; 3],
            entry_mm: L::Doubles::load(&walks.entry_mm[first..]),
            exit_mm: L::Doubles::load(&walks.exit_mm[first..]),
            at_mm: L::Doubles::load(&walks.at_mm[first..]),
            place: [zero; 3],
            until_mm: L::Doubles::load(&walks.until_mm[first..]),
            cell: [L::Ints::splat(0); 3],
            next_mm: [zero; 3],
            last_cell: [L::Ints::splat(0); 3],
            strides: [L::Ints::splat(walks.strides[0]), L::Ints::splat(walks.strides[1])],
            seat: L::Ints::count() + L::Ints::splat(first as i32),
        };
        for a in 0..3 {
            group.entry[a] = L::Doubles::load(&walks.entry[a][first..]);
            group.mm_per[a] = L::Doubles::load(&walks.mm_per[a][first..]);
            let per_mm = L::Doubles::load(&walks.per_mm[a][first..]);
            group.per_mm[a] = per_mm;
            let falls: L::Mask = per_mm.lt(zero);
            group.falls[a] = falls;
            group.moves[a] = falls.or(zero.lt(per_mm));
            group.cell[a] = L::Ints::load(&walks.cell[a][first..]);
            group.next_mm[a] = L::Doubles::load(&walks.next_mm[a][first..]);
            group.last_cell[a] = L::Ints::splat(walks.last_cell[a]);
            group.place[a] = group.place(a, group.at_mm);
        }
        group
    }

    #[inline(always)]
    fn store(&self, walks: &mut Walks, first: usize) {
        self.at_mm.store(&mut walks.at_mm[first..]);
        self.until_mm.store(&mut walks.until_mm[first..]);
        for a in 0..3 {
            self.cell[a].store(&mut walks.cell[a][first..]);
            self.next_mm[a].store(&mut walks.next_mm[a][first..]);
        }
    }

    /// One cell or one leap further, each ray; false if all have ended.
    #[inline(always)]
    fn step(&mut self, occupancy: &Occupancy, passed: &mut Passed) -> bool {
        let under_way = self.at_mm.lt(self.exit_mm);
        if !under_way.any() {
            return false;
        }
        let leaps = self.leap(occupancy, under_way);
        let steps = under_way.and_not(leaps);
        let [x, y, z] = self.next_mm;
        let first_mm = x.min(y).min(z);
        let across_x = x.le(y).and(x.le(z));
        let across_y = y.le(z).and_not(across_x);
        let to_mm = first_mm.min(self.exit_mm);
        let passes = steps.and(self.at_mm.lt(to_mm));
        if passes.any() {
            self.write_down(passes, to_mm, passed);
        }
        let goes_on = steps.and(first_mm.lt(self.exit_mm));
        self.at_mm = L::Doubles::select(passes, to_mm, self.at_mm);
        self.at_mm = L::Doubles::select(steps.and_not(goes_on), self.exit_mm, self.at_mm);
        let across = [across_x, across_y, goes_on.and_not(across_x).and_not(across_y)];
        for a in 0..3 {
            let moved = goes_on.and(across[a]);
            let one = L::Ints::select(self.falls[a], L::Ints::splat(-1), L::Ints::splat(1));
            self.cell[a] = L::Ints::select(moved, self.cell[a] + one, self.cell[a]);
            self.next_mm[a] = L::Doubles::select(moved, self.face_mm(a), self.next_mm[a]);
        }
        true
    }

    /// Leaps over the empty cubes that rays have come to; says which did.
    #[inline(always)]
    fn leap(&mut self, occupancy: &Occupancy, under_way: L::Mask) -> L::Mask {
        let arrives = under_way.and(self.until_mm.le(self.at_mm));
        let none = under_way.and_not(under_way);
        if !arrives.any() {
            return none;
        }
        let (log2_cells, is_empty) = occupancy.around::<L>(self.cell);
        let mut leaves_mm = self.exit_mm;
        for a in 0..3 {
            let low = self.cell[a].without_low_bits(log2_cells);
            let face = L::Ints::select(self.falls[a], low, low + log2_cells.power_of_two());
            let nearer = leaves_mm.min(self.crossing_mm(a, face));
            leaves_mm = L::Doubles::select(self.moves[a], nearer, leaves_mm);
        }
        let leaps = arrives.and(is_empty).and(self.at_mm.lt(leaves_mm));
        self.until_mm = L::Doubles::select(arrives.and_not(leaps), leaves_mm, self.until_mm);
        if leaps.any() {
            self.at_mm = L::Doubles::select(leaps, leaves_mm, self.at_mm);
            let zero = L::Doubles::splat(0.0);
            for a in 0..3 {
                let p = self.place(a, self.at_mm);
                self.place[a] = L::Doubles::select(leaps, p, self.place[a]);
                // On a face, the cell that the ray is about to pass: ⌈p⌉ − 1 on the way down.
                let down = zero - (zero - p).floor() - L::Doubles::splat(1.0);
                let cell = L::Doubles::select(self.falls[a], down, p.floor()).to_ints();
                let cell = cell.max(L::Ints::splat(0)).min(self.last_cell[a]);
                self.cell[a] = L::Ints::select(leaps, cell, self.cell[a]);
                self.next_mm[a] = L::Doubles::select(leaps, self.face_mm(a), self.next_mm[a]);
            }
        }
        leaps
    }

    #[inline(always)]
    fn write_down(&mut self, passes: L::Mask, to_mm: L::Doubles, passed: &mut Passed) {
        let at = passed.count;
        let (zero, one) = (L::Doubles::splat(0.0), L::Doubles::splat(1.0));
        for a in 0..3 {
            let cell = L::Doubles::from_ints(self.cell[a]);
            let there = self.place(a, to_mm);
            let from = (self.place[a] - cell).max(zero).min(one);
            let to = (there - cell).max(zero).min(one);
            self.place[a] = L::Doubles::select(passes, there, self.place[a]);
            L::from_doubles(from).compress(passes).store(&mut passed.from[a][at..]);
            L::from_doubles(to).compress(passes).store(&mut passed.to[a][at..]);
            self.cell[a].compress(passes).store(&mut passed.cell[a][at..]);
        }
        let [i, j, k] = self.cell;
        let base = i + j * self.strides[0] + k * self.strides[1];
        base.compress(passes).store(&mut passed.base[at..]);
        self.seat.compress(passes).store(&mut passed.seat[at..]);
        L::from_doubles(to_mm - self.at_mm).compress(passes).store(&mut passed.length_mm[at..]);
        L::from_doubles(to_mm - self.entry_mm).compress(passes).store(&mut passed.exit_mm[at..]);
        passed.count += passes.bits().count_ones() as usize;
    }

    /// A continuous index along an axis.
    #[inline(always)]
    fn place(&self, a: usize, at_mm: L::Doubles) -> L::Doubles {
        self.entry[a] + (at_mm - self.entry_mm) * self.per_mm[a]
    }

    /// Where rays cross a face across an axis on which they move.
    #[inline(always)]
    fn crossing_mm(&self, a: usize, face: L::Ints) -> L::Doubles {
        self.entry_mm + (L::Doubles::from_ints(face) - self.entry[a]) * self.mm_per[a]
    }

    /// Where rays leave their cells across an axis; infinite for the border and an axis on which they do not move.
    #[inline(always)]
    fn face_mm(&self, a: usize) -> L::Doubles {
        let (cell, none) = (self.cell[a], L::Ints::splat(0));
        let border = L::Ints::select(self.falls[a], none, self.last_cell[a]);
        let face = L::Ints::select(self.falls[a], cell, cell + L::Ints::splat(1));
        let goes_on = self.moves[a].and_not(cell.eq(border));
        L::Doubles::select(goes_on, self.crossing_mm(a, face), L::Doubles::splat(f64::INFINITY))
    }
}
