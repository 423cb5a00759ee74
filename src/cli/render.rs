//! `pellucid render`: a pipeline to a picture and its sidecar.

use std::path::PathBuf;

use pellucid::Result;
use pellucid::pipeline::{self, Certificate, Outcome, Sidecar};
use pellucid::spec::Document;

use super::progress::Bar;
use super::{Global, PipelineArguments, stderr, stdout};

/// Arguments of `pellucid render`.
#[derive(Debug, clap::Args)]
pub(super) struct Render {
    #[command(flatten)]
    pub(super) pipeline: PipelineArguments,

    /// The picture to write, .png or .exr; that of the pipeline unless told
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Recompute N random pixels by the oracle and state the error; short for `--set certify=N`
    #[arg(long, value_name = "N")]
    certify: Option<u32>,
}

impl Render {
    /// Renders; the picture's path goes to stdout, what it took to stderr.
    pub(super) fn run(&self, global: &Global) -> Result<()> {
        let mut overrides = self.pipeline.overrides();
        overrides.extend(self.certify.map(|count| format!("certify={count}")));
        let bar = Bar::new(global.quiet);
        let options = self.pipeline.options(self.output.clone());
        let spec = match Document::load(&self.pipeline.pipeline, &overrides)? {
            Document::Scan(spec) => spec,
            Document::Stack(stack) => {
                let outcome = pipeline::composite(&stack, &options, &|event| bar.hear(event));
                bar.clear();
                let outcome = outcome?;
                if !global.quiet {
                    stderr::say(&format!("how it was made: {}", outcome.sidecar_path.display()));
                }
                return stdout::print(&outcome.picture.display().to_string());
            }
        };
        let outcome = pipeline::run(&spec, &options, &|event| bar.hear(event));
        bar.clear();
        let outcomes = outcome?;
        for (view, outcome) in outcomes.iter().enumerate() {
            if !global.quiet {
                stderr::say(&if view == 0 { summary(outcome) } else { further(outcome) });
            }
            stdout::print(&outcome.picture.display().to_string())?;
        }
        Ok(())
    }
}

/// What a further view took.
fn further(outcome: &Outcome) -> String {
    let sidecar = &outcome.sidecar;
    let lines = std::iter::once(times(sidecar)).chain(sidecar.certificate.iter().map(certified));
    lines.collect::<Vec<_>>().join("\n")
}

fn times(sidecar: &Sidecar) -> String {
    let times: Vec<String> = sidecar.stages.iter().map(|s| format!("{} {:.2} s", s.stage, s.seconds)).collect();
    times.join(", ")
}

fn certified(c: &Certificate) -> String {
    let [largest, most, rms] = [c.largest_error, c.error_of_999_in_1000, c.rms_error];
    format!("{}; largest error {largest:.2e}, 99.9 % below {most:.2e}, RMS {rms:.2e}", c.statement)
}

/// What a picture took, in a few lines.
fn summary(outcome: &Outcome) -> String {
    let sidecar = &outcome.sidecar;
    let memory = sidecar.peak_memory_bytes.map(|bytes| format!(", at most {} MB of memory", bytes / 1_000_000));
    let clipped = &sidecar.clipped;
    let chosen = sidecar.choice.iter().map(|c| format!("integrate: {}: {}", c.rung.setting, c.because));
    let mut lines: Vec<String> = chosen.collect();
    lines.extend([
        times(sidecar),
        format!("{} on {} threads{}", sidecar.method.kernel, sidecar.threads, memory.unwrap_or_default()),
        format!("{} of {} voxels below the window, {} above", clipped.below, clipped.voxels, clipped.above),
    ]);
    lines.extend(sidecar.certificate.iter().map(certified));
    lines.extend(sidecar.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.push(format!("how it was made: {}", outcome.sidecar_path.display()));
    lines.join("\n")
}
