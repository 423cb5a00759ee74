//! Histograms and charts as pictures to read, drawn as SVG; a PNG is that drawing rasterised.
//!
//! No font of the system is read: pictures carry DejaVu Sans along (PNG), or ask for it by name (SVG). Counts are shown
//! logarithmically by colours of falling lightness, dark for many, so that the eye orders them without the colour bar.

mod contour;
mod drawing;
mod histogram;
mod ink;
mod loglog;
mod raster;
mod scale;

pub use histogram::{Caption, histogram};
pub use loglog::{LogLog, Series};
pub use scale::grouped;

use std::path::Path;

use crate::error::Result;
use crate::io::whole_file;

/// Writes a drawing as an SVG file.
///
/// # Errors
/// `Fault::Output` if it cannot be written.
pub fn write_svg(path: &Path, svg: &str) -> Result<()> {
    whole_file::write(path, |file| std::io::Write::write_all(file, svg.as_bytes()))
}

/// Writes a drawing as a PNG file.
///
/// # Errors
/// `Fault::Output` if it cannot be written, `Fault::Internal` for a drawing that is no SVG, `Fault::Limit` for one that is
/// too large.
pub fn write_png(path: &Path, svg: &str) -> Result<()> {
    let png = raster::png(svg).map_err(|error| error.at(path))?;
    whole_file::write(path, |file| std::io::Write::write_all(file, &png))
}
