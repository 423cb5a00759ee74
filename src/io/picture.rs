//! A picture, in whichever format its name says.

use std::path::Path;

use super::{Picture, exr, npy, png};
use crate::error::{Error, Fault, Result};
use crate::image::Image;

/// Reads a picture by its suffix: `.png`, `.exr`, or `.npy` for numpy's arrays of linear premultiplied RGBA in f32, in the
/// shape (height, width, 4), top row first.
///
/// # Errors
/// Those of the format's reader; `Fault::Input` for a name without such a suffix.
pub fn read(path: &Path) -> Result<Picture> {
    match path.extension().map(|suffix| suffix.to_string_lossy().to_lowercase()).as_deref() {
        Some("png") => png::read(path),
        Some("exr") => exr::read(path),
        Some("npy") => array(path),
        suffix => Err(Error::new(Fault::Input, "the format of a picture is told by its suffix")
            .at(path)
            .found(suffix.unwrap_or("none"))
            .expected(".png, .exr or .npy")),
    }
}

fn array(path: &Path) -> Result<Picture> {
    let (shape, values) = npy::read(path)?;
    let &[height, width, 4] = shape.as_slice() else {
        return Err(Error::new(Fault::Input, "the array is not a picture")
            .at(path)
            .found(format!("a shape of {shape:?}"))
            .expected("(height, width, 4)"));
    };
    Ok(Picture { image: Image::from_pixels(width, height, values.as_chunks::<4>().0.to_vec()), texts: Vec::new() })
}
