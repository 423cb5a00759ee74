//! `pellucid explain`: the plan of a pipeline, in words or as JSON.

use pellucid::Result;
use pellucid::pipeline;
use pellucid::plan::{StackPlan, explain, explain_json};
use pellucid::simd::Level;
use pellucid::spec::Document;

use super::{Format, PipelineArguments, stdout};

/// Arguments of `pellucid explain`.
#[derive(Debug, clap::Args)]
pub(super) struct Explain {
    #[command(flatten)]
    pipeline: PipelineArguments,

    /// How the plan is printed
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

impl Explain {
    /// Prints the plan; reads the scan, since a plan is for one volume, and renders nothing.
    pub(super) fn run(&self) -> Result<()> {
        let spec = match Document::load(&self.pipeline.pipeline, &self.pipeline.overrides())? {
            Document::Scan(spec) => spec,
            Document::Stack(stack) => {
                let plan = StackPlan::new(&stack, None)?;
                return match self.format {
                    Format::Text => stdout::print(&plan.explain()),
                    Format::Json => stdout::print_json(&plan.explain_json()),
                };
            }
        };
        let options = self.pipeline.options(None);
        let scan = pipeline::load(&spec, &options)?;
        let plan = pipeline::settled_plan(&spec, scan, &options)?;
        let level = options.level.unwrap_or_else(Level::widest);
        match self.format {
            Format::Text => stdout::print(&format!("{}\nregisters: {level}\n", explain(&plan).trim_end())),
            Format::Json => {
                let mut json = explain_json(&plan);
                json["registers"] = level.to_string().into();
                stdout::print_json(&json)
            }
        }
    }
}
