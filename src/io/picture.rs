//! A picture, in whichever format its name says.

use std::path::Path;

use super::{Picture, exr, png};
use crate::error::{Error, Fault, Result};

/// Reads a picture by its suffix, `.png` or `.exr`.
///
/// # Errors
/// Those of the format's reader; `Fault::Input` for a name without such a suffix.
pub fn read(path: &Path) -> Result<Picture> {
    match path.extension().map(|suffix| suffix.to_string_lossy().to_lowercase()).as_deref() {
        Some("png") => png::read(path),
        Some("exr") => exr::read(path),
        suffix => Err(Error::new(Fault::Input, "the format of a picture is told by its suffix")
            .at(path)
            .found(suffix.unwrap_or("none"))
            .expected(".png or .exr")),
    }
}
