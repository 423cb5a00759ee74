//! What is in a folder of DICOM files.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::group::Group;
use super::header::{Rejected, read_header};
use super::series::{Series, Slice};
use crate::error::{Error, Fault, Result};
use crate::io::FileFate;

/// Folders nest no deeper than this; a deeper one is a loop of links.
const MAX_DEPTH: usize = 32;

/// The series of a folder, and the files that belong to none.
#[derive(Debug, Clone)]
pub struct Folder {
    /// The folder, or the single file.
    pub path: PathBuf,
    /// Its series, most slices first.
    pub series: Vec<Series>,
    /// Files that hold no image, with the reason.
    pub others: Vec<FileFate>,
    /// How many of the others may be images, but are damaged or lack what an image must have.
    pub damaged: usize,
}

/// Reads the headers of all files below a folder, or of one file, and sorts their images into series.
///
/// # Errors
/// `Fault::Input` if the path cannot be read. A folder without any image is a `Folder` without series.
pub fn scan_folder(path: &Path) -> Result<Folder> {
    let mut paths = Vec::new();
    collect_files(path, 0, &mut paths)?;
    let headers: Vec<_> = paths.par_iter().map(|path| read_header(path)).collect();
    let mut slices = Vec::new();
    let mut others = Vec::new();
    let mut damaged = 0;
    for (path, header) in paths.into_iter().zip(headers) {
        match header {
            Ok(file) => slices.extend(Slice::all_of(file)),
            Err(Rejected { reason, is_damaged }) => {
                damaged += usize::from(is_damaged);
                others.push(FileFate { path, used: false, reason });
            }
        }
    }
    let mut series: Vec<Series> = Group::gather(slices).into_par_iter().map(Series::of).collect();
    // A stable order whatever the file system's: most slices first, then as people number them.
    series.sort_by(|a, b| {
        b.dims[2].cmp(&a.dims[2]).then_with(|| a.number.cmp(&b.number)).then_with(|| a.uid.cmp(&b.uid))
    });
    tracing::debug!(path = %path.display(), series = series.len(), others = others.len(), "folder scanned");
    Ok(Folder { path: path.to_path_buf(), series, others, damaged })
}

/// Appends the files below `path`, in the order of their names.
fn collect_files(path: &Path, depth: usize, found: &mut Vec<PathBuf>) -> Result<()> {
    let unreadable = |error: std::io::Error| {
        Error::new(Fault::Input, "cannot be read")
            .at(path)
            .caused_by(error)
            .remedy("check the path and its permissions")
    };
    if depth > MAX_DEPTH {
        return Err(Error::new(Fault::Input, "folders nest too deeply")
            .at(path)
            .expected(format!("at most {MAX_DEPTH} levels"))
            .remedy("name the folder that holds the series"));
    }
    if !std::fs::metadata(path).map_err(unreadable)?.is_dir() {
        found.push(path.to_path_buf());
        return Ok(());
    }
    let entries = std::fs::read_dir(path).map_err(unreadable)?;
    let mut children =
        entries.map(|entry| entry.map(|e| e.path())).collect::<std::io::Result<Vec<_>>>().map_err(unreadable)?;
    children.sort();
    for child in children {
        // A dangling link is a file that cannot be read; it is named as such among the others.
        if child.is_dir() { collect_files(&child, depth + 1, found)? } else { found.push(child) }
    }
    Ok(())
}
