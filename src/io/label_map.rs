//! Label maps: which file format, and numbers of voxels to tissues.

use std::path::Path;

use super::dicom::SeriesChoice;
use super::load::{Format, format_of};
use super::nrrd::segmentation;
use super::{load, nifti, nrrd};
use crate::error::{Error, Fault, Result};
use crate::volume::{LabelMap, MOST_SEGMENTS, Segment, Volume};

/// What label maps may be written as, as messages say it.
const WRITTEN: &str = "a name that ends in .seg.nrrd, .nrrd, .nii or .nii.gz";

/// File formats of label maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LabelFormat {
    /// 3D Slicer's segmentation: labels with names, colours and terminology.
    SegNrrd,
    /// Labels as NRRD.
    Nrrd,
    /// Labels as NIfTI-1.
    Nifti,
}

impl LabelFormat {
    /// The format that a file's name asks for.
    ///
    /// # Errors
    /// `Fault::Output` for a name that asks for none.
    pub fn of(path: &Path) -> Result<Self> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        let formats = [
            (".seg.nrrd", LabelFormat::SegNrrd),
            (".nrrd", LabelFormat::Nrrd),
            (".nii", LabelFormat::Nifti),
            (".nii.gz", LabelFormat::Nifti),
        ];
        let found = formats.into_iter().find(|(suffix, _)| name.ends_with(suffix)).map(|(_, format)| format);
        found.ok_or_else(|| {
            Error::new(Fault::Output, "the name of the label map says no format").at(path).expected(WRITTEN)
        })
    }
}

/// Writes a label map in the format that its name asks for.
///
/// # Errors
/// As [`LabelFormat::of`], and `Fault::Output` if the file cannot be written.
pub fn write_labels(path: &Path, labels: &LabelMap) -> Result<()> {
    match LabelFormat::of(path)? {
        LabelFormat::SegNrrd => segmentation::write_label_map(path, labels, true),
        LabelFormat::Nrrd => segmentation::write_label_map(path, labels, false),
        LabelFormat::Nifti => nifti::write_label_map(path, labels),
    }
}

/// Reads a label map from NRRD or NIfTI: each number but 0 is a tissue, with the name that a `.seg.nrrd` gives it, or the
/// number itself.
///
/// # Errors
/// As the readers; `Fault::Input` for values that are no whole numbers from 0 to 65535, `Fault::Unsupported` for DICOM, more
/// than 255 different labels, and segments that overlap.
pub fn read_labels(path: &Path) -> Result<LabelMap> {
    let described = match format_of(path)? {
        Format::Nrrd => {
            let (header, _) = nrrd::read_header(path)?;
            segmentation::described(&header).map_err(|error| error.at(path))?
        }
        Format::Nifti => Vec::new(),
        Format::Dicom => {
            return Err(Error::new(Fault::Unsupported, "labels are not read from DICOM")
                .at(path)
                .expected("NRRD or NIfTI"));
        }
    };
    let volume = load(path, &SeriesChoice::Largest, None)?.volume;
    labels_of(&volume, &described).map_err(|error| error.at(path))
}

fn labels_of(volume: &Volume, described: &[segmentation::Described]) -> Result<LabelMap> {
    let (samples, rescale) = (volume.samples(), volume.rescale());
    let mut present = vec![false; 1 << 16];
    for index in 0..samples.len() {
        let value = rescale.value(samples.stored(index));
        let is_label = value.fract() == 0.0 && (0.0..=65535.0).contains(&value);
        if !is_label {
            let [i, j, k] = volume.grid().unflatten(index);
            return Err(Error::new(Fault::Input, "this is no label map")
                .element(format!("voxel ({i}, {j}, {k})"))
                .found(value.to_string())
                .expected("a whole number from 0 to 65535"));
        }
        present[value as usize] = true;
    }
    // Tissues without a voxel are tissues too.
    described.iter().for_each(|segment| present[usize::from(segment.label)] = true);
    let labels: Vec<u16> = (1..=u16::MAX).filter(|label| present[usize::from(*label)]).collect();
    if labels.len() > MOST_SEGMENTS {
        return Err(Error::new(Fault::Unsupported, "a label map has at most 255 tissues")
            .found(format!("{} different labels", labels.len())));
    }
    let mut positions = vec![0_u8; 1 << 16];
    let mut segments = Vec::new();
    for (n, label) in labels.iter().enumerate() {
        // At most 255.
        positions[usize::from(*label)] = (n + 1) as u8;
        let described = described.iter().find(|segment| segment.label == *label);
        segments.push(Segment {
            name: described.map_or_else(|| label.to_string(), |segment| segment.name.clone()),
            label: *label,
            color_srgb: described.and_then(|segment| segment.color_srgb).unwrap_or([0.5; 3]),
            concept: described.and_then(|segment| segment.concept.clone()),
        });
    }
    let voxel = |index: usize| positions[rescale.value(samples.stored(index)) as usize];
    LabelMap::new(*volume.grid(), segments, (0..samples.len()).map(voxel).collect())
}
