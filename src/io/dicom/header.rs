//! What a file says about its image, read without its pixels.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use dicom_dictionary_std::{tags, uids};
use dicom_object::{InMemDicomObject, OpenFileOptions};
use glam::DVec3;

use super::attributes::{Malformed, decimal, decimals, integer, name_of, required, text};
use super::functional_groups::FrameAttributes;
use super::pixels::PixelFormat;
use crate::volume::Rescale;

/// The header of an image file. No name, identifier or date of a patient is read into it.
#[derive(Debug, Clone)]
pub(super) struct ImageFile {
    pub(super) path: PathBuf,
    /// Size of the file.
    pub(super) bytes: u64,
    pub(super) series_uid: String,
    pub(super) series_number: Option<i64>,
    pub(super) description: String,
    pub(super) modality: String,
    pub(super) acquisition_number: Option<i64>,
    pub(super) frame_of_reference_uid: String,
    /// The first three values of Image Type: pixels original or derived, primary or secondary, AXIAL or LOCALIZER.
    pub(super) image_type: Vec<String>,
    pub(super) transfer_syntax_uid: String,
    pub(super) lossy: bool,
    pub(super) format: PixelFormat,
    pub(super) rescale_type: Option<String>,
    /// True where a look-up table takes the place of slope and intercept.
    pub(super) has_modality_lut: bool,
    pub(super) slice_thickness_mm: Option<f64>,
    pub(super) spacing_between_slices_mm: Option<f64>,
    pub(super) frames: Vec<FrameHeader>,
}

/// What a file says about one of its frames.
#[derive(Debug, Clone)]
pub(super) struct FrameHeader {
    /// Position and orientation, or why they are not known.
    pub(super) pose: Result<Pose, String>,
    /// Slope and intercept; `None` if the file gives none.
    pub(super) rescale: Result<Option<Rescale>, String>,
}

/// Where a frame lies: the Image Plane Module (PS3.3 §C.7.6.2.1.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pose {
    /// Centre of the first pixel, LPS mm.
    pub(super) position_mm: DVec3,
    /// Unit direction in which the column index grows (along a row).
    pub(super) row: DVec3,
    /// Unit direction in which the row index grows (down a column).
    pub(super) column: DVec3,
    /// Distance between the centres of neighbouring columns.
    pub(super) column_spacing_mm: f64,
    /// Distance between the centres of neighbouring rows.
    pub(super) row_spacing_mm: f64,
}

impl Pose {
    /// Unit normal of the plane, `row × column`: the direction along which slices are sorted.
    pub(super) fn normal(&self) -> DVec3 {
        self.row.cross(self.column).normalize()
    }
}

/// Direction cosines come as rounded decimal text: one part in a thousand is rounding, more is damage.
const COSINE_TOLERANCE: f64 = 1e-3;

/// Frames whose headers are read from one file; the standard's largest CT objects have a few thousand.
const MAX_FRAMES: usize = 100_000;

/// Why a file is not taken for an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Rejected {
    /// One clause.
    pub(super) reason: String,
    /// True if it may be an image that was damaged, false if it is something else.
    pub(super) is_damaged: bool,
}

/// Reads the header of an image file.
pub(super) fn read_header(path: &Path) -> Result<ImageFile, Rejected> {
    let damaged = |reason: String| Rejected { reason, is_damaged: true };
    let other = |reason: &str| Rejected { reason: reason.to_owned(), is_damaged: false };
    let unreadable = |error: std::io::Error| damaged(format!("cannot be read: {error}"));
    let bytes = std::fs::metadata(path).map_err(unreadable)?.len();
    if !has_dicom_prefix(path).map_err(unreadable)? {
        return Err(other("not a DICOM file (no 'DICM' at byte 128)"));
    }
    let object = OpenFileOptions::new()
        .read_until(tags::PIXEL_DATA)
        .open_file(path)
        .map_err(|error| damaged(format!("the header cannot be read: {}", super::deepest(&error))))?;
    let class = object.meta().media_storage_sop_class_uid().trim_end_matches('\0');
    if class == uids::MEDIA_STORAGE_DIRECTORY_STORAGE {
        return Err(other("a DICOMDIR: an index of files, not an image"));
    }
    let transfer_syntax_uid = object.meta().transfer_syntax().to_owned();
    let modality = text(&object, tags::MODALITY).unwrap_or_default();
    if object.get(tags::ROWS).is_none() {
        return Err(other(&format!("not an image (modality '{modality}')")));
    }
    image_file(&object, path, bytes, transfer_syntax_uid, modality).map_err(|Malformed(reason)| damaged(reason))
}

fn has_dicom_prefix(path: &Path) -> std::io::Result<bool> {
    let mut start = Vec::with_capacity(132);
    File::open(path)?.take(132).read_to_end(&mut start)?;
    Ok(start.get(128..) == Some(b"DICM"))
}

fn image_file(
    object: &InMemDicomObject,
    path: &Path,
    bytes: u64,
    transfer_syntax_uid: String,
    modality: String,
) -> Result<ImageFile, Malformed> {
    let frame_count = integer(object, tags::NUMBER_OF_FRAMES)?.unwrap_or(1);
    let frame_count = usize::try_from(frame_count)
        .ok()
        .filter(|n| (1..=MAX_FRAMES).contains(n))
        .ok_or_else(|| Malformed(format!("{} is {frame_count}", name_of(tags::NUMBER_OF_FRAMES))))?;
    let first = FrameAttributes::of(object, 0);
    let measures = first.group(tags::PIXEL_MEASURES_SEQUENCE);
    let transformation = first.group(tags::PIXEL_VALUE_TRANSFORMATION_SEQUENCE);
    let image_type = text(object, tags::IMAGE_TYPE).unwrap_or_default();
    Ok(ImageFile {
        path: path.to_path_buf(),
        bytes,
        series_uid: text(object, tags::SERIES_INSTANCE_UID).unwrap_or_default(),
        series_number: integer(object, tags::SERIES_NUMBER).unwrap_or(None),
        description: text(object, tags::SERIES_DESCRIPTION).unwrap_or_default(),
        modality,
        acquisition_number: integer(object, tags::ACQUISITION_NUMBER).unwrap_or(None),
        frame_of_reference_uid: text(object, tags::FRAME_OF_REFERENCE_UID).unwrap_or_default(),
        image_type: image_type.split('\\').take(3).map(|value| value.trim().to_owned()).collect(),
        transfer_syntax_uid,
        lossy: text(object, tags::LOSSY_IMAGE_COMPRESSION).as_deref() == Some("01"),
        format: PixelFormat::of(object)?,
        rescale_type: text(transformation, tags::RESCALE_TYPE),
        has_modality_lut: object.get(tags::MODALITY_LUT_SEQUENCE).is_some(),
        slice_thickness_mm: decimal(measures, tags::SLICE_THICKNESS).unwrap_or(None),
        spacing_between_slices_mm: decimal(measures, tags::SPACING_BETWEEN_SLICES).unwrap_or(None),
        frames: (0..frame_count).map(|index| frame_header(object, index, frame_count)).collect(),
    })
}

fn frame_header(object: &InMemDicomObject, index: usize, frame_count: usize) -> FrameHeader {
    let attributes = FrameAttributes::of(object, index);
    let pose = pose(&attributes, object, frame_count).map_err(|Malformed(reason)| reason);
    let transformation = attributes.group(tags::PIXEL_VALUE_TRANSFORMATION_SEQUENCE);
    FrameHeader { pose, rescale: rescale(transformation).map_err(|Malformed(reason)| reason) }
}

fn pose(attributes: &FrameAttributes, root: &InMemDicomObject, frame_count: usize) -> Result<Pose, Malformed> {
    let position_group = attributes.group(tags::PLANE_POSITION_SEQUENCE);
    if frame_count > 1 && std::ptr::eq(position_group, root) {
        // One position at the root cannot be that of several frames.
        return Err(Malformed(format!("{frame_count} frames without a position for each")));
    }
    let position: [f64; 3] =
        required(decimals(position_group, tags::IMAGE_POSITION_PATIENT), tags::IMAGE_POSITION_PATIENT)?;
    let cosines: [f64; 6] = required(
        decimals(attributes.group(tags::PLANE_ORIENTATION_SEQUENCE), tags::IMAGE_ORIENTATION_PATIENT),
        tags::IMAGE_ORIENTATION_PATIENT,
    )?;
    let [row_spacing_mm, column_spacing_mm]: [f64; 2] =
        required(decimals(attributes.group(tags::PIXEL_MEASURES_SEQUENCE), tags::PIXEL_SPACING), tags::PIXEL_SPACING)?;
    if !(row_spacing_mm > 0.0 && column_spacing_mm > 0.0) {
        return Err(Malformed(format!(
            "{} is {row_spacing_mm}\\{column_spacing_mm}, not two distances",
            name_of(tags::PIXEL_SPACING)
        )));
    }
    let row = DVec3::new(cosines[0], cosines[1], cosines[2]);
    let column = DVec3::new(cosines[3], cosines[4], cosines[5]);
    let unit = |v: DVec3| (v.length() - 1.0).abs() <= COSINE_TOLERANCE;
    if !(unit(row) && unit(column) && row.dot(column).abs() <= COSINE_TOLERANCE) {
        return Err(Malformed(format!(
            "{} is {row} and {column}, not two unit vectors at a right angle",
            name_of(tags::IMAGE_ORIENTATION_PATIENT)
        )));
    }
    Ok(Pose {
        position_mm: DVec3::from_array(position),
        row: row.normalize(),
        column: column.normalize(),
        column_spacing_mm,
        row_spacing_mm,
    })
}

fn rescale(group: &InMemDicomObject) -> Result<Option<Rescale>, Malformed> {
    let slope = decimal(group, tags::RESCALE_SLOPE)?;
    let intercept = decimal(group, tags::RESCALE_INTERCEPT)?;
    match (slope, intercept) {
        (Some(0.0), _) => Err(Malformed(format!("{} is 0", name_of(tags::RESCALE_SLOPE)))),
        (Some(slope), Some(intercept)) => Ok(Some(Rescale { slope, intercept })),
        (None, None) => Ok(None),
        // Each is of type 1 where the other is present (PS3.3 §C.11.1).
        (Some(_), None) => Err(Malformed(format!("{} is missing", name_of(tags::RESCALE_INTERCEPT)))),
        (None, Some(_)) => Err(Malformed(format!("{} is missing", name_of(tags::RESCALE_SLOPE)))),
    }
}
