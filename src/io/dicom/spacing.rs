//! Whether slices in order are evenly spaced, or at least complete: gaps, duplicates, uneven and shifted slices, each named
//! with its place.

use glam::DVec3;

use super::header::Pose;
use super::series::Slice;
use crate::error::{Error, Fault, Result};
use crate::volume::Slices;

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
/// What can be done with slices that were planned at changing distances.
const AS_THEY_ARE: &str = "read the slices where they lie with `volume: { slices: uneven }`";
/// Gaps, duplicates and so on that a message names one by one.
const NAMED_PLACES: usize = 4;

/// Whether the distance from slice to slice may change.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SliceSpacing {
    /// It must not: a series whose distance changes is refused.
    #[default]
    Even,
    /// It may, and then the volume is rectilinear; a series whose distance does not change is as ever. A step that is a
    /// multiple of those on both its sides is still a gap.
    Uneven,
}

/// How far from its place a slice may be, for slices this far apart.
pub(super) fn tolerance_mm(spacing_mm: f64) -> f64 {
    let least = RELATIVE_TOLERANCE * spacing_mm;
    least.max(ABSOLUTE_TOLERANCE_MM.min(TOLERANCE_CAP * spacing_mm))
}

/// Slices in the order of their positions.
pub(super) struct Ordered<'a> {
    pub(super) slices: &'a [Slice],
    pub(super) poses: &'a [Pose],
    pub(super) along: &'a [f64],
    pub(super) order: &'a [usize],
}

impl Ordered<'_> {
    pub(super) fn position(&self, k: usize) -> DVec3 {
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
    pub(super) fn usual_spacing_mm(&self) -> Result<f64> {
        let mut steps: Vec<f64> =
            (0..self.order.len() - 1).map(|k| self.step(k)).filter(|step| *step > SAME_POSITION_MM).collect();
        steps.sort_by(f64::total_cmp);
        match steps.get(steps.len().saturating_sub(1) / 2) {
            Some(&median) => Ok(median),
            None => Err(self.duplicates(&(0..self.order.len() - 1).collect::<Vec<_>>())),
        }
    }

    pub(super) fn check_steps(&self, spacing_mm: f64, tolerance_mm: f64) -> Result<()> {
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
                .missing(lost, &gaps)
                .expected(format!("a slice every {spacing_mm:.4} mm"))
                .remedy(format!("copy or export the missing slices; if none were left out, {AS_THEY_ARE}")))
        } else {
            let worst = bad.iter().map(|&k| (self.step(k) - spacing_mm).abs()).fold(0.0, f64::max);
            Err(self
                .error("slices are not evenly spaced")
                .element(self.between(&bad))
                .found(format!("{} steps that differ from the usual one by up to {worst:.4} mm", bad.len()))
                .expected(format!("steps of {spacing_mm:.4} mm within {tolerance_mm:.4} mm"))
                .remedy(format!("{AS_THEY_ARE}, or keep only the slices of one spacing")))
        }
    }

    /// Refuses gaps and duplicates among steps that may change: each step is judged by those beside it.
    pub(super) fn check_uneven_steps(&self) -> Result<()> {
        let count = self.order.len() - 1;
        let beside = |k: usize| [k.checked_sub(1), (k + 1 < count).then_some(k + 1)].into_iter().flatten();
        let least = |k: usize| beside(k).map(|n| self.step(n)).fold(f64::INFINITY, f64::min);
        let most = |k: usize| beside(k).map(|n| self.step(n)).fold(0.0, f64::max);
        let twice = |&k: &usize| {
            let same = if least(k).is_finite() { SAME_POSITION * least(k) } else { 0.0 };
            self.step(k) < same.max(SAME_POSITION_MM)
        };
        let twice: Vec<usize> = (0..count).filter(twice).collect();
        if !twice.is_empty() {
            return Err(self.duplicates(&twice));
        }
        let multiple = |k: usize| if most(k) > 0.0 { (self.step(k) / most(k)).round() } else { 1.0 };
        let is_gap = |&k: &usize| {
            multiple(k) >= 2.0 && (self.step(k) - multiple(k) * most(k)).abs() <= tolerance_mm(self.step(k))
        };
        let gaps: Vec<usize> = (0..count).filter(is_gap).collect();
        if gaps.is_empty() {
            return Ok(());
        }
        let lost = gaps.iter().map(|&k| multiple(k) - 1.0).sum();
        Err(self
            .missing(lost, &gaps)
            .expected("steps that are no multiple of those on both their sides")
            .remedy("copy or export the missing slices"))
    }

    fn missing(&self, lost: f64, gaps: &[usize]) -> Error {
        self.error(format!("slices are missing: {lost} in {} gaps", gaps.len())).element(self.between(gaps))
    }

    /// Largest distance of a slice from the lattice.
    pub(super) fn check_lattice(
        &self,
        step_mm: DVec3,
        slices: Option<&Slices>,
        normal: DVec3,
        tolerance_mm: f64,
    ) -> Result<f64> {
        let place = |k: usize| slices.map_or(k as f64, |slices| slices.positions()[k]);
        let off = |k: usize| self.position(k) - (self.position(0) + step_mm * place(k));
        let mut worst = (0.0, 0);
        for k in 0..self.order.len() {
            let off = off(k);
            if off.length() > worst.0 {
                worst = (off.length(), k);
            }
        }
        let (deviation_mm, k) = worst;
        if deviation_mm <= tolerance_mm || self.order.len() == 1 {
            return Ok(deviation_mm);
        }
        let off = off(k);
        let in_plane = (off - normal * off.dot(normal)).length();
        Err(self
            .error("the slices do not lie on one lattice")
            .element(format!("{} at {:.3} mm", self.name(k), self.along(k)))
            .found(format!("{deviation_mm:.4} mm from its place, {in_plane:.4} mm of it in the plane of the slice"))
            .expected(format!("within {tolerance_mm:.4} mm"))
            .remedy("resample the series, or keep only the slices of one acquisition"))
    }

    fn duplicates(&self, steps: &[usize]) -> Error {
        let place = |&k: &usize| format!("{} and {} at {:.3} mm", self.name(k), self.name(k + 1), self.along(k));
        let mut acquisitions: Vec<i64> = self.slices.iter().filter_map(|s| s.file().acquisition_number).collect();
        acquisitions.sort_unstable();
        acquisitions.dedup();
        let remedy = if acquisitions.len() > 1 {
            format!("keep the slices of one acquisition only; their numbers are {acquisitions:?}")
        } else {
            "keep one phase or one copy of the slices".to_owned()
        };
        self.error(format!("several slices lie at one position, {} times", steps.len()))
            .element(listed(steps.iter().map(place).collect()))
            .remedy(remedy)
    }

    /// `between 12.000 mm (a.dcm) and 16.000 mm (b.dcm)`, for the first few steps.
    fn between(&self, steps: &[usize]) -> String {
        let end = |k| format!("{:.3} mm ({})", self.along(k), self.name(k));
        listed(steps.iter().map(|&k| format!("between {} and {}", end(k), end(k + 1))).collect())
    }

    fn error(&self, what: impl Into<String>) -> Error {
        let error = Error::new(Fault::Geometry, what);
        match self.slices[0].path().parent() {
            Some(folder) => error.at(folder),
            None => error,
        }
    }
}

/// The first few of these, and how many more there are.
pub(super) fn listed(mut places: Vec<String>) -> String {
    let more = places.len().saturating_sub(NAMED_PLACES);
    places.truncate(NAMED_PLACES);
    let tail = if more > 0 { format!("; and {more} more") } else { String::new() };
    format!("{}{tail}", places.join("; "))
}
