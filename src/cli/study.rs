//! `pellucid study`: what accuracy costs in time, on a pipeline's scene.

use std::path::PathBuf;
use std::time::Duration;

use pellucid::Result;
use pellucid::interchange::vtk::Mapper;
use pellucid::pipeline::{self, VtkPeer};
use pellucid::spec::Spec;
use pellucid::study::{Report, Settings};

use super::progress::Bar;
use super::{Format, Global, PipelineArguments, stderr, stdout};

/// Arguments of `pellucid study`.
#[derive(Debug, clap::Args)]
pub(super) struct Study {
    #[command(flatten)]
    pipeline: PipelineArguments,

    /// The folder for tables, chart and maps of errors; made if it is not there
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,

    /// Time for measuring; more time is more settings and more repeats
    #[arg(long, value_name = "N", default_value_t = 60.0, value_parser = seconds)]
    seconds: f64,

    /// The error to stay below, such as 1/255: a line in the chart, and the tolerance where choices are measured
    #[arg(long, value_name = "T", default_value = "1/255", value_parser = tolerance)]
    tolerance: f64,

    /// Most random pixels that the oracle computes
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(1..))]
    pixels: u32,

    /// Other programs to measure on the same scene: VTK by its fixed-point mapper on the CPU, or by its GPU mapper
    #[arg(long, value_enum, value_delimiter = ',', value_name = "PEER,…")]
    peers: Vec<PeerName>,

    /// The Python that has vtk and numpy
    #[arg(long, value_name = "PROGRAM", default_value = "python3", requires = "peers")]
    python: PathBuf,

    /// How the result is printed
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Another program, as it is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum PeerName {
    Vtk,
    VtkGpu,
}

impl PeerName {
    fn mapper(self) -> Mapper {
        match self {
            PeerName::Vtk => Mapper::Cpu,
            PeerName::VtkGpu => Mapper::Gpu,
        }
    }
}

impl Study {
    /// Measures, writes the folder and prints the tables, or all numbers; what was written goes to stderr.
    pub(super) fn run(&self, global: &Global) -> Result<()> {
        let spec = Spec::load(&self.pipeline.pipeline, &self.pipeline.overrides())?;
        let settings = Settings {
            time: Duration::from_secs_f64(self.seconds),
            tolerance: self.tolerance,
            pixels: self.pixels as usize,
            room_for_f32: true,
        };
        let peers: Vec<VtkPeer> =
            self.peers.iter().map(|peer| VtkPeer { python: self.python.clone(), mapper: peer.mapper() }).collect();
        let bar = Bar::new(global.quiet);
        let study = pipeline::study(&spec, &self.pipeline.options(None), &settings, &peers, &|what, share| {
            bar.spend(what, share)
        });
        bar.clear();
        let study = study?;
        let paths = pipeline::write_study(&study, &self.output)?;
        if !global.quiet {
            let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
            stderr::say(&format!("written: {}", names.join(", ")));
        }
        match self.format {
            Format::Text => stdout::print(&Report(&study).markdown()),
            Format::Json => stdout::print(&Report(&study).json()?),
        }
    }
}

/// Up to a day.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|s| (0.0..=86_400.0).contains(s));
    seconds.ok_or_else(|| "expected seconds, at most those of a day".to_string())
}

fn tolerance(text: &str) -> Result<f64, String> {
    let value = super::compare::number(text)?;
    if value > 0.0 && value < 1.0 { Ok(value) } else { Err("expected a number above 0 and below 1".to_string()) }
}
