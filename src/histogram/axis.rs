//! Equal bins.

use serde::Serialize;

use crate::error::{Error, Fault, Result};

/// Most bins of an axis: a joint histogram of this many has 8 MiB of counts.
pub const MOST_BINS: usize = 1024;

/// Equal bins from `low` to `high`: bin `n` is `[e_n, e_n+1)` with `e_n = low + n · ((high − low) / bins)`, but the last ends at
/// `high`, and holds it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Axis {
    low: f64,
    high: f64,
    bins: usize,
}

impl Axis {
    /// So many equal bins between two numbers.
    ///
    /// # Errors
    /// `Fault::Spec` unless both are finite and the lower comes first, for bins too narrow for numbers to differ in them, and
    /// for none or more than [`MOST_BINS`].
    pub fn new([low, high]: [f64; 2], bins: usize) -> Result<Self> {
        let axis = Axis { low, high, bins };
        if !(low.is_finite() && high.is_finite() && low < high && (high - low).is_finite()) {
            return Err(Error::new(Fault::Spec, "the axis of the histogram is empty")
                .found(format!("from {low} to {high}"))
                .expected("two finite numbers, the lower first"));
        }
        if !(1..=MOST_BINS).contains(&bins) {
            return Err(Error::new(Fault::Spec, "a histogram cannot have so many bins")
                .found(bins.to_string())
                .expected(format!("1 to {MOST_BINS} along each axis")));
        }
        if (0..bins).any(|n| axis.edge(n) >= axis.edge(n + 1)) {
            return Err(Error::new(Fault::Spec, "the bins of the histogram are narrower than numbers are apart")
                .found(format!("{bins} bins from {low} to {high}"))
                .remedy("ask for fewer bins, or a wider range"));
        }
        Ok(axis)
    }

    /// Lower end.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// Upper end.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Number of bins.
    pub fn bins(&self) -> usize {
        self.bins
    }

    /// Where bin `n` begins, and bin `n - 1` ends.
    pub fn edge(&self, n: usize) -> f64 {
        if n == self.bins { self.high } else { self.low + n as f64 * self.step() }
    }

    /// The bin that holds `x`, if any does.
    pub fn bin(&self, x: f64) -> Option<usize> {
        // Not so for a NaN either.
        if !(self.low <= x && x <= self.high) {
            return None;
        }
        let mut n = (((x - self.low) / self.step()) as usize).min(self.bins - 1);
        // The quotient is rounded; the edges decide.
        while x < self.edge(n) {
            n -= 1;
        }
        while n + 1 < self.bins && x >= self.edge(n + 1) {
            n += 1;
        }
        Some(n)
    }

    fn step(&self) -> f64 {
        (self.high - self.low) / self.bins as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_are_half_open_and_the_last_is_closed() {
        let axis = Axis::new([-1.0, 1.0], 4).expect("a valid axis");
        let found = [-1.1, -1.0, -0.5, -0.25, 0.5, 0.999, 1.0, 1.001, f64::NAN].map(|x| axis.bin(x));
        assert_eq!(found, [None, Some(0), Some(1), Some(1), Some(3), Some(3), Some(3), None, None]);
    }

    #[test]
    fn an_edge_belongs_to_the_bin_that_begins_there_however_it_is_rounded() {
        for (ends, bins) in [([0.0, 0.7], 7), ([-1024.0, 3071.0], 256), ([0.1, 0.3], 1000), ([1e8, 1e8 + 1.0], 1024)] {
            let axis = Axis::new(ends, bins).expect("a valid axis");
            for n in 0..bins {
                assert_eq!(axis.bin(axis.edge(n)), Some(n), "edge {n} of {axis:?}");
                let below = axis.edge(n).next_down();
                assert_eq!(axis.bin(below), n.checked_sub(1), "just below edge {n} of {axis:?}");
            }
        }
    }

    #[test]
    fn what_is_no_axis_is_refused() {
        for (ends, bins) in [
            ([1.0, 1.0], 4),
            ([2.0, 1.0], 4),
            ([0.0, f64::NAN], 4),
            ([0.0, f64::INFINITY], 4),
            ([f64::MIN, f64::MAX], 4),
            ([0.0, 1.0], 0),
            ([0.0, 1.0], MOST_BINS + 1),
            ([1e16, 1e16 + 2.0], 8),
        ] {
            let error = Axis::new(ends, bins).expect_err("no axis");
            assert_eq!(error.fault(), Fault::Spec, "{ends:?} in {bins}: {error}");
        }
    }
}
