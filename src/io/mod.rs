//! Files: CT scans in, scans, label maps and pictures out.
//!
//! Readers refuse what they would have to guess, and say what became of every file they were shown.

pub mod dicom;
pub mod exr;
mod label_map;
pub mod labels;
mod load;
pub mod nifti;
pub mod npy;
pub mod nrrd;
pub mod picture;
pub mod png;
pub mod whole_file;

pub use label_map::{LabelFormat, read_labels, write_labels};
pub use labels::Labels;
pub use load::{Format, format_of, load, load_spaced};

use std::path::{Path, PathBuf};

use crate::error::{Error, Fault, Result};
use crate::image::Image;
use crate::volume::Volume;

/// A scan as read, with what its reader has to say about it.
#[derive(Debug, Clone)]
pub struct Scan {
    /// The volume.
    pub volume: Volume,
    /// Labels of its voxels, where a mask asks for them.
    pub labels: Option<Labels>,
    /// What was read, for people: format, series, dimensions; label and text.
    pub facts: Vec<(String, String)>,
    /// What a careful user should know: values replaced, orientation assumed.
    pub warnings: Vec<String>,
    /// What became of each file.
    pub files: Vec<FileFate>,
    /// Most bytes held while it was read, the volume's included, estimated.
    pub reading_bytes: u64,
}

/// What became of a file that a reader was shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileFate {
    /// The file.
    pub path: PathBuf,
    /// True if the volume holds its samples.
    pub used: bool,
    /// Why it was used or left out, as one clause.
    pub reason: String,
}

/// A picture as read.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// The pixels, linear and premultiplied.
    pub image: Image,
    /// Texts that the file holds, with their keywords.
    pub texts: Vec<(String, String)>,
}

/// No picture with NaN or infinity leaves this program; a renderer that makes one has a bug.
fn refuse_not_finite(path: &Path, image: &Image) -> Result<()> {
    let Some(index) = image.pixels().iter().position(|pixel| pixel.iter().any(|v| !v.is_finite())) else {
        return Ok(());
    };
    Err(Error::new(Fault::Internal, "a pixel is not a finite number")
        .at(path)
        .element(format!("column {}, row {}", index % image.width(), index / image.width()))
        .found(format!("{:?}", image.pixels()[index])))
}
