//! Time that may be spent.

use std::time::{Duration, Instant};

/// An end of the time for something.
#[derive(Debug, Clone, Copy)]
pub(super) struct Deadline {
    at: Instant,
}

impl Deadline {
    /// So long from now.
    pub(super) fn after(time: Duration) -> Self {
        Deadline { at: Instant::now() + time }
    }

    /// The end of a share, from 0 to 1, of what is left until then.
    pub(super) fn share(self, share: f64) -> Self {
        Deadline::after(self.left().mul_f64(share))
    }

    /// Time until then; zero once it has passed.
    pub(super) fn left(self) -> Duration {
        self.at.saturating_duration_since(Instant::now())
    }

    /// Whether something that takes so many seconds would be done by then.
    pub(super) fn allows(self, seconds: f64) -> bool {
        seconds <= self.left().as_secs_f64()
    }
}

/// What work gives, and the seconds it took.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let result = work();
    (result, begun.elapsed().as_secs_f64())
}

/// The middle of some numbers, the mean of the two middle ones of an even number; NaN for none.
pub(super) fn median(numbers: &[f64]) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    match (sorted.len(), sorted.len() / 2) {
        (0, _) => f64::NAN,
        (n, middle) if n % 2 == 1 => sorted[middle],
        (_, middle) => 0.5 * (sorted[middle - 1] + sorted[middle]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(&[3.0, 1.0, 100.0]), 3.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 100.0]), 3.0);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn time_that_has_passed_allows_nothing() {
        let passed = Deadline::after(Duration::ZERO);
        assert!(!passed.allows(1e-9) && passed.share(0.5).left() == Duration::ZERO);
        let ahead = Deadline::after(Duration::from_secs(1000));
        assert!(ahead.allows(900.0) && !ahead.allows(1001.0) && !ahead.share(0.5).allows(501.0));
    }
}
