//! Lanes of several registers, put together to full ones.

use super::{Ints, Lanes, Mask};

/// How chosen lanes of a register join others that wait at the front of another: behind them, in order, as many as there is room
/// for. So registers are read and written whole, each in its own place, however few lanes are added at a time.
pub(crate) struct Joining<L: Lanes> {
    /// Of each place, the lane that comes there: of those that wait or, behind these, of the register.
    from: L::Ints,
    /// Chosen lanes for which there is no room.
    left: L::Mask,
    chosen: usize,
}

impl<L: Lanes> Joining<L> {
    /// These lanes join so many that wait, fewer than a register has.
    #[inline(always)]
    pub(crate) fn new(waiting: usize, chosen: L::Mask) -> Self {
        let lanes = L::LANES as i32;
        let (number, waiting) = (L::Ints::count(), waiting as i32);
        let has_room = number.expand(chosen).lt(L::Ints::splat(lanes - waiting));
        let waits = number.lt(L::Ints::splat(waiting));
        let free = <L::Mask as Mask>::ALL.and_not(waits);
        let joins = (number + L::Ints::splat(lanes)).compress(chosen).expand(free);
        Joining {
            from: L::Ints::select(waits, number, joins),
            left: chosen.and_not(has_room),
            chosen: chosen.bits().count_ones() as usize,
        }
    }

    /// How many join, or would.
    #[inline(always)]
    pub(crate) fn chosen(&self) -> usize {
        self.chosen
    }

    /// Puts the chosen ones of these numbers behind those that wait.
    #[inline(always)]
    pub(crate) fn join(&self, numbers: L, waiting: &mut [f32]) {
        L::load(waiting).among(numbers, self.from).store(waiting);
    }

    /// Likewise.
    #[inline(always)]
    pub(crate) fn join_ints(&self, numbers: L::Ints, waiting: &mut [i32]) {
        L::Ints::load(waiting).among(numbers, self.from).store(waiting);
    }

    /// Puts those for which there was no room to the front.
    #[inline(always)]
    pub(crate) fn put(&self, numbers: L, front: &mut [f32]) {
        numbers.compress(self.left).store(front);
    }

    /// Likewise.
    #[inline(always)]
    pub(crate) fn put_ints(&self, numbers: L::Ints, front: &mut [i32]) {
        numbers.compress(self.left).store(front);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{BATCH, Kernel, Level};

    /// Every multiple of each of these numbers below 1000, by registers of chosen lanes: 1, 2, 3, … , 2, 4, 6, …
    struct Joined<'m>(&'m [i32]);

    impl Kernel for Joined<'_> {
        type Output = Vec<(i32, f32)>;

        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let (mut ints, mut numbers) = ([[0; BATCH]; 2], [[0.0; BATCH]; 2]);
            let (mut waiting, mut all) = (0, Vec::new());
            for &of in self.0 {
                for at in (0..1000).step_by(L::LANES) {
                    let number = L::Ints::count() + L::Ints::splat(at);
                    let mut chosen = [0; BATCH];
                    number.store(&mut chosen);
                    let is_multiple = chosen.map(|n| i32::from(n < 1000 && n % of == 0));
                    let chosen = L::Ints::splat(0).lt(L::Ints::load(&is_multiple));
                    let joining = Joining::<L>::new(waiting, chosen);
                    joining.join_ints(number, &mut ints[0]);
                    joining.join(L::from_ints(number), &mut numbers[0]);
                    waiting += joining.chosen();
                    if waiting >= L::LANES {
                        waiting -= L::LANES;
                        all.extend(ints[0].into_iter().zip(numbers[0]).take(L::LANES));
                        joining.put_ints(number, &mut ints[0]);
                        joining.put(L::from_ints(number), &mut numbers[0]);
                    }
                }
            }
            all.extend(ints[0].into_iter().zip(numbers[0]).take(waiting));
            all
        }
    }

    #[test]
    fn chosen_lanes_come_together_in_order() {
        for of in [&[1][..], &[7], &[3, 1, 500, 2, 11, 1, 999, 4]] {
            let multiples = of.iter().flat_map(|&of| (0..1000).filter(move |n| n % of == 0));
            let expected: Vec<(i32, f32)> = multiples.map(|n| (n, n as f32)).collect();
            for level in Level::ALL {
                assert_eq!(level.run(Joined(of)), expected, "{level}, multiples of {of:?}");
            }
        }
    }
}
