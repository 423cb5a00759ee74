//! `pellucid schema`: the JSON Schema of what may be written, for editors.

use clap::ValueEnum;
use pellucid::Result;
use pellucid::spec::{pipeline_schema, preset_schema, stack_schema};

use super::stdout;

/// Arguments of `pellucid schema`.
#[derive(Debug, clap::Args)]
pub(super) struct Schema {
    /// Of which kind of file
    #[arg(value_enum, default_value_t = Kind::Pipeline)]
    kind: Kind,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    Pipeline,
    Preset,
    Stack,
}

impl Schema {
    /// Prints the schema.
    pub(super) fn run(&self) -> Result<()> {
        stdout::print_json(&match self.kind {
            Kind::Pipeline => pipeline_schema(),
            Kind::Preset => preset_schema(),
            Kind::Stack => stack_schema(),
        })
    }
}
