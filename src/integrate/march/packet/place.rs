//! Positions of samples in lanes, in fixed point: where a sample is depends on its number alone, however rays come to it.

use super::pieces::Pieces;
use crate::simd::{Ints, Lanes, Mask};

/// Samples of as many rays as a register has lanes, each with the step to the next, as [`Pieces`] has them.
#[derive(Clone, Copy)]
pub(super) struct Place<L: Lanes> {
    pub(super) corner: [L::Ints; 3],
    pub(super) fraction: [L::Ints; 3],
    pub(super) step: [L::Ints; 3],
    step_fraction: [L::Ints; 3],
}

impl<L: Lanes> Place<L> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        let none = [L::Ints::splat(0); 3];
        Place { corner: none, fraction: none, step: none, step_fraction: none }
    }

    /// The first samples of pieces from number `first` on.
    #[inline(always)]
    pub(super) fn load(pieces: &Pieces, first: usize) -> Self {
        let mut place = Place::new();
        for a in 0..3 {
            place.corner[a] = L::Ints::load(&pieces.corner[a][first..]);
            place.fraction[a] = L::Ints::load(&pieces.fraction[a][first..]);
            place.step[a] = L::Ints::load(&pieces.step[a][first..]);
            place.step_fraction[a] = L::Ints::load(&pieces.step_fraction[a][first..]);
        }
        place
    }

    /// These lanes in order, at the front, as pieces from number `first` on.
    #[inline(always)]
    pub(super) fn compress(&self, lanes: L::Mask, pieces: &mut Pieces, first: usize) {
        for a in 0..3 {
            self.corner[a].compress(lanes).store(&mut pieces.corner[a][first..]);
            self.fraction[a].compress(lanes).store(&mut pieces.fraction[a][first..]);
            self.step[a].compress(lanes).store(&mut pieces.step[a][first..]);
            self.step_fraction[a].compress(lanes).store(&mut pieces.step_fraction[a][first..]);
        }
    }

    /// The first lanes of another, in order, where seats are free; those that are taken change.
    #[inline(always)]
    pub(super) fn expand(&mut self, from: &Self, free: L::Mask, taken: L::Mask) {
        for a in 0..3 {
            self.corner[a] = L::Ints::select(taken, from.corner[a].expand(free), self.corner[a]);
            self.fraction[a] = L::Ints::select(taken, from.fraction[a].expand(free), self.fraction[a]);
            self.step[a] = L::Ints::select(taken, from.step[a].expand(free), self.step[a]);
            self.step_fraction[a] = L::Ints::select(taken, from.step_fraction[a].expand(free), self.step_fraction[a]);
        }
    }

    /// These lanes of another.
    #[inline(always)]
    pub(super) fn set(&mut self, lanes: L::Mask, to: &Self) {
        for a in 0..3 {
            self.corner[a] = L::Ints::select(lanes, to.corner[a], self.corner[a]);
            self.fraction[a] = L::Ints::select(lanes, to.fraction[a], self.fraction[a]);
        }
    }

    /// Where in the cell along an axis, 0 to 1.
    #[inline(always)]
    pub(super) fn fraction(&self, a: usize) -> L {
        L::from_ints(self.fraction[a]).mul_plus(L::from_f64(1.0 / (1u64 << 32) as f64), L::from_f64(0.5))
    }

    /// Steps per voxel along each axis, whatever the direction; 10³⁰ where there is no step.
    #[inline(always)]
    pub(super) fn steps_per_voxel(&self) -> [L; 3] {
        let (none, half) = (L::Ints::splat(0), L::Ints::splat(0xffff));
        let mut per_voxel = [L::ZERO; 3];
        for a in 0..3 {
            let (step, fraction) = (self.step[a], self.step_fraction[a]);
            let falls = step.lt(none);
            // Minus a number is what its bits are not, and one more in its last place.
            let borrowed = L::Ints::select(fraction.eq(none), none, L::Ints::splat(-1));
            let whole = L::Ints::select(falls, borrowed - step, step);
            let fraction = L::Ints::select(falls, none - fraction, fraction);
            let [upper, lower] = [fraction.shifted_right(16).and(half), fraction.and(half)];
            let parts = L::from_ints(upper) * L::from_f64(1.0 / (1u64 << 16) as f64)
                + L::from_ints(lower) * L::from_f64(1.0 / (1u64 << 32) as f64);
            per_voxel[a] = (L::ONE / (L::from_ints(whole) + parts)).min(L::from_f64(1e30));
        }
        per_voxel
    }

    /// Goes to the next sample.
    #[inline(always)]
    pub(super) fn advance(&mut self, moving: L::Mask) {
        for a in 0..3 {
            let fraction = self.fraction[a] + self.step_fraction[a];
            let carries = moving.and(fraction.lt(self.fraction[a]));
            let corner = self.corner[a] + self.step[a];
            self.fraction[a] = L::Ints::select(moving, fraction, self.fraction[a]);
            self.corner[a] = L::Ints::select(moving, corner, self.corner[a]);
            self.corner[a] = L::Ints::select(carries, self.corner[a] + L::Ints::splat(1), self.corner[a]);
        }
    }

    /// Goes so many samples further, fewer than 2¹⁶: exactly where single steps lead.
    #[inline(always)]
    pub(super) fn leap(&mut self, samples: L::Ints) {
        let (half, one) = (L::Ints::splat(0xffff), L::Ints::splat(1));
        for a in 0..3 {
            // samples · step_fraction has 48 bits: in two parts of 32 bits, 16 apart.
            let upper = samples * self.step_fraction[a].shifted_right(16).and(half);
            let first = self.fraction[a] + samples * self.step_fraction[a].and(half);
            let both = first + upper * L::Ints::splat(1 << 16);
            let mut corner = self.corner[a] + samples * self.step[a] + upper.shifted_right(16).and(half);
            corner = L::Ints::select(first.lt(self.fraction[a]), corner + one, corner);
            corner = L::Ints::select(both.lt(first), corner + one, corner);
            self.corner[a] = corner;
            self.fraction[a] = both;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Chord;
    use crate::integrate::march::lattice::Stretch;
    use crate::simd::{self, Level};
    use glam::DVec3;

    /// Places after so many samples, by steps and by leaps.
    struct Led(Vec<usize>);

    impl simd::Kernel for Led {
        type Output = ();

        #[inline(always)]
        fn run<L: Lanes>(self) {
            let mut pieces = Pieces::new();
            for n in 0..L::LANES {
                let u = |k: f64| (n as f64 * k + 0.13).fract();
                let from = DVec3::new(600.0 * u(0.618), 500.0 * u(0.414), 400.0 * u(0.732));
                let to = DVec3::new(600.0 * u(0.271), 500.0 * u(0.828), from.z);
                let chord = Chord { entry_mm: 0.0, length_mm: 1.0, entry_index: from, index_per_mm: to - from };
                let stretch = Stretch { first_mm: 0.0, last_mm: 1.0, samples: 40_000, delta_mm: 1.0 };
                pieces.add(&chord, &stretch, [601, 501, 401]);
            }
            pieces.finish([601, 501, 401]);
            let first = Place::<L>::load(&pieces, 0);
            let (mut stepped, mut steps) = (first, 0);
            for count in self.0 {
                while steps < count {
                    stepped.advance(<L::Mask as Mask>::ALL);
                    steps += 1;
                }
                let mut leapt = first;
                leapt.leap(L::Ints::splat(count as i32));
                for a in 0..3 {
                    let apart = |x: L::Ints, y: L::Ints| <L::Mask as Mask>::ALL.and_not(x.eq(y)).any();
                    assert!(!apart(leapt.corner[a], stepped.corner[a]), "axis {a}: another cell after {count} samples");
                    assert!(
                        !apart(leapt.fraction[a], stepped.fraction[a]),
                        "axis {a}: elsewhere after {count} samples"
                    );
                }
            }
        }
    }

    #[test]
    fn leaps_lead_where_steps_lead() {
        for level in Level::ALL {
            level.run(Led(vec![0, 1, 2, 7, 100, 999, 4096, 39_999]));
        }
    }
}
