//! Files: CT scans in, scans and pictures out.
//!
//! Readers refuse what they would have to guess, and say what became of every file they were shown.

pub mod dicom;
pub mod exr;
mod load;
pub mod nrrd;
pub mod png;
pub mod whole_file;

pub use load::{Format, format_of, load};

use std::path::PathBuf;

use crate::volume::Volume;

/// A scan as read, with what its reader has to say about it.
#[derive(Debug, Clone)]
pub struct Scan {
    /// The volume.
    pub volume: Volume,
    /// What was read, for people: format, series, dimensions; label and text.
    pub facts: Vec<(String, String)>,
    /// What a careful user should know: values replaced, orientation assumed.
    pub warnings: Vec<String>,
    /// What became of each file.
    pub files: Vec<FileFate>,
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
