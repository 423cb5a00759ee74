//! Which slices belong to one series and geometry.

use super::header::Pose;
use super::series::Slice;

/// Direction cosines of one series agree within this.
const ORIENTATION_TOLERANCE: f64 = 1e-4;
/// Pixel spacings of one series agree within this part.
const SPACING_TOLERANCE: f64 = 1e-4;

/// Slices gathered under one series and geometry.
pub(super) struct Group {
    pub(super) slices: Vec<Slice>,
    pose: Option<Pose>,
}

impl Group {
    /// Sorts slices into groups: by Series Instance UID, Frame of Reference, Image Type, rows and columns, orientation and
    /// pixel spacing. A slice without a place joins its series all the same, so that the series is refused rather than
    /// read with a slice less.
    pub(super) fn gather(slices: Vec<Slice>) -> Vec<Group> {
        let (placed, lost): (Vec<Slice>, Vec<Slice>) = slices.into_iter().partition(|s| s.frame().pose.is_ok());
        let mut groups: Vec<Group> = Vec::new();
        for slice in placed.into_iter().chain(lost) {
            match groups.iter_mut().find(|group| group.takes(&slice)) {
                Some(group) => group.slices.push(slice),
                None => groups.push(Group { pose: slice.frame().pose.clone().ok(), slices: vec![slice] }),
            }
        }
        groups
    }

    fn takes(&self, slice: &Slice) -> bool {
        let (own, other) = (self.slices[0].file(), slice.file());
        own.series_uid == other.series_uid
            && own.modality == other.modality
            && own.frame_of_reference_uid == other.frame_of_reference_uid
            && own.image_type == other.image_type
            && (own.format.rows, own.format.columns) == (other.format.rows, other.format.columns)
            && match (&self.pose, &slice.frame().pose) {
                (Some(a), Ok(b)) => is_same_geometry(a, b),
                _ => true,
            }
    }
}

fn is_same_geometry(a: &Pose, b: &Pose) -> bool {
    let close = |x: f64, y: f64| (x - y).abs() <= SPACING_TOLERANCE * x.abs().max(y.abs());
    (a.row - b.row).abs().max_element() <= ORIENTATION_TOLERANCE
        && (a.column - b.column).abs().max_element() <= ORIENTATION_TOLERANCE
        && close(a.column_spacing_mm, b.column_spacing_mm)
        && close(a.row_spacing_mm, b.row_spacing_mm)
}
