//! What was checked, and what came out.

use std::fmt;

use serde::Serialize;

/// What a check expects of its number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Expected {
    /// An order of convergence, both ends included.
    Order {
        /// Lowest.
        low: f64,
        /// Highest.
        high: f64,
    },
    /// An error, at most.
    AtMost(f64),
}

/// One row of the report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// What was verified, such as `march/midpoint`.
    pub subject: String,
    /// What of it.
    pub check: String,
    /// What it should be.
    pub expected: Expected,
    /// What it is; `null` in JSON if it is no finite number.
    pub measured: f64,
    /// `[size, error]` behind an order, coarse to fine.
    pub series: Vec<[f64; 2]>,
    /// Whether the measured number is as expected; never if it is not a number.
    pub pass: bool,
}

/// All rows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The rows, in the order they were checked.
    pub checks: Vec<Check>,
}

impl Expected {
    /// An order, to within `within`.
    pub fn order(order: f64, within: f64) -> Self {
        Expected::Order { low: order - within, high: order + within }
    }

    /// Whether a number is as expected. Comparisons with NaN are false, so NaN never is.
    pub fn holds(&self, measured: f64) -> bool {
        match *self {
            Expected::Order { low, high } => low <= measured && measured <= high,
            Expected::AtMost(most) => measured <= most,
        }
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Expected::Order { low, high } => write!(f, "order {low:.2} to {high:.2}"),
            Expected::AtMost(most) => write!(f, "at most {most:.1e}"),
        }
    }
}

impl Check {
    /// An error that may not exceed a number.
    pub fn error(subject: &str, check: impl Into<String>, most: f64, measured: f64) -> Self {
        let expected = Expected::AtMost(most);
        let pass = expected.holds(measured);
        Check { subject: subject.to_string(), check: check.into(), expected, measured, series: Vec::new(), pass }
    }

    /// The order of a series of `[size, error]`.
    pub fn order(subject: &str, check: impl Into<String>, expected: Expected, series: Vec<[f64; 2]>) -> Self {
        let measured = super::order(&series);
        let pass = expected.holds(measured);
        Check { subject: subject.to_string(), check: check.into(), expected, measured, series, pass }
    }

    /// The measured number as people read it: an order with the errors it was fitted to, or an error.
    pub fn measured_text(&self) -> String {
        match (self.expected, self.series.first(), self.series.last()) {
            (Expected::Order { .. }, Some(first), Some(last)) => {
                format!("{:.2} ({:.1e} to {:.1e})", self.measured, first[1], last[1])
            }
            (Expected::Order { .. }, ..) => format!("{:.2}", self.measured),
            (Expected::AtMost(_), ..) => format!("{:.1e}", self.measured),
        }
    }
}

impl Report {
    /// The rows that are not as expected.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(|check| !check.pass)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_never_passes() {
        for nan in [f64::NAN, f64::INFINITY] {
            assert!(!Check::error("x", "error", 1.0, nan).pass, "{nan} passed as an error");
        }
        let check = Check::order("x", "order", Expected::order(2.0, 0.1), vec![[1.0, 0.1], [0.5, f64::NAN]]);
        assert!(!check.pass, "passed with order {}", check.measured);
        assert!(!Check::order("x", "order", Expected::order(2.0, 0.1), vec![]).pass, "no series at all");
    }

    #[test]
    fn the_ends_of_what_is_expected_belong_to_it() {
        let expected = Expected::order(2.0, 0.25);
        assert!(expected.holds(1.75) && expected.holds(2.25) && !expected.holds(1.7) && !expected.holds(2.3));
        assert!(Expected::AtMost(0.0).holds(0.0) && !Expected::AtMost(0.0).holds(1e-300));
    }
}
