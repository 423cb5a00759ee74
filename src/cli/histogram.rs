//! `pellucid histogram`: how many voxels have which value and gradient magnitude, as a picture to design by.

use std::path::{Path, PathBuf};

use pellucid::chart::{self, Caption};
use pellucid::histogram::{self, Axis, Counts};
use pellucid::io::whole_file;
use pellucid::pipeline::{self, Options};
use pellucid::plan::{self, LayerWidgets, VolumeInfo};
use pellucid::spec::Spec;
use pellucid::volume::Quantity;
use pellucid::{Error, Fault, Result, Volume};

use super::progress::Bar;
use super::{Global, stderr, stdout};

/// Arguments of `pellucid histogram`.
#[derive(Debug, clap::Args)]
pub(super) struct Histogram {
    /// A scan, or a pipeline (.yaml), whose layers are drawn over the counts
    input: PathBuf,

    /// A preset whose widgets are drawn over the counts of a scan, by name or as a .yaml file; may be repeated
    #[arg(short, long, value_name = "NAME", conflicts_with = "lh")]
    preset: Vec<String>,

    /// Values from end to end, such as -1000:2000; those of the pipeline or of all but one voxel in 10 000 unless told
    #[arg(long, value_name = "LOW:HIGH", value_parser = range, allow_hyphen_values = true)]
    hu: Option<[f64; 2]>,

    /// Gradient magnitudes from end to end, HU/mm, such as 0:800; chosen as the values are unless told
    #[arg(long, value_name = "LOW:HIGH", value_parser = range, conflicts_with = "lh")]
    gradient: Option<[f64; 2]>,

    /// Bins along each axis; about so many along values that are whole numbers, unless --hu says where they end
    #[arg(long, value_name = "N", default_value_t = 256)]
    bins: usize,

    /// Count by the values of the two materials between which a voxel lies instead (Šereda et al. 2006)
    #[arg(long)]
    lh: bool,

    /// With --lh: the gradient magnitude, HU/mm, below which a voxel lies inside a material; above the scan's noise. A
    /// sixteenth of the range that --gradient would have unless told
    #[arg(long, value_name = "HU/MM", requires = "lh")]
    flat: Option<f64>,

    /// Set a key of the pipeline, such as `volume.shift_hu=-1024`; the value is YAML. May be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// The file to write: .png or .svg, or .json with all counts. May be repeated
    #[arg(short, long, value_name = "FILE", required = true)]
    output: Vec<PathBuf>,
}

/// What a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Png,
    Svg,
    Json,
}

/// Counts, and what they are of.
struct Counted {
    counts: Counts,
    layers: Vec<LayerWidgets>,
    quantity: Quantity,
    /// Of a low-high histogram.
    flat_per_mm: Option<f64>,
}

impl Histogram {
    /// Counts, and writes what is asked for; the paths go to stdout.
    pub(super) fn run(&self, global: &Global) -> Result<()> {
        let forms: Vec<Form> = self.output.iter().map(|path| form(path)).collect::<Result<_>>()?;
        let spec = self.spec()?;
        let bar = Bar::new(global.quiet);
        bar.hear(pipeline::Event::Stage("load"));
        let scan = pipeline::load(&spec, &Options::default());
        bar.hear(pipeline::Event::Stage("count"));
        let counted = scan.and_then(|scan| Ok((self.count(&spec, &scan.volume)?, scan.warnings)));
        bar.clear();
        let (counted, warnings) = counted?;
        if !global.quiet {
            warnings.iter().for_each(|warning| stderr::say(&format!("warning: {warning}")));
        }
        let svg = forms
            .iter()
            .any(|form| *form != Form::Json)
            .then(|| chart::histogram(&counted.counts, &counted.caption(), &counted.layers));
        for (path, form) in self.output.iter().zip(forms) {
            match (form, &svg) {
                (Form::Png, Some(svg)) => chart::write_png(path, svg)?,
                (Form::Svg, Some(svg)) => chart::write_svg(path, svg)?,
                _ => {
                    let json = counted.json().to_string();
                    whole_file::write(path, |file| std::io::Write::write_all(file, json.as_bytes()))?;
                }
            }
            stdout::print(&path.display().to_string())?;
        }
        Ok(())
    }

    fn spec(&self) -> Result<Spec> {
        let is_pipeline = self.input.extension().is_some_and(|extension| extension == "yaml" || extension == "yml");
        match is_pipeline {
            true if !self.preset.is_empty() => {
                Err(Error::new(Fault::Spec, "the layers of a pipeline are what is drawn")
                    .at(&self.input)
                    .element("--preset")
                    .remedy("write presets into it"))
            }
            true => Spec::load(&self.input, &self.set),
            false => Spec::of_presets(&self.input, &self.preset, &self.set),
        }
    }

    fn count(&self, spec: &Spec, volume: &Volume) -> Result<Counted> {
        let quantity = volume.quantity();
        let value = match self.hu.or(spec.pipeline.normalise.as_ref().map(|normalise| normalise.hu)) {
            Some(ends) => Axis::new(ends, self.bins)?,
            None => histogram::value_axis(volume, self.bins)?,
        };
        let gradient_ends = || -> Result<[f64; 2]> {
            match self.gradient.or(spec.pipeline.gradient.as_ref().map(|gradient| gradient.range_hu_per_mm)) {
                Some(ends) => Ok(ends),
                None => Ok([0.0, histogram::gradient_end_per_mm(volume)?]),
            }
        };
        if self.lh {
            let flat_per_mm = self.flat.map_or_else(|| Ok(gradient_ends()?[1] / 16.0), Ok)?;
            let counts = histogram::low_high(volume, value, flat_per_mm)?;
            return Ok(Counted { counts, layers: Vec::new(), quantity, flat_per_mm: Some(flat_per_mm) });
        }
        let layers = plan::widgets(spec, &VolumeInfo::from(volume))?;
        let counts = histogram::joint(volume, value, Axis::new(gradient_ends()?, self.bins)?)?;
        Ok(Counted { counts, layers, quantity, flat_per_mm: None })
    }
}

impl Counted {
    /// The units of values and of gradient magnitudes.
    fn units(&self) -> [&'static str; 2] {
        match self.quantity {
            Quantity::Hu => ["HU", "HU/mm"],
            Quantity::Arbitrary => ["unit unknown", "per mm"],
        }
    }

    fn caption(&self) -> Caption {
        let [unit, unit_per_mm] = self.units();
        let (counts, [x, y]) = (&self.counts, [self.counts.x(), self.counts.y()]);
        let voxels = format!("{} voxels", chart::grouped(counts.voxels()));
        let beyond = match counts.voxels() - counts.counted() {
            0 => String::new(),
            beyond => format!(", {} of them beyond the axes", chart::grouped(beyond)),
        };
        let bins = format!("{} × {} bins", x.bins(), y.bins());
        match self.flat_per_mm {
            None => Caption {
                title: "Value and gradient magnitude".to_owned(),
                subtitle: format!("{voxels}{beyond}; {bins}"),
                x: format!("value, {unit}"),
                y: format!("gradient magnitude |∇|, {unit_per_mm}"),
            },
            Some(flat) => Caption {
                title: "The two materials between which voxels lie".to_owned(),
                subtitle: format!(
                    "{voxels}{beyond}; {bins}; inside a material below {} {unit_per_mm}",
                    (flat * 100.0).round() / 100.0
                ),
                x: format!("value of the lower material, {unit}"),
                y: format!("value of the higher material, {unit}"),
            },
        }
    }

    /// All counts, horizontal axis first.
    fn json(&self) -> serde_json::Value {
        let ([unit, unit_per_mm], counts) = (self.units(), &self.counts);
        let (kind, x, y) = match self.flat_per_mm {
            None => ("value and gradient magnitude", ("value", unit), ("gradient magnitude", unit_per_mm)),
            Some(_) => {
                ("low and high material", ("value of the lower material", unit), ("value of the higher material", unit))
            }
        };
        let axis = |(name, unit): (&str, &str), axis: Axis| serde_json::json!({ "name": name, "unit": unit, "low": axis.low(), "high": axis.high(), "bins": axis.bins() });
        serde_json::json!({
            "histogram": kind,
            "x": axis(x, counts.x()),
            "y": axis(y, counts.y()),
            "bins": "half-open [low, high), equal; the last of each axis is closed",
            "flat_per_mm": self.flat_per_mm,
            "voxels": counts.voxels(),
            "counted": counts.counted(),
            "counts": (0..counts.x().bins()).map(|i| counts.column(i)).collect::<Vec<_>>(),
        })
    }
}

fn form(path: &Path) -> Result<Form> {
    let suffix = path.extension().map(|suffix| suffix.to_string_lossy().to_lowercase());
    match suffix.as_deref() {
        Some("png") => Ok(Form::Png),
        Some("svg") => Ok(Form::Svg),
        Some("json") => Ok(Form::Json),
        _ => Err(Error::new(Fault::Output, "this suffix names no form of a histogram")
            .at(path)
            .expected("a name that ends in .png, .svg or .json")),
    }
}

fn range(text: &str) -> Result<[f64; 2], String> {
    let ends = text.split_once(':').and_then(|(low, high)| Some([low.trim().parse().ok()?, high.trim().parse().ok()?]));
    match ends {
        Some([low, high]) if f64::is_finite(low) && f64::is_finite(high) && low < high => Ok([low, high]),
        _ => Err("expected LOW:HIGH, such as -1000:2000".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_two_numbers_the_lower_first() {
        assert_eq!(range("-1000:2000.5"), Ok([-1000.0, 2000.5]));
        for wrong in ["5", "2:1", "1:1", "a:b", ":", "0:inf", "NaN:1"] {
            assert!(range(wrong).is_err(), "{wrong} is no range");
        }
    }
}
