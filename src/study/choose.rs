//! Which of several measured settings is the right one. Nothing here measures: the same measurements give the same choice.

use serde::Serialize;

use super::ladder::{Rung, exact};
use crate::plan::Method;

/// How much of a tolerance the largest error of a sample may take where no bound is proven: the largest error of all pixels
/// is larger than that of some.
const SHARE_OF_TOLERANCE: f64 = 0.5;

/// What is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// The quickest setting whose error, linear and premultiplied, is at most this: by its bound, or, where it has none,
    /// with [`Candidate::room`] to spare.
    Tolerance(f64),
    /// The most accurate setting that takes at most so many seconds.
    Seconds(f64),
}

/// A setting with what was measured of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Candidate {
    /// The setting.
    #[serde(flatten)]
    pub rung: Rung,
    /// Seconds for the whole picture.
    pub seconds: f64,
    /// Largest error found.
    pub largest_error: f64,
}

impl Candidate {
    /// The largest error of a sample with which the setting counts as within a tolerance: all of it for the exact integrator at
    /// that tolerance or a smaller one, whose bound holds for every pixel; half of it for all else.
    pub fn room(&self, tolerance: f64) -> f64 {
        match self.rung.method {
            Method::Exact(exact) if exact.tolerance <= tolerance => tolerance,
            _ => SHARE_OF_TOLERANCE * tolerance,
        }
    }
}

/// What was chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum Chosen<'a> {
    /// A candidate that is as wanted.
    Meets(&'a Candidate),
    /// No candidate keeps the tolerance as measured; the exact integrator does, by its bound.
    Proven(Rung),
    /// No candidate is within the time; this is the quickest.
    Quickest(&'a Candidate),
}

/// Chooses among candidates; `None` for a time and no candidate at all. Numbers that are not finite meet nothing. Of two
/// equally good candidates the more accurate is chosen, then the quicker, then the first.
pub fn choose(candidates: &[Candidate], target: Target) -> Option<Chosen<'_>> {
    let usable = || candidates.iter().filter(|c| c.seconds.is_finite() && c.largest_error.is_finite());
    let quickest = |a: &&Candidate, b: &&Candidate| {
        a.seconds.total_cmp(&b.seconds).then(a.largest_error.total_cmp(&b.largest_error))
    };
    let most_accurate = |a: &&Candidate, b: &&Candidate| {
        a.largest_error.total_cmp(&b.largest_error).then(a.seconds.total_cmp(&b.seconds))
    };
    match target {
        Target::Tolerance(most) => {
            let within = usable().filter(|c| c.largest_error <= c.room(most)).min_by(quickest);
            Some(within.map_or_else(|| Chosen::Proven(exact(most)), Chosen::Meets))
        }
        Target::Seconds(most) => {
            let within = usable().filter(|c| c.seconds <= most).min_by(most_accurate);
            within.map(Chosen::Meets).or_else(|| usable().min_by(quickest).map(Chosen::Quickest))
        }
    }
}

impl Chosen<'_> {
    /// The setting.
    pub fn rung(&self) -> &Rung {
        match self {
            Chosen::Meets(candidate) | Chosen::Quickest(candidate) => &candidate.rung,
            Chosen::Proven(rung) => rung,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Exact, Method};
    use crate::study::ladder::ladder;

    /// Candidates with these seconds and errors, each of another setting.
    fn candidates(numbers: &[[f64; 2]]) -> Vec<Candidate> {
        let of = |(rung, &[seconds, largest_error]): (Rung, &[f64; 2])| Candidate { rung, seconds, largest_error };
        ladder(1.0).into_iter().zip(numbers).map(of).collect()
    }

    /// Which candidate is chosen as wanted.
    fn met(numbers: &[[f64; 2]], target: Target) -> Option<usize> {
        let candidates = candidates(numbers);
        match choose(&candidates, target)? {
            Chosen::Meets(chosen) => candidates.iter().position(|c| c == chosen),
            Chosen::Proven(_) | Chosen::Quickest(_) => None,
        }
    }

    #[test]
    fn the_quickest_that_keeps_the_tolerance() {
        let numbers = [[0.1, 0.2], [3.0, 1e-4], [1.0, 4e-3], [2.0, 1e-3], [0.5, 5e-3]];
        assert_eq!(met(&numbers, Target::Tolerance(8e-3)), Some(2), "an error at half of the tolerance keeps it");
        assert_eq!(met(&numbers, Target::Tolerance(7.9e-3)), Some(3), "more than half may be too much elsewhere");
        assert_eq!(met(&numbers, Target::Tolerance(1.0)), Some(0));
    }

    #[test]
    fn what_is_only_measured_needs_room_and_what_is_proven_does_not() {
        let candidate = |rung: Rung| Candidate { rung, seconds: 1.0, largest_error: 3.7e-3 };
        let within = |rung: Rung| {
            let candidates = [candidate(rung)];
            matches!(choose(&candidates, Target::Tolerance(3.9e-3)), Some(Chosen::Meets(_)))
        };
        assert!(!within(ladder(1.0)[0].clone()), "a march at 95 % of the tolerance on a sample");
        assert!(within(exact(3.9e-3)), "the exact integrator at this tolerance, by its bound");
        assert!(within(exact(1e-3)), "the exact integrator at a smaller one");
        assert!(!within(exact(1e-2)), "the exact integrator at a larger one, whose bound says nothing here");
    }

    #[test]
    fn the_most_accurate_within_the_time() {
        let numbers = [[0.1, 0.2], [3.0, 1e-4], [1.0, 4e-3], [2.0, 1e-3]];
        assert_eq!(met(&numbers, Target::Seconds(2.0)), Some(3), "a time at the limit is within it");
        assert_eq!(met(&numbers, Target::Seconds(1.9)), Some(2));
        assert_eq!(met(&numbers, Target::Seconds(60.0)), Some(1));
    }

    #[test]
    fn of_equals_the_better_in_the_other_respect_and_then_the_first() {
        assert_eq!(met(&[[1.0, 2e-3], [1.0, 1e-3], [1.0, 1e-3]], Target::Tolerance(0.01)), Some(1));
        assert_eq!(met(&[[2.0, 1e-3], [1.0, 1e-3], [1.0, 1e-3]], Target::Seconds(5.0)), Some(1));
    }

    #[test]
    fn what_nothing_measured_keeps_the_exact_integrator_proves() {
        let measured = candidates(&[[0.1, 0.2], [1.0, 0.01]]);
        for candidates in [&measured[..], &[]] {
            let chosen = choose(candidates, Target::Tolerance(1e-3)).expect("there is always the exact integrator");
            assert_eq!(chosen.rung().method, Method::Exact(Exact::within(1e-3)), "found {chosen:?}");
            assert!(matches!(chosen, Chosen::Proven(_)), "found {chosen:?}");
        }
    }

    #[test]
    fn without_time_the_quickest_is_chosen_and_said_to_be_too_slow() {
        let measured = candidates(&[[2.0, 1e-3], [1.0, 0.1], [1.0, 0.05]]);
        let chosen = choose(&measured, Target::Seconds(0.5));
        assert_eq!(chosen, Some(Chosen::Quickest(&measured[2])));
        assert_eq!(choose(&[], Target::Seconds(0.5)), None, "nothing was measured");
    }

    #[test]
    fn what_is_no_number_is_never_chosen() {
        let numbers = [[f64::NAN, 1e-6], [0.1, f64::NAN], [0.2, f64::INFINITY], [1.0, 1e-3]];
        assert_eq!(met(&numbers, Target::Tolerance(0.01)), Some(3));
        assert_eq!(met(&numbers, Target::Seconds(10.0)), Some(3));
        assert_eq!(met(&numbers[..3], Target::Tolerance(0.01)), None);
    }
}
