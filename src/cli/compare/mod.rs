//! `pellucid compare`: how two pictures differ, each a file or what a pipeline renders.

mod side;
mod text;
mod vtk;

use std::path::{Path, PathBuf};

use pellucid::image::metrics::{Comparison, compare_as_seen};
use pellucid::image::{Image, figure};
use pellucid::io::png;
use pellucid::{Error, Fault, Result};
use serde_json::json;

use super::{Format, Global, stdout};
use side::Side;

/// Full scale of the figures where no tolerance is given: one step of an 8-bit channel.
const ONE_STEP: f64 = 1.0 / 255.0;

/// Arguments of `pellucid compare`.
#[derive(Debug, clap::Args)]
pub(super) struct Compare {
    /// The reference: a picture (.png, .exr or .npy), or a pipeline (.yaml) to be rendered
    reference: PathBuf,

    /// What is held against it: a picture, or a pipeline
    #[arg(required_unless_present = "vtk", conflicts_with = "vtk")]
    test: Option<PathBuf>,

    #[command(flatten)]
    vtk: vtk::LiveVtk,

    /// Set a key of the pipelines, such as `camera.azimuth=25`; the value is YAML. May be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// The largest difference of a channel that passes, linear and premultiplied, such as 2/255
    #[arg(long, value_name = "T", value_parser = number)]
    tolerance: Option<f64>,

    /// The largest root mean square difference over all channels that passes
    #[arg(long, value_name = "T", value_parser = number)]
    rms_tolerance: Option<f64>,

    /// How many pixels may be above the tolerance and pass, as a share of all, such as 0.001
    #[arg(long, value_name = "SHARE", value_parser = number, requires = "tolerance", default_value = "0")]
    share: f64,

    /// Write both pictures and the map of their difference next to one another, as PNG
    #[arg(long, value_name = "FILE")]
    side_by_side: Option<PathBuf>,

    /// Write the map of the difference with a colour bar, as PNG
    #[arg(long, value_name = "FILE")]
    difference: Option<PathBuf>,

    /// The difference with the colour at the top of the bar; the tolerance, or 1/255, unless told
    #[arg(long, value_name = "D", value_parser = number)]
    full_scale: Option<f64>,

    /// How the numbers are printed
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

impl Compare {
    /// Compares; the numbers go to stdout. An error if the pictures are further apart than allowed.
    pub(super) fn run(&self, global: &Global) -> Result<()> {
        let (reference, test) = match &self.test {
            Some(test) => {
                let [reference, test] = [&self.reference, test].map(|path| Side::of(path).picture(&self.set, global));
                (reference?, test?)
            }
            None => (
                self.vtk.picture(&self.reference, &self.set)?,
                Side::Pipeline(&self.reference).picture(&self.set, global)?,
            ),
        };
        let tolerance = self.tolerance.unwrap_or(ONE_STEP);
        let comparison = compare_as_seen(&reference, &test, tolerance).map_err(|error| error.at(self.tested()))?;
        self.draw(&reference, &test)?;
        match self.format {
            Format::Text => stdout::print(&text::text(&comparison, tolerance))?,
            Format::Json => stdout::print_json(&json!({ "tolerance": tolerance, "comparison": comparison }))?,
        }
        self.judge(&comparison)
    }

    /// What is held against the reference.
    fn tested(&self) -> &Path {
        self.test.as_ref().unwrap_or(&self.reference)
    }

    fn draw(&self, reference: &Image, test: &Image) -> Result<()> {
        let full_scale = self.full_scale.or(self.tolerance).unwrap_or(ONE_STEP);
        let write = |path: &Path, figure: Image| png::write(path, &figure, png::Depth::Eight, &[]);
        if let Some(path) = &self.side_by_side {
            write(path, figure::side_by_side(reference, test, full_scale))?;
        }
        if let Some(path) = &self.difference {
            write(path, figure::difference_map(reference, test, full_scale))?;
        }
        Ok(())
    }

    /// Holds a comparison to what was asked for; what was not asked for passes, but no NaN does.
    fn judge(&self, comparison: &Comparison) -> Result<()> {
        let over = comparison.difference.pixels_over;
        let allowed = (self.share * comparison.difference.pixels as f64).floor() as usize;
        let mut objections = Vec::new();
        if let Some(tolerance) = self.tolerance.filter(|_| over > allowed) {
            objections.push(format!(
                "{over} pixels above {tolerance:.3e} where {allowed} may be, the largest difference {:.3e}",
                comparison.max_abs_all
            ));
        }
        if let Some(tolerance) = self.rms_tolerance
            && (comparison.rms_all > tolerance || tolerance.is_nan())
        {
            objections.push(format!("an RMS difference of {:.3e} above {tolerance:.3e}", comparison.rms_all));
        }
        if !comparison.max_abs_all.is_finite() {
            objections.push("a pixel that is not a number".to_string());
        }
        if objections.is_empty() {
            return Ok(());
        }
        Err(Error::new(Fault::Tolerance, "the pictures are further apart than allowed")
            .at(self.tested())
            .found(objections.join("; ")))
    }
}

/// A number, or a fraction such as `1/255`; finite and at least 0.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let part = |text: &str| text.trim().parse::<f64>().ok();
    let value = match text.split_once('/') {
        None => part(text),
        Some((above, below)) => part(above).zip(part(below)).map(|(a, b)| a / b),
    };
    value.filter(|v| v.is_finite() && *v >= 0.0).ok_or_else(|| "expected a number such as 0.004 or 1/255".to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_numbers() {
        assert_eq!(number("2/255"), Ok(2.0 / 255.0));
        assert_eq!(number("1e-3"), Ok(1e-3));
        for wrong in ["", "x", "1/0", "-1", "nan", "1/2/3"] {
            assert!(number(wrong).is_err(), "{wrong:?} is no number");
        }
    }
}
