//! A pipeline's scene as the user's own VTK renders it.

use std::path::{Path, PathBuf};
use std::process::Command;

use pellucid::image::Image;
use pellucid::interchange::vtk;
use pellucid::io::picture;
use pellucid::pipeline::{self, Options};
use pellucid::spec::Spec;
use pellucid::{Error, Fault, Result};

use super::side::Side;

/// What the script ends with where a mapper has no equal of the scene.
const NO_EQUAL: i32 = 3;

/// Where VTK is, and which of its renderers is asked.
#[derive(Debug, clap::Args)]
pub(super) struct LiveVtk {
    /// Hold the pipeline against VTK's picture of its scene, rendered now; needs Python with vtk and numpy
    #[arg(long)]
    vtk: bool,

    /// The Python that has vtk and numpy
    #[arg(long, value_name = "PROGRAM", default_value = "python3", requires = "vtk")]
    python: PathBuf,

    /// Which of VTK's renderers: the GPU mapper, or the fixed-point mapper on the CPU
    #[arg(long, value_enum, default_value_t = Mapper::Gpu, requires = "vtk")]
    mapper: Mapper,
}

/// VTK's renderers of volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Mapper {
    Gpu,
    Cpu,
}

impl LiveVtk {
    /// VTK's picture of a pipeline's scene, by way of a folder that is removed again.
    pub(super) fn picture(&self, pipeline: &Path, overrides: &[String]) -> Result<Image> {
        if let Side::File(path) = Side::of(pipeline) {
            return Err(Error::new(Fault::Spec, "VTK renders pipelines, not pictures")
                .at(path)
                .expected("a pipeline (.yaml)")
                .remedy("name the pipeline, or two pictures without --vtk"));
        }
        let spec = Spec::load(pipeline, overrides)?;
        let scan = pipeline::load(&spec, &pipeline::Options::default())?;
        let plan = pipeline::plan(&spec, &scan, &Options::default())?;
        let folder = std::env::temp_dir().join(format!("pellucid-vtk-{}", std::process::id()));
        let image = vtk::export(&folder, &scan.volume, &plan).and_then(|script| self.render(&script));
        // The picture is in memory; a folder that stays behind is no reason to fail.
        let _ = std::fs::remove_dir_all(&folder);
        image
    }

    fn render(&self, script: &Path) -> Result<Image> {
        let output = script.with_file_name("picture.npy");
        let mapper = match self.mapper {
            Mapper::Gpu => "gpu",
            Mapper::Cpu => "cpu",
        };
        let ran = Command::new(&self.python).arg(script).args(["--mapper", mapper, "--output"]).arg(&output).output();
        let ran = ran.map_err(|cause| {
            Error::new(Fault::Input, "Python cannot be run").at(&self.python).remedy(vtk::REMEDY).caused_by(cause)
        })?;
        let said = String::from_utf8_lossy(&ran.stderr);
        let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("nothing").to_string();
        if ran.status.code() == Some(NO_EQUAL) {
            return Err(Error::new(Fault::Unsupported, last).element("--mapper").found(mapper).remedy("--mapper gpu"));
        }
        if !ran.status.success() || !output.exists() {
            return Err(Error::new(Fault::Input, "VTK made no picture")
                .at(&self.python)
                .found(last)
                .remedy(vtk::REMEDY));
        }
        Ok(picture::read(&output)?.image)
    }
}
