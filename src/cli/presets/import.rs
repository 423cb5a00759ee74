//! `pellucid presets import`: presets of 3D Slicer and ParaView.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use pellucid::interchange::presets::{
    ColorNumbers, ImportSettings, Imported, VolumeProperty, import, preset_name, read,
};
use pellucid::io::whole_file;
use pellucid::spec::{ValuesName, parse_preset};
use pellucid::{Error, Fault, Result};

use crate::cli::{stderr, stdout};

/// Arguments of `pellucid presets import`.
#[derive(Debug, clap::Args)]
pub(super) struct Import {
    /// A .vp, .vp.json, presets.xml or .mrml file of Slicer, or a JSON colour map of ParaView
    file: PathBuf,

    /// Which one of a file that holds several; otherwise, what to call the preset
    #[arg(long, value_name = "NAME")]
    name: Option<String>,

    /// Folder for the presets, one file each; made if it is not there. stdout unless told
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// What the values are: HU, as of CT, or arbitrary
    #[arg(long, value_enum, default_value_t = Values::Hu)]
    values: Values,

    /// What colours are: a display's numbers, or light, for which VTK takes them when it blends
    #[arg(long, value_enum, default_value_t = Colors::Display)]
    colors: Colors,

    /// Length that the opacities are those of, mm; that of the file, or 1, unless told
    #[arg(long, value_name = "MM")]
    unit_distance: Option<f64>,

    /// Mean voxel spacing of the scan on which gradient opacity was set, mm; needed where it varies
    #[arg(long, value_name = "MM")]
    voxel_mm: Option<f64>,

    /// How far opacity and colour of a slab of any length may be off
    #[arg(long, value_name = "SHARE", default_value_t = ImportSettings::default().max_deviation)]
    max_deviation: f64,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Colors {
    Display,
    Light,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Values {
    Hu,
    Arbitrary,
}

impl Import {
    /// Prints a preset, or writes files and prints their paths; how close they are goes to stderr.
    pub(super) fn run(&self) -> Result<()> {
        let properties = read(&self.file)?;
        let presets = self.wanted(&properties)?.into_iter().map(|(name, property)| self.import(property, &name));
        let presets = presets.collect::<Result<Vec<(Imported, String)>>>()?;
        match (&self.output, presets.as_slice()) {
            (Some(folder), presets) => write(folder, presets)?,
            (None, [(_, text)]) => stdout::print(text)?,
            (None, _) => {
                return Err(Error::new(Fault::Spec, "the file holds several presets")
                    .at(&self.file)
                    .found(names(&properties))
                    .remedy("choose one by --name, or give a folder for all of them by -o"));
            }
        }
        presets.iter().for_each(|(imported, _)| summarise(imported));
        Ok(())
    }

    /// What to import, by the names their presets get.
    fn wanted<'p>(&self, properties: &'p [VolumeProperty]) -> Result<Vec<(String, &'p VolumeProperty)>> {
        match (&self.name, properties) {
            (Some(name), [one]) => Ok(vec![(preset_name(name), one)]),
            (Some(name), several) => {
                let same = |p: &&VolumeProperty| preset_name(&p.name) == preset_name(name);
                let found = several.iter().find(same).ok_or_else(|| {
                    let error = Error::new(Fault::Spec, "there is no such preset in the file").at(&self.file);
                    error.element("--name").found(name).expected(format!("one of {}", names(several)))
                })?;
                Ok(vec![(preset_name(name), found)])
            }
            (None, several) => unique(several, &self.file),
        }
    }

    /// The preset and its text, read back as a pipeline would read it.
    fn import(&self, property: &VolumeProperty, name: &str) -> Result<(Imported, String)> {
        let settings = ImportSettings {
            max_deviation: self.max_deviation,
            unit_distance_mm: self.unit_distance,
            voxel_mm: self.voxel_mm,
            values: match self.values {
                Values::Hu => ValuesName::Hu,
                Values::Arbitrary => ValuesName::Arbitrary,
            },
            colors: match self.colors {
                Colors::Display => ColorNumbers::Display,
                Colors::Light => ColorNumbers::Light,
            },
        };
        let imported = import(property, name, &settings).map_err(|error| error.at(&self.file))?;
        let text = imported.yaml();
        let read = parse_preset(&text, Path::new(&format!("{name}.yaml")))?.preset;
        if read != imported.preset {
            return Err(Error::new(Fault::Internal, "the preset is not what was written of it").at(&self.file));
        }
        Ok((imported, text))
    }
}

/// All of them by their names, unless two would be one file.
fn unique<'p>(properties: &'p [VolumeProperty], file: &Path) -> Result<Vec<(String, &'p VolumeProperty)>> {
    let named: Vec<_> = properties.iter().map(|property| (preset_name(&property.name), property)).collect();
    let twice = named.iter().enumerate().find(|(i, (name, _))| named[..*i].iter().any(|(before, _)| before == name));
    match twice {
        None => Ok(named),
        Some((_, (name, _))) => {
            let error = Error::new(Fault::Input, "two presets of the file have one name").at(file).found(name);
            Err(error.remedy("rename one of them in the file"))
        }
    }
}

fn names(properties: &[VolumeProperty]) -> String {
    properties.iter().map(|property| property.name.as_str()).collect::<Vec<_>>().join(", ")
}

fn write(folder: &Path, presets: &[(Imported, String)]) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|cause| {
        Error::new(Fault::Output, "the folder for presets could not be made").at(folder).caused_by(cause)
    })?;
    for (imported, text) in presets {
        let path = folder.join(format!("{}.yaml", imported.preset.name));
        whole_file::write(&path, |file| file.write_all(text.as_bytes()))?;
        stdout::print(&path.display().to_string())?;
    }
    Ok(())
}

fn summarise(imported: &Imported) {
    let points = imported.preset.widgets.iter().filter_map(|w| w.points.as_ref()).map(Vec::len).sum::<usize>();
    stderr::say(&format!(
        "{}: {points} points; opacity and colour within {:.1e}",
        imported.preset.name, imported.max_deviation
    ));
    if let Some(difference) = imported.whole_step_difference {
        stderr::say(&format!(
            "{}: gradient opacity is VTK's for short steps; for steps of {} mm it differs by up to {difference:.2}",
            imported.preset.name, imported.unit_distance_mm
        ));
    }
}
