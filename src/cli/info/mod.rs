//! `pellucid info`: what is in a scan.

mod report;
mod text;

use std::path::PathBuf;

use pellucid::Result;
use pellucid::io::dicom::{Folder, SeriesChoice, scan_folder};
use pellucid::io::{self, load};

use super::{Format, stdout};
use report::Report;

/// Arguments of `pellucid info`.
#[derive(Debug, clap::Args)]
pub(super) struct Info {
    /// A folder of DICOM files, a DICOM file, or a .nrrd, .nhdr, .nii or .nii.gz file
    path: PathBuf,

    /// Series of a DICOM folder: its UID, number or description; the largest unless told
    #[arg(long, value_name = "SERIES")]
    series: Option<String>,

    /// How it is printed
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

impl Info {
    /// Prints what is in the scan. If no volume can be made of it, prints the series and files that were found, and gives
    /// the reason as an error.
    pub(super) fn run(&self) -> Result<()> {
        let folder = self.folder()?;
        let choice = self.series.clone().map_or(SeriesChoice::Largest, SeriesChoice::Named);
        let scan = load(&self.path, &choice);
        let report = Report::new(folder.as_ref(), scan.as_ref().ok());
        match self.format {
            Format::Text => stdout::print(&text::of(&report, scan.as_ref().ok()))?,
            Format::Json => stdout::print_json(&report)?,
        }
        scan.map(|_| ())
    }

    fn folder(&self) -> Result<Option<Folder>> {
        match io::format_of(&self.path)? {
            io::Format::Dicom => scan_folder(&self.path).map(Some),
            io::Format::Nrrd | io::Format::Nifti => Ok(None),
        }
    }
}
