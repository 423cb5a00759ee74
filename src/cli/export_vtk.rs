//! `pellucid export-vtk`: a pipeline's scene as a Python script that renders it with VTK.

use std::path::PathBuf;

use pellucid::Result;
use pellucid::interchange::vtk;
use pellucid::pipeline::{self, Options};
use pellucid::spec::Spec;

use super::{PipelineArguments, stdout};

/// Arguments of `pellucid export-vtk`.
#[derive(Debug, clap::Args)]
pub(super) struct ExportVtk {
    #[command(flatten)]
    pipeline: PipelineArguments,

    /// The folder for the script and the numbers it reads; made if it is not there
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
}

impl ExportVtk {
    /// Writes the folder; the script's path goes to stdout.
    pub(super) fn run(&self) -> Result<()> {
        let spec = Spec::load(&self.pipeline.pipeline, &self.pipeline.overrides())?;
        let scan = pipeline::load(&spec, &pipeline::Options::default())?;
        let plan = pipeline::plan(&spec, &scan, &Options::default())?;
        let script = vtk::export(&self.output, &scan.volume, &plan)?;
        stdout::print(&script.display().to_string())
    }
}
