//! The lattice of a stack of slices, or why there is none.
//!
//! Slices are sorted by their position along the normal, `ImagePositionPatient · (row × column)`; instance numbers play no
//! part, because nothing ties them to space. The step along k is `(last - first) / (n - 1)`: along the normal for plain
//! scans, and sheared against it under gantry tilt, which an affine map holds without resampling. Then every slice must lie
//! where the lattice puts it: at even steps, or, if that is asked for, at its own place along the step.

use glam::{DAffine3, DMat3, DVec3};

use super::header::Pose;
use super::series::Slice;
use super::spacing::{Ordered, SliceSpacing, listed, tolerance_mm};
use crate::error::{Error, Fault, Result};
use crate::volume::Slices;

/// Slices in order, and their lattice.
#[derive(Debug, Clone)]
pub(super) struct Stack {
    /// Indices into the slices given, in order along k.
    pub(super) order: Vec<usize>,
    pub(super) index_to_lps_mm: DAffine3,
    /// Their places, where they are uneven.
    pub(super) slices: Option<Slices>,
    /// Distance between neighbouring slices along the normal; the mean if they are uneven.
    pub(super) spacing_mm: f64,
    /// Positions of the first and last slice along the normal.
    pub(super) range_mm: [f64; 2],
    /// Largest distance of a slice from its place in the lattice.
    pub(super) deviation_mm: f64,
    /// Largest such distance that is accepted.
    pub(super) tolerance_mm: f64,
    /// Angle between the k axis and the normal.
    pub(super) tilt_degrees: f64,
    /// What had to be assumed.
    pub(super) warnings: Vec<String>,
}

impl Stack {
    /// The stack of these slices, whose orientation and pixel spacing agree.
    pub(super) fn of(slices: &[Slice], spacing: SliceSpacing) -> Result<Self> {
        let poses = poses(slices)?;
        let plane = poses[0];
        let normal = plane.normal();
        let along: Vec<f64> = poses.iter().map(|pose| pose.position_mm.dot(normal)).collect();
        let mut order: Vec<usize> = (0..slices.len()).collect();
        // Equal positions are refused below; the file name only makes the message the same each time.
        order.sort_by(|&a, &b| along[a].total_cmp(&along[b]).then_with(|| slices[a].path().cmp(slices[b].path())));
        let in_order = Ordered { slices, poses: &poses, along: &along, order: &order };
        let (step_mm, tolerance_mm, warnings) = match slices.len() {
            1 => {
                let (thickness_mm, warning) = thickness(&slices[0]);
                (normal * thickness_mm, 0.0, vec![warning])
            }
            n => {
                let tolerance_mm = tolerance_mm(in_order.usual_spacing_mm()?);
                ((in_order.position(n - 1) - in_order.position(0)) / (n - 1) as f64, tolerance_mm, Vec::new())
            }
        };
        let (places, deviation_mm) = match in_order.even(step_mm, normal, tolerance_mm) {
            Ok(deviation_mm) => (None, deviation_mm),
            Err(error) if spacing == SliceSpacing::Even => return Err(error),
            Err(_) => {
                let (places, deviation_mm) = in_order.uneven(step_mm, normal, tolerance_mm)?;
                (Some(places), deviation_mm)
            }
        };
        let matrix =
            DMat3::from_cols(plane.row * plane.column_spacing_mm, plane.column * plane.row_spacing_mm, step_mm);
        let last = order.len() - 1;
        Ok(Stack {
            index_to_lps_mm: DAffine3::from_mat3_translation(matrix, in_order.position(0)),
            slices: places,
            spacing_mm: step_mm.dot(normal),
            range_mm: [along[order[0]], along[order[last]]],
            deviation_mm,
            tolerance_mm,
            tilt_degrees: step_mm.angle_between(normal).to_degrees(),
            warnings,
            order,
        })
    }
}

impl Ordered<'_> {
    /// Holds the slices to one step, and gives the largest distance of one from its place.
    fn even(&self, step_mm: DVec3, normal: DVec3, tolerance_mm: f64) -> Result<f64> {
        if self.order.len() > 1 {
            let spacing_mm = self.usual_spacing_mm()?;
            self.check_steps(spacing_mm, tolerance_mm)?;
        }
        self.check_lattice(step_mm, None, normal, tolerance_mm)
    }

    /// The places of slices whose step may change, and the largest distance of one from it.
    fn uneven(&self, step_mm: DVec3, normal: DVec3, tolerance_mm: f64) -> Result<(Slices, f64)> {
        self.check_uneven_steps()?;
        let along: Vec<f64> = self.order.iter().map(|&slice| self.along[slice]).collect();
        let places = Slices::new(&along)?;
        let deviation_mm = self.check_lattice(step_mm, Some(&places), normal, tolerance_mm)?;
        Ok((places, deviation_mm))
    }
}

fn poses(slices: &[Slice]) -> Result<Vec<Pose>> {
    let lost: Vec<&Slice> = slices.iter().filter(|slice| slice.frame().pose.is_err()).collect();
    if let Some(first) = lost.first() {
        let reason = first.frame().pose.as_ref().err().cloned().unwrap_or_default();
        return Err(Error::new(Fault::Geometry, format!("the place of a slice in the patient is not known: {reason}"))
            .at(first.path())
            .found(format!(
                "{} such slices of {}: {}",
                lost.len(),
                slices.len(),
                listed(lost.iter().map(|slice| slice.name()).collect())
            ))
            .remedy("export the series again with its geometry, or remove these files"));
    }
    Ok(slices.iter().filter_map(|slice| slice.frame().pose.clone().ok()).collect())
}

/// Extent of a single slice along its normal, and the warning that says where it comes from.
fn thickness(slice: &Slice) -> (f64, String) {
    let usable = |value: Option<f64>| value.filter(|mm| *mm > 0.0);
    let file = slice.file();
    if let Some(mm) = usable(file.spacing_between_slices_mm) {
        (mm, format!("one slice only: its extent is taken from Spacing Between Slices, {mm} mm"))
    } else if let Some(mm) = usable(file.slice_thickness_mm) {
        (mm, format!("one slice only: its extent is taken from Slice Thickness, {mm} mm"))
    } else {
        (1.0, "one slice only, of no stated thickness: its extent is taken to be 1 mm".to_owned())
    }
}
