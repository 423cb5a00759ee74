//! What the samples of a ray amount to: an extreme, a first local maximum, or an integral. Chosen by type, once per frame.
//!
//! Samples are in stored units; `sign` is -1 where values fall as stored numbers rise.

use super::blocks::Blocks;
use crate::field::{Pace, Position};
use crate::integrate::empty_space::{EmptySpace, Leap};

/// Gathers the samples of a ray, front to back.
pub(super) trait Gather: Sync {
    /// What has been gathered.
    type Gathered;

    /// Before the first sample.
    fn start(&self) -> Self::Gathered;
    /// Takes samples, each of which stands for `delta_mm`.
    fn take(&self, gathered: &mut Self::Gathered, run: &[f32], delta_mm: f64);
    /// How far the samples from `position` on matter, or do not; `None` if no block is ever passed over.
    fn leap(&self, gathered: &Self::Gathered, position: Position, pace: &Pace) -> Option<Leap>;
    /// Passes over samples that do not matter, each of which stands for `delta_mm`.
    fn pass(&self, _gathered: &mut Self::Gathered, _delta_mm: f64) {}
    /// True when no further sample matters.
    fn is_settled(&self, _gathered: &Self::Gathered) -> bool {
        false
    }
    /// The number of the ray, of samples in stored units.
    fn number(&self, gathered: &Self::Gathered) -> f64;
}

/// The largest value.
pub(super) struct Largest<'a> {
    pub(super) sign: f32,
    pub(super) blocks: Option<&'a Blocks>,
}

impl Gather for Largest<'_> {
    type Gathered = f32;

    fn start(&self) -> f32 {
        f32::NEG_INFINITY
    }

    #[inline(always)]
    fn take(&self, most: &mut f32, run: &[f32], _delta_mm: f64) {
        *most = run.iter().fold(*most, |most, &v| most.max(self.sign * v));
    }

    #[inline(always)]
    fn leap(&self, &most: &f32, position: Position, pace: &Pace) -> Option<Leap> {
        let blocks = self.blocks?;
        Some(blocks.leap(position, pace, |range| largest(self.sign, range) > most))
    }

    fn number(&self, &most: &f32) -> f64 {
        f64::from(self.sign * most)
    }
}

/// The first local maximum: [`crate::scene::ValueOf::LocalMaximum`] of the samples.
pub(super) struct FirstMaximum<'a> {
    pub(super) sign: f32,
    pub(super) threshold: f32,
    /// The fall that ends a maximum.
    pub(super) fall: f32,
    pub(super) blocks: Option<&'a Blocks>,
}

/// The largest value so far, and whether it has fallen from there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Summit {
    most: f32,
    is_passed: bool,
}

/// Roundings that an interpolated value may have suffered.
const ROUNDINGS: f32 = 8.0;

impl FirstMaximum<'_> {
    fn counts(&self, value: f32) -> bool {
        value >= self.sign * self.threshold
    }
}

impl Gather for FirstMaximum<'_> {
    type Gathered = Summit;

    fn start(&self) -> Summit {
        Summit { most: f32::NEG_INFINITY, is_passed: false }
    }

    #[inline(always)]
    fn take(&self, summit: &mut Summit, run: &[f32], _delta_mm: f64) {
        for v in run.iter().map(|v| self.sign * v) {
            if v > summit.most {
                summit.most = v;
            } else if self.counts(summit.most) && v < summit.most - self.fall.max(ROUNDINGS * f32::EPSILON * v.abs()) {
                summit.is_passed = true;
                return;
            }
        }
    }

    #[inline(always)]
    fn leap(&self, summit: &Summit, position: Position, pace: &Pace) -> Option<Leap> {
        let blocks = self.blocks?;
        // Below the threshold only what is larger than all before matters; above it every fall does.
        let matters = |range| self.counts(summit.most) || largest(self.sign, range) > summit.most;
        Some(blocks.leap(position, pace, matters))
    }

    fn is_settled(&self, summit: &Summit) -> bool {
        summit.is_passed
    }

    fn number(&self, summit: &Summit) -> f64 {
        f64::from(self.sign * summit.most)
    }
}

/// The integral over the length, stored units times mm; by the trapezoid rule, or by one sample for each interval. Summed
/// in f64, so that short steps lose nothing.
pub(super) struct Integral<'a, const TRAPEZOID: bool> {
    /// Where nothing but 0 is integrated.
    pub(super) empty_space: Option<&'a EmptySpace>,
}

/// The sum so far, and the sample before.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sum {
    total: f64,
    before: f64,
}

impl<const TRAPEZOID: bool> Gather for Integral<'_, TRAPEZOID> {
    type Gathered = Sum;

    fn start(&self) -> Sum {
        Sum::default()
    }

    #[inline(always)]
    fn take(&self, sum: &mut Sum, run: &[f32], delta_mm: f64) {
        for v in run.iter().map(|&v| f64::from(v)) {
            if TRAPEZOID {
                // The first sample closes an interval of length 0.
                sum.total += 0.5 * (sum.before + v) * delta_mm;
                sum.before = v;
            } else {
                sum.total += v * delta_mm;
            }
        }
    }

    #[inline(always)]
    fn leap(&self, _sum: &Sum, position: Position, pace: &Pace) -> Option<Leap> {
        Some(self.empty_space?.leap(position, pace))
    }

    fn pass(&self, sum: &mut Sum, delta_mm: f64) {
        // One sample of 0 closes the interval before it, and the others add 0.
        self.take(sum, &[0.0], delta_mm);
    }

    fn number(&self, sum: &Sum) -> f64 {
        sum.total
    }
}

#[inline(always)]
fn largest(sign: f32, [low, high]: [f32; 2]) -> f32 {
    if sign < 0.0 { -low } else { high }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number<G: Gather>(gather: &G, samples: &[f32]) -> f64 {
        let mut gathered = gather.start();
        for run in samples.chunks(3) {
            if !gather.is_settled(&gathered) {
                gather.take(&mut gathered, run, 0.5);
            }
        }
        gather.number(&gathered)
    }

    #[test]
    fn extremes_take_the_sign_into_account() {
        let samples = [3.0, -7.0, 12.0, 5.0];
        assert_eq!(number(&Largest { sign: 1.0, blocks: None }, &samples), 12.0);
        assert_eq!(number(&Largest { sign: -1.0, blocks: None }, &samples), -7.0);
    }

    #[test]
    fn a_plateau_counts_once_it_falls() {
        let first = |threshold| FirstMaximum { sign: 1.0, threshold, fall: 1e-6, blocks: None };
        let samples = [0.0, 4.0, 4.0, 4.0, 9.0, 9.0, 1.0, 50.0, 0.0];
        assert_eq!(number(&first(3.0), &samples), 9.0);
        assert_eq!(number(&first(10.0), &samples), 50.0);
        assert_eq!(number(&first(99.0), &samples), 50.0, "the overall maximum");
        let falling = FirstMaximum { sign: -1.0, threshold: -3.0, fall: 1e-6, blocks: None };
        assert_eq!(number(&falling, &samples.map(|v| -v)), -9.0);
        let wobble = [0.0, 1000.0, 1000.0 - 1e-4, 1200.0];
        assert_eq!(number(&first(3.0), &wobble), 1200.0, "rounding is no fall");
    }

    #[test]
    fn many_short_steps_lose_nothing() {
        let gather = Integral::<false> { empty_space: None };
        let mut sum = gather.start();
        for _ in 0..1_000_000 {
            gather.take(&mut sum, &[1000.0], 1e-4);
        }
        let found = gather.number(&sum);
        assert!((found / 1e5 - 1.0).abs() < 1e-10, "found {found}");
        let nodes = Integral::<true> { empty_space: None };
        let mut sum = nodes.start();
        nodes.take(&mut sum, &[6.0], 0.0);
        nodes.take(&mut sum, &[2.0, 4.0], 0.5);
        assert_eq!(nodes.number(&sum), 3.5, "two trapezia");
    }
}
