//! Where a ray is cut into intervals, and where each interval is sampled.
//!
//! The cuts are at 0, at the length of the ray, and at `first + i · step` between, each computed from its number and never
//! by adding steps up. The first and the last interval may be shorter than a step; both count with their own length.

use glam::DVec3;

use super::jitter;
use crate::field::Chord;
use crate::plan::{Lattice, March, Order, SampleRule};
use crate::scene::Ray;

/// The cuts of one ray: `intervals` of them, each as long as the step but for the first and the last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cuts {
    first_mm: f64,
    step_mm: f64,
    length_mm: f64,
    intervals: usize,
}

/// Samples at equal distances, all of which stand for the same length of the ray.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Stretch {
    /// Place of the first sample, mm from the entry.
    pub(super) first_mm: f64,
    /// Place of the last one.
    pub(super) last_mm: f64,
    /// Number of samples.
    pub(super) samples: usize,
    /// Length that each stands for: of its interval, or of the one between it and the sample visited before.
    pub(super) delta_mm: f64,
}

impl Stretch {
    /// This stretch, given front to back, alone and in another order.
    pub(super) fn in_order(mut self, order: Order) -> [Stretch; 4] {
        if order == Order::BackToFront {
            (self.first_mm, self.last_mm) = (self.last_mm, self.first_mm);
        }
        [self, Stretch::default(), Stretch::default(), Stretch::default()]
    }

    /// How far beyond the border of a volume of `dims` voxels a ray's first stretch begins, as a difference of continuous
    /// indices: 0 unless it is the one sample of whole steps that are longer than the ray.
    #[inline(always)]
    pub(super) fn beyond_voxels(&self, chord: &Chord, dims: [usize; 3]) -> DVec3 {
        if self.samples > 1 || self.first_mm <= chord.length_mm {
            return DVec3::ZERO;
        }
        let index = chord.index_at(self.first_mm);
        index - index.clamp(DVec3::ZERO, DVec3::from_array(dims.map(|n| (n - 1) as f64)))
    }
}

impl Cuts {
    /// Cuts a ray's chord as the settings say. `anchor_mm` is a point on one of the view planes.
    #[inline(always)]
    pub(super) fn new(
        settings: &March,
        chord: &Chord,
        ray: Ray,
        forward: DVec3,
        anchor_mm: DVec3,
        [column, row]: [usize; 2],
    ) -> Self {
        let offset = jitter::offset(settings.jitter, column, row);
        match settings.lattice {
            Lattice::PerRay => Cuts::from_first(settings.step_mm * (1.0 - offset), settings.step_mm, chord.length_mm),
            Lattice::ViewPlanes => {
                let slope = ray.direction.dot(forward);
                let entry_depth_mm = (ray.origin_mm - anchor_mm).dot(forward) + chord.entry_mm * slope;
                let planes_passed = entry_depth_mm / settings.step_mm + offset;
                let to_next_plane = 1.0 - (planes_passed - planes_passed.floor());
                let step_mm = settings.step_mm / slope;
                Cuts::from_first(step_mm * to_next_plane, step_mm, chord.length_mm)
            }
        }
    }

    #[inline(always)]
    fn from_first(first_mm: f64, step_mm: f64, length_mm: f64) -> Self {
        // A rest below a billionth of a step is rounding, and goes to the interval before it.
        let more = ((length_mm - first_mm) / step_mm - 1e-9).ceil().max(0.0);
        Cuts { first_mm, step_mm, length_mm, intervals: 1 + more as usize }
    }

    /// Cut `i` of `0..=intervals`, mm from the entry.
    #[inline(always)]
    fn at(&self, i: usize) -> f64 {
        match i {
            0 => 0.0,
            _ if i >= self.intervals => self.length_mm,
            _ => self.first_mm + (i - 1) as f64 * self.step_mm,
        }
    }

    /// Length of interval `i`.
    #[inline(always)]
    fn length_of(&self, i: usize) -> f64 {
        self.at(i + 1) - self.at(i)
    }

    /// Samples of intervals `i` to `to`, at their beginnings or in their middles, if all are as long as the first.
    #[inline(always)]
    fn of_intervals(&self, rule: SampleRule, i: usize, to: usize) -> Stretch {
        let place = |i: usize| if rule == SampleRule::Left { self.at(i) } else { 0.5 * (self.at(i) + self.at(i + 1)) };
        Stretch { first_mm: place(i), last_mm: place(to), samples: to + 1 - i.min(to + 1), delta_mm: self.length_of(i) }
    }

    /// Samples at the ends of whole steps, the first of them even where the ray is shorter.
    pub(super) fn whole_steps(&self) -> Stretch {
        // A sample that rounding puts beyond the exit is still on the border.
        let more = ((self.length_mm - self.first_mm) / self.step_mm + 1e-9).floor().max(0.0);
        let last_mm = self.first_mm + more * self.step_mm;
        Stretch { first_mm: self.first_mm, last_mm, samples: 1 + more as usize, delta_mm: self.step_mm }
    }

    /// The samples in the order they are visited, as at most four stretches.
    #[inline(always)]
    pub(super) fn stretches(&self, rule: SampleRule, order: Order) -> [Stretch; 4] {
        let n = self.intervals;
        let inner = n.saturating_sub(2);
        if rule == SampleRule::WholeSteps {
            return self.whole_steps().in_order(order);
        }
        let stretches = match rule {
            SampleRule::Left | SampleRule::Midpoint | SampleRule::WholeSteps => {
                let last = self.of_intervals(rule, n - 1, n - 1);
                if n > 1 && self.first_mm == self.step_mm {
                    // The first interval is as long as the others.
                    let whole = Stretch { delta_mm: self.step_mm, ..self.of_intervals(rule, 0, n - 2) };
                    return ordered([whole, last, Stretch::default(), Stretch::default()], order);
                }
                let first = self.of_intervals(rule, 0, 0);
                let between = self.of_intervals(rule, 1, n.max(2) - 2);
                let between = Stretch { samples: inner, delta_mm: self.step_mm, ..between };
                let last = Stretch { samples: usize::from(n > 1), ..last };
                [first, between, last, Stretch::default()]
            }
            SampleRule::Trapezoid => {
                // Nodes are the cuts; each closes the interval from the node visited before it.
                let at = |i: usize, to: usize, samples: usize, delta_mm: f64| Stretch {
                    first_mm: self.at(i),
                    last_mm: self.at(to),
                    samples,
                    delta_mm,
                };
                let both = usize::from(n > 1);
                match order {
                    Order::FrontToBack => [
                        at(0, 0, 1, 0.0),
                        at(1, 1, both, self.length_of(0)),
                        at(2, n.max(2) - 1, inner, self.step_mm),
                        at(n, n, 1, self.length_of(n - 1)),
                    ],
                    Order::BackToFront => [
                        at(0, 0, 1, self.length_of(0)),
                        at(1, n.max(2) - 2, inner, self.step_mm),
                        at(n - 1, n - 1, both, self.length_of(n - 1)),
                        at(n, n, 1, 0.0),
                    ],
                }
            }
        };
        ordered(stretches, order)
    }
}

/// Stretches given front to back, in the order they are visited.
fn ordered(mut stretches: [Stretch; 4], order: Order) -> [Stretch; 4] {
    if order == Order::BackToFront {
        stretches.reverse();
        for s in &mut stretches {
            (s.first_mm, s.last_mm) = (s.last_mm, s.first_mm);
        }
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All samples as (place, length).
    fn samples(cuts: Cuts, rule: SampleRule, order: Order) -> Vec<(f64, f64)> {
        let mut all = Vec::new();
        for s in cuts.stretches(rule, order) {
            for i in 0..s.samples {
                let share = if s.samples > 1 { i as f64 / (s.samples - 1) as f64 } else { 0.0 };
                all.push((s.first_mm + share * (s.last_mm - s.first_mm), s.delta_mm));
            }
        }
        all
    }

    #[test]
    fn partial_intervals_count_with_their_own_length() {
        let cuts = Cuts::from_first(0.5, 2.0, 5.0);
        let left = samples(cuts, SampleRule::Left, Order::FrontToBack);
        assert_eq!(left, [(0.0, 0.5), (0.5, 2.0), (2.5, 2.0), (4.5, 0.5)]);
        let middle = samples(cuts, SampleRule::Midpoint, Order::FrontToBack);
        assert_eq!(middle, [(0.25, 0.5), (1.5, 2.0), (3.5, 2.0), (4.75, 0.5)]);
        let nodes = samples(cuts, SampleRule::Trapezoid, Order::FrontToBack);
        assert_eq!(nodes, [(0.0, 0.0), (0.5, 0.5), (2.5, 2.0), (4.5, 2.0), (5.0, 0.5)]);
        let nodes = samples(cuts, SampleRule::Trapezoid, Order::BackToFront);
        assert_eq!(nodes, [(5.0, 0.0), (4.5, 0.5), (2.5, 2.0), (0.5, 2.0), (0.0, 0.5)]);
    }

    #[test]
    fn lengths_add_up_to_the_ray_for_any_step() {
        for rule in [SampleRule::Left, SampleRule::Midpoint, SampleRule::Trapezoid] {
            for order in [Order::FrontToBack, Order::BackToFront] {
                for (first, step, length) in [
                    (1.0, 1.0, 7.0),
                    (0.3, 1.0, 7.0),
                    (1.0, 1.0, 7.3),
                    (9.0, 9.0, 7.0),
                    (3.0, 5.0, 7.0),
                    (0.1, 0.1, 1e3),
                ] {
                    let all = samples(Cuts::from_first(first, step, length), rule, order);
                    let sum: f64 = all.iter().map(|s| s.1).sum();
                    assert!((sum - length).abs() < 1e-9 * length, "{rule:?} {order:?} {step}: {sum} of {length}");
                    let sorted = all.windows(2).all(|w| (w[0].0 < w[1].0) == (order == Order::FrontToBack));
                    assert!(sorted, "{rule:?} {order:?}: {all:?}");
                }
            }
        }
    }

    #[test]
    fn whole_steps_end_where_the_next_would_leave_the_volume() {
        let places = |cuts: Cuts, order| samples(cuts, SampleRule::WholeSteps, order);
        let forwards = places(Cuts::from_first(2.0, 2.0, 7.0), Order::FrontToBack);
        assert_eq!(forwards, [(2.0, 2.0), (4.0, 2.0), (6.0, 2.0)], "nothing at the entry, and nothing for the rest");
        let backwards = places(Cuts::from_first(2.0, 2.0, 7.0), Order::BackToFront);
        assert_eq!(backwards, [(6.0, 2.0), (4.0, 2.0), (2.0, 2.0)]);
        assert_eq!(places(Cuts::from_first(2.0, 2.0, 6.0), Order::FrontToBack).len(), 3, "the exit itself is inside");
        assert_eq!(places(Cuts::from_first(2.0, 2.0, 0.5), Order::FrontToBack), [(2.0, 2.0)], "one in any case");
    }

    #[test]
    fn only_a_sample_behind_the_exit_is_beyond_the_volume() {
        // Through the edge where x and y begin, from (0.25, 0) to (0, 0.5): 1 mm of volume.
        let dims = [5, 9, 3];
        let (entry_index, index_per_mm) = (DVec3::new(0.25, 0.0, 1.0), DVec3::new(-0.25, 0.5, 0.0));
        let chord = Chord { entry_mm: 10.0, length_mm: 1.0, entry_index, index_per_mm };
        let beyond = |step_mm: f64, rule| {
            let cuts = Cuts::from_first(step_mm, step_mm, chord.length_mm);
            cuts.stretches(rule, Order::FrontToBack)[0].beyond_voxels(&chord, dims)
        };
        assert_eq!(
            beyond(3.0, SampleRule::WholeSteps),
            DVec3::new(-0.5, 0.0, 0.0),
            "2 mm behind, along y still inside"
        );
        assert_eq!(beyond(17.0, SampleRule::WholeSteps), DVec3::new(-4.0, 0.5, 0.0), "16 mm behind");
        assert_eq!(beyond(0.75, SampleRule::WholeSteps), DVec3::ZERO, "inside");
        assert_eq!(beyond(3.0, SampleRule::Midpoint), DVec3::ZERO, "other rules stay inside");
    }

    #[test]
    fn a_step_longer_than_the_ray_is_one_interval() {
        let cuts = Cuts::from_first(50.0, 50.0, 7.0);
        assert_eq!(samples(cuts, SampleRule::Midpoint, Order::FrontToBack), [(3.5, 7.0)]);
        assert_eq!(samples(cuts, SampleRule::Trapezoid, Order::FrontToBack), [(0.0, 0.0), (7.0, 7.0)]);
    }
}
