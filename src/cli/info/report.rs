//! What `info` knows of a scan, in the form of its JSON.

use std::collections::BTreeMap;

use pellucid::Volume;
use pellucid::io::dicom::{Folder, Series, Verdict};
use pellucid::io::{FileFate, Scan};
use pellucid::volume::Quantity;
use serde::Serialize;

/// What is in a scan. The fields of the volume are absent where none could be made.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    /// Geometry and values.
    #[serde(flatten)]
    pub(super) volume: Option<VolumeReport>,
    /// The series of a DICOM folder.
    pub(super) series: Vec<SeriesReport>,
    /// What became of each file.
    pub(super) files: Vec<FileReport>,
    /// What a careful user should know.
    pub(super) warnings: Vec<String>,
    /// What the reader has to say, by label.
    pub(super) facts: BTreeMap<String, String>,
}

/// Geometry and values of a volume.
#[derive(Debug, Serialize)]
pub(super) struct VolumeReport {
    /// Voxels along i, j and k.
    pub(super) dims: [usize; 3],
    /// Voxel index to LPS mm, three rows of four numbers.
    pub(super) index_to_lps_mm: [[f64; 4]; 3],
    /// Length of one step along i, j and k, mm; the mean step along k where slices are uneven.
    pub(super) spacing_mm: [f64; 3],
    /// Distance of each slice from the first along k, mm, where they are uneven.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) slice_positions_mm: Option<Vec<f64>>,
    /// Smallest and largest value.
    pub(super) value_range: [f64; 2],
    /// What the values measure: `hu` or `arbitrary`; `rgba` where they are the alphas of colours.
    pub(super) quantity: &'static str,
    /// SHA-256 of the values.
    pub(super) values_sha256: String,
}

/// A series of a DICOM folder.
#[derive(Debug, Serialize)]
pub(super) struct SeriesReport {
    /// Series Instance UID.
    pub(super) uid: String,
    /// Series Number.
    pub(super) number: Option<i64>,
    /// Series Description.
    pub(super) description: String,
    /// Such as CT.
    pub(super) modality: String,
    /// Columns, rows, slices.
    pub(super) dims: [usize; 3],
    /// Distance between columns, rows and slices, mm.
    pub(super) spacing_mm: Option<[f64; 3]>,
    /// Names of the transfer syntaxes.
    pub(super) transfer_syntax: String,
    /// True if this build decodes them.
    pub(super) decodable: bool,
    /// Why it cannot be read as a volume, if it cannot.
    pub(super) refused: Option<String>,
}

/// What became of a file.
#[derive(Debug, Serialize)]
pub(super) struct FileReport {
    /// The file.
    pub(super) path: String,
    /// True if the volume holds its samples.
    pub(super) used: bool,
    /// Why it was used or left out.
    pub(super) reason: String,
}

impl Report {
    /// The report on a scan, or on what was found where no volume could be made.
    pub(super) fn new(folder: Option<&Folder>, scan: Option<&Scan>) -> Self {
        let files = match (scan, folder) {
            (Some(scan), _) => scan.files.iter().map(FileReport::from).collect(),
            (None, Some(folder)) => files_of_no_volume(folder),
            (None, None) => Vec::new(),
        };
        Report {
            volume: scan.map(|scan| VolumeReport::from(&scan.volume)),
            series: folder.map(|folder| folder.series.iter().map(SeriesReport::from).collect()).unwrap_or_default(),
            files,
            warnings: scan.map(|scan| scan.warnings.clone()).unwrap_or_default(),
            facts: scan.map(|scan| scan.facts.iter().cloned().collect()).unwrap_or_default(),
        }
    }
}

/// The files of a folder of which no volume was made.
fn files_of_no_volume(folder: &Folder) -> Vec<FileReport> {
    let of_series = folder.series.iter().flat_map(|series| {
        series.files().into_iter().map(|(path, _)| FileReport {
            path: path.display().to_string(),
            used: false,
            reason: match &series.verdict {
                Verdict::Renderable => format!("not chosen: {}", series.label()),
                Verdict::Refused { reason, .. } => reason.clone(),
            },
        })
    });
    of_series.chain(folder.others.iter().map(FileReport::from)).collect()
}

impl From<&Volume> for VolumeReport {
    fn from(volume: &Volume) -> Self {
        VolumeReport {
            dims: volume.grid().dims(),
            index_to_lps_mm: volume.grid().index_to_lps_mm_rows(),
            spacing_mm: volume.grid().spacing_mm().to_array(),
            slice_positions_mm: volume.slice_positions_mm(),
            value_range: volume.value_range(),
            quantity: match volume.quantity() {
                _ if volume.samples().are_rgba() => "rgba",
                Quantity::Hu => "hu",
                Quantity::Arbitrary => "arbitrary",
            },
            values_sha256: volume.values_sha256(),
        }
    }
}

impl From<&Series> for SeriesReport {
    fn from(series: &Series) -> Self {
        SeriesReport {
            uid: series.uid.clone(),
            number: series.number,
            description: series.description.clone(),
            modality: series.modality.clone(),
            dims: series.dims,
            spacing_mm: series.spacing_mm,
            transfer_syntax: series.transfer_syntax.clone(),
            decodable: series.decodable,
            refused: match &series.verdict {
                Verdict::Renderable => None,
                Verdict::Refused { reason, .. } => Some(reason.clone()),
            },
        }
    }
}

impl From<&FileFate> for FileReport {
    fn from(fate: &FileFate) -> Self {
        FileReport { path: fate.path.display().to_string(), used: fate.used, reason: fate.reason.clone() }
    }
}
