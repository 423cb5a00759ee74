//! The exact integrator on real scans, every pixel against the oracle: a table of errors, bounds and times.
//!
//! `cargo run --release --example accuracy -- DATA_FOLDER [--size 256] [--scenes WORD,…] [--skull DIR] [--out FILE]`
//!
//! Rows are written as they finish, so that a run that is cut off keeps what it has. Exit code 1 if a tolerance of 1e-3 or
//! more is exceeded anywhere, or the bound of an unshaded pixel.
#![allow(clippy::print_stderr, reason = "progress of a program that is run by hand")]

mod functions;
mod measure;
mod scans;
mod table;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use pellucid::Result;

use functions::{FUNCTIONS, scene};
use measure::{Truth, measure};
use table::Table;

/// Tolerances, as they are written and as numbers.
const TOLERANCES: [(&str, f64); 3] = [("1/255", 1.0 / 255.0), ("1e-3", 1e-3), ("1e-4", 1e-4)];

/// Measure the exact integrator against the oracle on public scans
#[derive(Debug, Parser)]
struct Arguments {
    /// The folder of public scans
    data: PathBuf,

    /// Pixels along a side of the picture
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u16).range(1..=4096))]
    size: u16,

    /// Only scenes whose name holds one of these words, such as `tooth,bone`; all unless told
    #[arg(long, value_delimiter = ',')]
    scenes: Vec<String>,

    /// The unpacked folder of the skull phantom
    #[arg(long, value_name = "DIR")]
    skull: Option<PathBuf>,

    /// The table
    #[arg(long, default_value = "tests/accuracy/RESULTS.md")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => {
            eprintln!("a tolerance or a bound was exceeded: see {}", arguments.out.display());
            ExitCode::from(1)
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.fault().exit_code())
        }
    }
}

/// True if everything that is promised was kept.
fn run(arguments: &Arguments) -> Result<bool> {
    let mut table = Table::begin(&arguments.out, usize::from(arguments.size))?;
    let mut kept = true;
    for source in scans::sources(&arguments.data, arguments.skull.as_deref()) {
        let wanted: Vec<_> = FUNCTIONS
            .iter()
            .flat_map(|function| [(function, false), (function, true)])
            .map(|(function, shaded)| (name(source.name, function.name, shaded), function, shaded))
            .filter(|(name, ..)| {
                arguments.scenes.is_empty() || arguments.scenes.iter().any(|w| name.contains(w.as_str()))
            })
            .collect();
        if wanted.is_empty() {
            continue;
        }
        eprintln!("{}: reading {}", source.name, source.path.display());
        let volume = source.load()?;
        for (name, function, shaded) in wanted {
            let scene = scene(&volume, function, shaded, usize::from(arguments.size))?;
            let truth = Truth::compute(&volume, &scene);
            eprintln!("{name}: oracle in {:.1} s", truth.seconds);
            for (written, tolerance) in TOLERANCES {
                let row = measure(&volume, &scene, &truth, tolerance);
                eprintln!("{name} at {written}: error {:.2e}, {:.2} of the bound", row.max_error, row.max_of_bound);
                kept &= row.keeps_its_promise(tolerance, shaded);
                table.append(&name, written, &row, truth.seconds)?;
            }
        }
    }
    Ok(kept)
}

fn name(scan: &str, function: &str, shaded: bool) -> String {
    format!("{scan}, {function}, {}", if shaded { "shaded" } else { "unshaded" })
}
