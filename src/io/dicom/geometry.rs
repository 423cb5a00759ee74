//! The lattice of a stack of slices, or why there is none.
//!
//! Slices are sorted by their position along the normal, `ImagePositionPatient · (row × column)`; instance numbers play no
//! part, because nothing ties them to space. The step along k is `(last - first) / (n - 1)`: along the normal for plain
//! scans, and sheared against it under gantry tilt, which an affine map holds without resampling. Then every slice must lie
//! where the lattice puts it.

use glam::{DAffine3, DMat3, DVec3};

use super::header::Pose;
use super::series::Slice;
use crate::error::{Error, Fault, Result};

/// Slices are evenly spaced if each step is within this part of the spacing …
const RELATIVE_TOLERANCE: f64 = 0.01;
/// … or within this distance, the larger of the two, because positions are written with few decimals …
const ABSOLUTE_TOLERANCE_MM: f64 = 0.01;
/// … but never more than this part of the spacing, for scans finer than those decimals.
const TOLERANCE_CAP: f64 = 0.1;
/// Slices closer than this part of the usual spacing are at one position.
const SAME_POSITION: f64 = 0.05;
/// Slices closer than this are at one position, whatever the spacing.
const SAME_POSITION_MM: f64 = 1e-4;
/// Gaps, duplicates and so on that a message names one by one.
const NAMED_PLACES: usize = 4;

/// Slices in order, and their lattice.
#[derive(Debug, Clone)]
pub(super) struct Stack {
    /// Indices into the slices given, in order along k.
    pub(super) order: Vec<usize>,
    pub(super) index_to_lps_mm: DAffine3,
    /// Distance between neighbouring slices along the normal.
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
    pub(super) fn of(slices: &[Slice]) -> Result<Self> {
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
                let spacing_mm = in_order.usual_spacing_mm()?;
                let tolerance_mm = (RELATIVE_TOLERANCE * spacing_mm)
                    .max(ABSOLUTE_TOLERANCE_MM)
                    .min((TOLERANCE_CAP * spacing_mm).max(RELATIVE_TOLERANCE * spacing_mm));
                in_order.check_steps(spacing_mm, tolerance_mm)?;
                ((in_order.position(n - 1) - in_order.position(0)) / (n - 1) as f64, tolerance_mm, Vec::new())
            }
        };
        let deviation_mm = in_order.check_lattice(step_mm, normal, tolerance_mm)?;
        let matrix =
            DMat3::from_cols(plane.row * plane.column_spacing_mm, plane.column * plane.row_spacing_mm, step_mm);
        let last = order.len() - 1;
        Ok(Stack {
            index_to_lps_mm: DAffine3::from_mat3_translation(matrix, in_order.position(0)),
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

fn poses(slices: &[Slice]) -> Result<Vec<Pose>> {
    let lost: Vec<&Slice> = slices.iter().filter(|slice| slice.frame().pose.is_err()).collect();
    if let Some(first) = lost.first() {
        let reason = first.frame().pose.as_ref().err().cloned().unwrap_or_default();
        return Err(Error::new(Fault::Geometry, format!("the place of a slice in the patient is not known: {reason}"))
            .at(first.path())
            .found(format!("{} such slices of {}: {}", lost.len(), slices.len(), names(lost.iter().copied())))
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

/// Slices in the order of their positions.
struct Ordered<'a> {
    slices: &'a [Slice],
    poses: &'a [Pose],
    along: &'a [f64],
    order: &'a [usize],
}

impl Ordered<'_> {
    fn position(&self, k: usize) -> DVec3 {
        self.poses[self.order[k]].position_mm
    }

    fn along(&self, k: usize) -> f64 {
        self.along[self.order[k]]
    }

    fn name(&self, k: usize) -> String {
        self.slices[self.order[k]].name()
    }

    fn step(&self, k: usize) -> f64 {
        self.along(k + 1) - self.along(k)
    }

    /// The median step between distinct positions.
    fn usual_spacing_mm(&self) -> Result<f64> {
        let mut steps: Vec<f64> =
            (0..self.order.len() - 1).map(|k| self.step(k)).filter(|step| *step > SAME_POSITION_MM).collect();
        steps.sort_by(f64::total_cmp);
        match steps.get(steps.len().saturating_sub(1) / 2) {
            Some(&median) => Ok(median),
            None => Err(self.duplicates(&(0..self.order.len() - 1).collect::<Vec<_>>())),
        }
    }

    fn check_steps(&self, spacing_mm: f64, tolerance_mm: f64) -> Result<()> {
        let steps = 0..self.order.len() - 1;
        let same = SAME_POSITION_MM.max(SAME_POSITION * spacing_mm);
        let twice: Vec<usize> = steps.clone().filter(|&k| self.step(k) < same).collect();
        if !twice.is_empty() {
            return Err(self.duplicates(&twice));
        }
        let missing = |k: usize| (self.step(k) / spacing_mm).round() - 1.0;
        let uneven = |k: &usize| (self.step(*k) - spacing_mm).abs() > tolerance_mm;
        let is_gap = |k: &usize| {
            let whole = (missing(*k) + 1.0) * spacing_mm;
            missing(*k) >= 1.0 && (self.step(*k) - whole).abs() <= tolerance_mm * (missing(*k) + 1.0)
        };
        let bad: Vec<usize> = steps.filter(uneven).collect();
        let gaps: Vec<usize> = bad.iter().copied().filter(is_gap).collect();
        if bad.is_empty() {
            Ok(())
        } else if gaps.len() == bad.len() {
            let lost: f64 = gaps.iter().map(|&k| missing(k)).sum();
            Err(self
                .error(format!("slices are missing: {lost} in {} gaps", gaps.len()))
                .element(self.between(&gaps))
                .expected(format!("a slice every {spacing_mm:.4} mm"))
                .remedy("copy or export the missing slices"))
        } else {
            let worst = bad.iter().map(|&k| (self.step(k) - spacing_mm).abs()).fold(0.0, f64::max);
            Err(self
                .error("slices are not evenly spaced")
                .element(self.between(&bad))
                .found(format!("{} steps that differ from the usual one by up to {worst:.4} mm", bad.len()))
                .expected(format!("steps of {spacing_mm:.4} mm within {tolerance_mm:.4} mm"))
                .remedy("resample the series to an even spacing, or keep only the slices of one spacing"))
        }
    }

    /// Largest distance of a slice from the lattice.
    fn check_lattice(&self, step_mm: DVec3, normal: DVec3, tolerance_mm: f64) -> Result<f64> {
        let mut worst = (0.0, 0);
        for k in 0..self.order.len() {
            let off = self.position(k) - (self.position(0) + step_mm * k as f64);
            if off.length() > worst.0 {
                worst = (off.length(), k);
            }
        }
        let (deviation_mm, k) = worst;
        if deviation_mm <= tolerance_mm || self.order.len() == 1 {
            return Ok(deviation_mm);
        }
        let off = self.position(k) - (self.position(0) + step_mm * k as f64);
        let in_plane = (off - normal * off.dot(normal)).length();
        Err(self
            .error("the slices do not lie on one lattice")
            .element(format!("{} at {:.3} mm", self.name(k), self.along(k)))
            .found(format!("{deviation_mm:.4} mm from its place, {in_plane:.4} mm of it in the plane of the slice"))
            .expected(format!("within {tolerance_mm:.4} mm"))
            .remedy("resample the series, or keep only the slices of one acquisition"))
    }

    fn duplicates(&self, steps: &[usize]) -> Error {
        let places: Vec<String> = steps
            .iter()
            .take(NAMED_PLACES)
            .map(|&k| format!("{} and {} at {:.3} mm", self.name(k), self.name(k + 1), self.along(k)))
            .collect();
        let mut acquisitions: Vec<i64> = self.slices.iter().filter_map(|s| s.file().acquisition_number).collect();
        acquisitions.sort_unstable();
        acquisitions.dedup();
        let remedy = if acquisitions.len() > 1 {
            format!("keep the slices of one acquisition only; their numbers are {acquisitions:?}")
        } else {
            "keep one phase or one copy of the slices".to_owned()
        };
        self.error(format!("several slices lie at one position, {} times", steps.len()))
            .element(listed(&places, steps.len()))
            .remedy(remedy)
    }

    /// `between 12.000 mm (a.dcm) and 16.000 mm (b.dcm)`, for the first few steps.
    fn between(&self, steps: &[usize]) -> String {
        let end = |k| format!("{:.3} mm ({})", self.along(k), self.name(k));
        let places: Vec<String> =
            steps.iter().take(NAMED_PLACES).map(|&k| format!("between {} and {}", end(k), end(k + 1))).collect();
        listed(&places, steps.len())
    }

    fn error(&self, what: impl Into<String>) -> Error {
        let error = Error::new(Fault::Geometry, what);
        match self.slices[0].path().parent() {
            Some(folder) => error.at(folder),
            None => error,
        }
    }
}

fn listed(places: &[String], total: usize) -> String {
    let more = total - places.len();
    let tail = if more > 0 { format!("; and {more} more") } else { String::new() };
    format!("{}{tail}", places.join("; "))
}

fn names<'a>(slices: impl Iterator<Item = &'a Slice>) -> String {
    let all: Vec<String> = slices.map(Slice::name).collect();
    listed(&all[..all.len().min(NAMED_PLACES)], all.len())
}
