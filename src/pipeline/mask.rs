//! From labels to the classes that a plan tells apart.

use super::measure::Stopwatch;
use super::sidecar::LabelsRecord;
use crate::error::Result;
use crate::io::Scan;
use crate::plan::Plan;

/// The scan with a class for each voxel, if the plan has a mask, and what the sidecar says of its labels. The labels
/// themselves are let go: a class takes one byte.
pub(super) fn classified(
    mut scan: Scan,
    plan: &Plan,
    stopwatch: &mut Stopwatch<'_>,
) -> Result<(Scan, Option<LabelsRecord>)> {
    let labels = scan.labels.take();
    let Some((labels, classes)) = labels.zip(plan.label_classes.as_ref()) else { return Ok((scan, None)) };
    stopwatch.time("mask", || {
        let record = LabelsRecord { values_sha256: labels.values_sha256(), voxels: labels.counts().clone() };
        let volume = scan.volume.with_classes(labels.classes(|label| classes.class(label)))?;
        Ok((Scan { volume, ..scan }, Some(record)))
    })
}
