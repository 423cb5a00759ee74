//! `pellucid presets export`: a preset for programs that know the value alone.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use pellucid::Result;
use pellucid::interchange::presets::{ProjectSettings, project, write_paraview, write_vp, write_vp_json};
use pellucid::io::whole_file;
use pellucid::spec::load_preset;

use super::named;
use crate::cli::{stderr, stdout};

/// Arguments of `pellucid presets export`.
#[derive(Debug, clap::Args)]
pub(super) struct Export {
    /// A preset: the name of one that comes along, or a .yaml file
    preset: String,

    /// For which program
    #[arg(long, value_enum)]
    format: Format,

    /// The file to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// Mean gradient magnitude, HU/mm, of the exponential distribution over which the gradient axis is averaged
    #[arg(long, value_name = "HU/MM", default_value_t = ProjectSettings::default().mean_gradient_hu_per_mm)]
    mean_gradient: f64,

    /// Length that the opacities are to be those of, mm
    #[arg(long, value_name = "MM", default_value_t = ProjectSettings::default().unit_distance_mm)]
    unit_distance: f64,

    /// How far opacity and colour of a slab of the unit distance may be off, apart from the loss of the gradient axis
    #[arg(long, value_name = "SHARE", default_value_t = ProjectSettings::default().max_deviation)]
    max_deviation: f64,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Format {
    /// 3D Slicer, text
    Vp,
    /// 3D Slicer, JSON
    VpJson,
    /// ParaView's JSON colour map with opacity
    Paraview,
}

impl Export {
    /// Writes the file; its path goes to stdout, what was lost to stderr.
    pub(super) fn run(&self) -> Result<()> {
        let preset = match named(&self.preset) {
            Ok(built_in) => built_in.preset,
            Err(_) if self.preset.ends_with(".yaml") => load_preset(Path::new(&self.preset))?.preset,
            Err(error) => return Err(error),
        };
        let settings = ProjectSettings {
            mean_gradient_hu_per_mm: self.mean_gradient,
            unit_distance_mm: self.unit_distance,
            max_deviation: self.max_deviation,
        };
        let projection = project(&preset, &settings).map_err(|error| error.at(&self.preset))?;
        let text = match self.format {
            Format::Vp => write_vp(&projection.property),
            Format::VpJson => write_vp_json(&projection.property),
            Format::Paraview => write_paraview(&projection.property),
        }?;
        whole_file::write(&self.output, |file| file.write_all(text.as_bytes()))?;
        stdout::print(&self.output.display().to_string())?;
        let loss = projection.loss;
        stderr::say(&format!(
            "{}: {} points; opacity and colour of {} mm within {:.1e} of the mean over gradient magnitudes\n\
             lost with the gradient axis: opacity of 1 mm off by {:.3} at most (at {:.0} HU, {:.0} HU/mm), {:.4} on average",
            preset.name,
            projection.property.scalar_opacity.nodes().len(),
            self.unit_distance,
            projection.max_deviation,
            loss.largest,
            loss.at[0],
            loss.at[1],
            loss.mean,
        ));
        Ok(())
    }
}
