//! The table, in Markdown, written row by row.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use pellucid::{Error, Fault, Result};

use super::measure::Row;

/// A table on disk that grows.
pub(crate) struct Table {
    file: File,
    path: PathBuf,
}

impl Table {
    /// Replaces what was there by a header.
    pub(crate) fn begin(path: &Path, size: usize) -> Result<Self> {
        let file = File::create(path).map_err(|cause| not_written(path, cause))?;
        let mut table = Table { file, path: path.to_path_buf() };
        let threads = rayon::current_num_threads();
        table.write(&format!(
            "# Accuracy of the exact integrator\n\n\
             Every pixel of a {size} x {size} picture by the exact integrator (in f64 where it finds f32 too coarse) against the oracle: largest error of a channel, linear\n\
             and premultiplied. Made by `cargo run --release --example accuracy`, pellucid {}.\n\n\
             Machine: {}, {threads} threads. Date: {}.\n\n\
             | scene | tolerance | max error | max error / bound | above tolerance | above bound | pixels | exact, s | oracle, s |\n\
             |---|---|---|---|---|---|---|---|---|\n",
            env!("CARGO_PKG_VERSION"),
            processor(),
            today(),
        ))?;
        Ok(table)
    }

    /// Adds a row, and hands it to the disk.
    pub(crate) fn append(&mut self, scene: &str, tolerance: &str, row: &Row, oracle_seconds: f64) -> Result<()> {
        let Row { max_error, max_of_bound, above_tolerance, above_bound, pixels, seconds } = row;
        self.write(&format!(
            "| {scene} | {tolerance} | {max_error:.2e} | {max_of_bound:.2} | {above_tolerance} | {above_bound} | {pixels} \
             | {seconds:.2} | {oracle_seconds:.1} |\n"
        ))
    }

    fn write(&mut self, text: &str) -> Result<()> {
        let written = self.file.write_all(text.as_bytes()).and_then(|()| self.file.sync_data());
        written.map_err(|cause| not_written(&self.path, cause))
    }
}

fn not_written(path: &Path, cause: std::io::Error) -> Error {
    Error::new(Fault::Output, "the table could not be written").at(path).caused_by(cause)
}

/// The processor's name where the system tells it, else its architecture.
fn processor() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = told.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_string(), |(_, name)| name.trim().to_string())
}

/// The date in UTC, year-month-day: days since 1970 in the proleptic Gregorian calendar, counted from March (Hinnant,
/// `civil_from_days`).
fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let days = seconds / 86_400 + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day_of_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day_of_month = day_of_year - (153 * month + 2) / 5 + 1;
    let (year, month) = if month < 10 { (year + 400 * era, month + 3) } else { (year + 400 * era + 1, month - 9) };
    format!("{year:04}-{month:02}-{day_of_month:02}")
}
