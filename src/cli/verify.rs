//! `pellucid verify`: whether the integrators of this build do what theory says.

use pellucid::verify::{Check, Report, verify};
use pellucid::{Error, Fault, Result};

use super::{Format, stdout};

/// Arguments of `pellucid verify`.
#[derive(Debug, clap::Args)]
pub(super) struct Verify {
    /// How it is printed
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

impl Verify {
    /// Prints all checks; an error if one failed.
    pub(super) fn run(&self) -> Result<()> {
        let report = verify()?;
        match self.format {
            Format::Text => stdout::print(&table(&report))?,
            Format::Json => stdout::print_json(&report)?,
        }
        refuse_failures(&report)
    }
}

fn refuse_failures(report: &Report) -> Result<()> {
    let failures: Vec<String> = report.failures().map(name).collect();
    if failures.is_empty() {
        return Ok(());
    }
    Err(Error::new(Fault::Tolerance, "the integrators are not as they should be")
        .found(format!("{} of {} checks failed: {}", failures.len(), report.checks.len(), failures.join("; ")))
        .expected("all checks to pass"))
}

fn name(check: &Check) -> String {
    format!("{}, {}", check.subject, check.check)
}

/// Four columns, as wide as their widest entry.
fn table(report: &Report) -> String {
    let mut rows = vec![["check", "expected", "measured", "pass"].map(String::from)];
    rows.extend(report.checks.iter().map(|check| {
        let pass = if check.pass { "yes" } else { "NO" };
        [name(check), check.expected.to_string(), check.measured_text(), pass.to_string()]
    }));
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths = [width(0), width(1), width(2)];
    let line = |row: &[String; 4]| {
        let [check, expected, measured, pass] = row;
        let [a, b, c] = widths;
        format!("{check:a$}  {expected:b$}  {measured:c$}  {pass}")
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> Report {
        Report { checks: vec![Check::error("a", "error", 1e-3, 5e-4), Check::error("b", "error", 1e-3, f64::NAN)] }
    }

    #[test]
    fn columns_stand_below_each_other() {
        assert_eq!(
            table(&report()),
            "check     expected        measured  pass\n\
             a, error  at most 1.0e-3  5.0e-4    yes\n\
             b, error  at most 1.0e-3  NaN       NO"
        );
    }

    #[test]
    fn a_check_that_failed_is_an_error_that_names_it() {
        let error = refuse_failures(&report()).unwrap_err();
        assert_eq!(error.fault().exit_code(), 9);
        assert!(error.to_string().contains("1 of 2 checks failed: b, error"), "{error}");
    }
}
