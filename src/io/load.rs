//! A scan from a path: which reader it is for.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::dicom::{self, SeriesChoice, SliceSpacing};
use super::{Scan, nifti, nrrd};
use crate::error::{Error, Fault, Result};

/// What a path may name, as messages say it.
const SUPPORTED: &str = "a folder of DICOM files, a DICOM file, or a .nrrd, .nhdr, .nii or .nii.gz file";

/// Formats that others write volumes in and that are not read here, by suffix.
const UNSUPPORTED: [(&str, &str); 6] = [
    ("mha", "MetaImage"),
    ("mhd", "MetaImage"),
    ("vti", "VTK image data"),
    ("tif", "TIFF"),
    ("tiff", "TIFF"),
    ("raw", "samples without a header"),
];

/// Reads a scan: a folder or file of DICOM, NRRD or NIfTI. `series` matters for DICOM only. `max_bytes` is the most memory
/// that reading may take; it is checked before anything is allocated for samples.
///
/// # Errors
/// `Fault::Input` for a path that is missing or unreadable, `Fault::Unsupported` for a format that is not read here, and
/// whatever the reader finds; `Fault::Limit` for more than `max_bytes`.
pub fn load(path: &Path, series: &SeriesChoice, max_bytes: Option<u64>) -> Result<Scan> {
    load_spaced(path, series, SliceSpacing::Even, max_bytes)
}

/// The same for DICOM slices whose spacing may change; the slices of a NRRD have one.
///
/// # Errors
/// As [`load`].
pub fn load_spaced(path: &Path, series: &SeriesChoice, spacing: SliceSpacing, max_bytes: Option<u64>) -> Result<Scan> {
    match format_of(path)? {
        Format::Dicom => dicom::read_spaced(path, series, spacing, max_bytes),
        Format::Nrrd => nrrd::read_within(path, max_bytes),
        Format::Nifti => nifti::read(path, max_bytes),
    }
}

/// Formats of scans.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// A folder or a file of DICOM.
    Dicom,
    /// NRRD, attached or detached.
    Nrrd,
    /// NIfTI-1.
    Nifti,
}

/// The format of what lies at `path`: by its suffix, and by its first bytes where the suffix says nothing.
///
/// # Errors
/// As [`load`], for what can be said without reading the scan.
pub fn format_of(path: &Path) -> Result<Format> {
    if !path.exists() {
        return Err(missing(path));
    }
    if path.is_dir() {
        return Ok(Format::Dicom);
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let has_suffix = |suffix: &str| name.strip_suffix(suffix).is_some_and(|stem| stem.ends_with('.'));
    if ["nrrd", "nhdr"].into_iter().any(has_suffix) {
        return Ok(Format::Nrrd);
    }
    if ["nii", "nii.gz"].into_iter().any(has_suffix) {
        return Ok(Format::Nifti);
    }
    if has_suffix("dcm") {
        return Ok(Format::Dicom);
    }
    if let Some((suffix, name)) = UNSUPPORTED.iter().find(|(suffix, _)| has_suffix(suffix)) {
        return Err(Error::new(Fault::Unsupported, "this format is not read here")
            .at(path)
            .found(format!("{name} (.{suffix})"))
            .expected(SUPPORTED)
            .remedy("convert it to NRRD with a program that keeps the geometry, such as 3D Slicer or SimpleITK"));
    }
    let start = first_bytes(path)?;
    if start.starts_with(b"NRRD") {
        return Ok(Format::Nrrd);
    }
    // DICOM PS3.10 7.1: 128 bytes of preamble, then the prefix.
    if start.get(128..132) == Some(b"DICM") {
        return Ok(Format::Dicom);
    }
    Err(Error::new(Fault::Input, "this is not a scan")
        .at(path)
        .found("a file that starts neither as DICOM nor as NRRD")
        .expected(SUPPORTED))
}

fn first_bytes(path: &Path) -> Result<Vec<u8>> {
    let mut start = Vec::new();
    let read = File::open(path).and_then(|file| file.take(132).read_to_end(&mut start));
    match read {
        Ok(_) => Ok(start),
        Err(cause) => Err(Error::new(Fault::Input, "the file could not be read").at(path).caused_by(cause)),
    }
}

/// The error for a path that leads nowhere, with the nearest that exists.
fn missing(path: &Path) -> Error {
    let error = Error::new(Fault::Input, "there is no such file or folder").at(path).expected(SUPPORTED);
    let Some((folder, wanted)) = last_existing_folder(path) else { return error };
    let searched = if folder.as_os_str().is_empty() { Path::new(".") } else { folder.as_path() };
    let entries = std::fs::read_dir(searched).into_iter().flatten().filter_map(|entry| entry.ok());
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let similarity = |name: &String| strsim::jaro_winkler(&name.to_lowercase(), &wanted.to_lowercase());
    let nearest = names.max_by(|a, b| similarity(a).total_cmp(&similarity(b))).filter(|name| similarity(name) > 0.8);
    match nearest {
        Some(name) => error.remedy(format!("did you mean {}?", folder.join(name).display())),
        None => error.remedy(format!("look for the right name in {}", shown(&folder))),
    }
}

/// The longest part of a path that is a folder, and the name that is missing in it.
fn last_existing_folder(path: &Path) -> Option<(PathBuf, String)> {
    let folder_of = |missing: &Path| missing.parent().map(Path::to_path_buf);
    let here = |folder: &Path| folder.as_os_str().is_empty() || folder.is_dir();
    path.ancestors().find_map(|missing| {
        let folder = folder_of(missing).filter(|folder| here(folder))?;
        Some((folder, missing.file_name()?.to_string_lossy().into_owned()))
    })
}

fn shown(folder: &Path) -> String {
    if folder.as_os_str().is_empty() { "the working directory".to_string() } else { folder.display().to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(name: &str) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(name)
    }

    #[test]
    fn a_misspelt_path_is_answered_with_the_nearest_name() {
        let error = load(&source("volum/grid.rs"), &SeriesChoice::default(), None).expect_err("no such path");
        assert_eq!(error.fault(), Fault::Input);
        let remedy = error.remedy_text().unwrap_or_default();
        assert!(remedy.contains("volume"), "should suggest src/volume, found: {remedy}");
    }

    #[test]
    fn a_path_like_nothing_is_answered_with_what_exists() {
        let error = format_of(&source("qqqq/zzzz.nrrd")).expect_err("no such path");
        let remedy = error.remedy_text().unwrap_or_default();
        assert!(
            remedy.contains("in ") && remedy.contains("src"),
            "should name the folder that exists, found: {remedy}"
        );
    }

    #[test]
    fn a_file_that_is_no_scan_is_refused() {
        let error = format_of(&source("lib.rs")).expect_err("source code is no scan");
        assert_eq!(error.fault(), Fault::Input, "found: {error}");
    }

    #[test]
    fn folders_are_for_dicom() {
        assert_eq!(format_of(&source("")).expect("a folder"), Format::Dicom);
    }
}
