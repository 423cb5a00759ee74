//! `pellucid info`: what is in a scan.

mod histogram;
mod report;
mod text;

use std::path::{Path, PathBuf};

use pellucid::Result;
use pellucid::io::dicom::{Folder, SeriesChoice, scan_folder};
use pellucid::io::{self, Scan, load};
use pellucid::pipeline::{self, Options, memory};
use pellucid::spec::Spec;

use super::{Format, stdout};
use report::Report;

/// Arguments of `pellucid info`.
#[derive(Debug, clap::Args)]
pub(super) struct Info {
    /// A folder of DICOM files, a DICOM file, a .nrrd, .nhdr, .nii or .nii.gz file, or a pipeline, whose volume is meant
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
        let scan = self.scan();
        let report = Report::new(folder.as_ref(), scan.as_ref().ok());
        match self.format {
            Format::Text => stdout::print(&text::of(&report, scan.as_ref().ok()))?,
            Format::Json => stdout::print_json(&report)?,
        }
        scan.map(|_| ())
    }

    fn scan(&self) -> Result<Scan> {
        if is_pipeline(&self.path) {
            let series = self.series.iter().map(|series| format!("volume.series={series}"));
            return pipeline::load(&Spec::load(&self.path, &series.collect::<Vec<_>>())?, &Options::default());
        }
        let choice = self.series.clone().map_or(SeriesChoice::Largest, SeriesChoice::Named);
        load(&self.path, &choice, memory::limit_bytes(&Options::default()))
    }

    /// The series of a DICOM folder that is named itself.
    fn folder(&self) -> Result<Option<Folder>> {
        if is_pipeline(&self.path) {
            return Ok(None);
        }
        match io::format_of(&self.path)? {
            io::Format::Dicom => scan_folder(&self.path).map(Some),
            io::Format::Nrrd | io::Format::Nifti => Ok(None),
        }
    }
}

fn is_pipeline(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "yaml" || extension == "yml")
}
