//! The command line: one file per command, each from its arguments to what it prints.
//!
//! stdout is the result and nothing else; logs, progress and summaries are on stderr. Exit codes follow from
//! [`pellucid::Fault`]; 2 is clap's, for a command line that cannot be read.

mod classify;
mod compare;
mod completions;
mod evaluate;
mod explain;
mod export_vtk;
mod histogram;
mod info;
mod phantom;
mod presets;
mod progress;
mod render;
pub(crate) mod report;
mod schema;
mod stderr;
mod stdout;
mod study;
mod table;
mod verify;

use std::path::PathBuf;

use bytesize::ByteSize;
use clap::{Args, Parser, Subcommand, ValueEnum};
use pellucid::pipeline::Options;
use pellucid::simd::Level;
use pellucid::{Error, Fault, Result};

/// CT volume rendering with a known error: a scan and a YAML pipeline in, a picture within a tolerance out.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(flatten)]
    global: Global,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Options of every command")]
struct Global {
    /// Threads to compute with; all cores unless told. The picture does not depend on it
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,

    /// Say only what went wrong
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,

    /// Say more; twice for every detail
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    verbose: u8,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render the picture that a pipeline describes
    Render(render::Render),
    /// Print what a pipeline would do, what it would not, and why
    Explain(explain::Explain),
    /// Label the tissues of a scan by the presets that picture them, and measure them
    Classify(classify::Classify),
    /// Compare labels with a reference: overlap, distances, and what was possible
    Evaluate(evaluate::Evaluate),
    /// Draw the joint histogram of value and gradient magnitude, with the widgets of presets over it
    Histogram(histogram::Histogram),
    /// Print what is in a scan: series, geometry, values, and what became of each file
    Info(info::Info),
    /// Write a synthetic CT scan whose every value is known by formula
    Phantom(phantom::Phantom),
    /// List, print, check, import and export transfer functions
    Presets(presets::Presets),
    /// Print the JSON Schema of pipelines or presets, for editors
    Schema(schema::Schema),
    /// Compare two pictures, each a file or what a pipeline renders
    Compare(compare::Compare),
    /// Write a Python script that renders a pipeline's scene with VTK
    ExportVtk(export_vtk::ExportVtk),
    /// Measure what accuracy costs in time: settings against the oracle, choice by choice
    Study(study::Study),
    /// Verify the integrators: orders of convergence, errors against the truth, identities
    Verify(verify::Verify),
    /// Print a completion script for a shell
    Completions(completions::Completions),
}

/// A pipeline with overrides, as `render` and `explain` take it.
#[derive(Debug, Args)]
struct PipelineArguments {
    /// The pipeline, a YAML file
    pipeline: PathBuf,

    /// Set a key of the pipeline, such as `camera.azimuth=25`; the value is YAML. May be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// Size of the picture in pixels, short for `--set image.size=[W,H]`
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,

    /// Most memory to take, such as 4GB or 512MiB; 80 % of what is free unless told
    #[arg(long, value_name = "BYTES")]
    max_memory: Option<ByteSize>,

    /// Registers to compute with: scalar, avx2 or avx512; the widest that the processor has unless told. The picture does not
    /// depend on it
    #[arg(long, value_name = "LEVEL")]
    simd: Option<Level>,
}

impl PipelineArguments {
    /// The overrides in the order in which they apply.
    fn overrides(&self) -> Vec<String> {
        let size = self.size.map(|[w, h]| format!("image.size=[{w}, {h}]"));
        self.set.iter().cloned().chain(size).collect()
    }

    /// What is not written in the pipeline.
    fn options(&self, output: Option<PathBuf>) -> Options {
        Options { output, max_memory_bytes: self.max_memory.map(|most| most.as_u64()), level: self.simd }
    }
}

/// How a result is printed: for people or for programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// Does what the command line says.
///
/// # Errors
/// Whatever stopped it; the exit code follows from the fault.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Arguments { global, command } = arguments;
    stderr::start_log(global.quiet, global.verbose);
    limit_threads(global.threads)?;
    match command {
        Command::Render(command) => command.run(global),
        Command::Explain(command) => command.run(),
        Command::Classify(command) => command.run(global),
        Command::Evaluate(command) => command.run(global),
        Command::Histogram(command) => command.run(global),
        Command::Info(command) => command.run(),
        Command::Phantom(command) => command.run(),
        Command::Presets(command) => command.run(),
        Command::Schema(command) => command.run(),
        Command::Compare(command) => command.run(global),
        Command::ExportVtk(command) => command.run(),
        Command::Study(command) => command.run(global),
        Command::Verify(command) => command.run(),
        Command::Completions(command) => command.run(),
    }
}

fn limit_threads(threads: Option<u16>) -> Result<()> {
    let Some(threads) = threads else { return Ok(()) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads));
    pool.build_global().map_err(|cause| {
        Error::new(Fault::Limit, "the threads could not be started")
            .element("--threads")
            .found(threads.to_string())
            .remedy("ask for fewer threads")
            .caused_by(cause)
    })
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some([w.trim().parse().ok()?, h.trim().parse().ok()?]));
    match sides {
        Some([w, h]) if w > 0 && h > 0 => Ok([w, h]),
        _ => Err("expected WIDTHxHEIGHT in pixels, such as 512x512".to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn overrides_keep_their_order_and_values_may_hold_equal_signs() {
        let read = Arguments::try_parse_from([
            "pellucid", "render", "p.yaml", "--set", "a.b=c=d", "--size", "640x480", "--set", "x=1",
        ]);
        let Command::Render(render) = read.expect("a valid command line").command else { panic!("not render") };
        assert_eq!(render.pipeline.overrides(), ["a.b=c=d", "x=1", "image.size=[640, 480]"]);
    }

    #[test]
    fn sizes_that_are_none_are_refused() {
        for wrong in ["512", "0x4", "4x0", "axb", "-1x4", "4x4x4"] {
            assert!(size(wrong).is_err(), "{wrong} is no size");
        }
        assert_eq!(size("640x480"), Ok([640, 480]));
    }
}
