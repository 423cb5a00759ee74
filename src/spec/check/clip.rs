//! Checks on clipping.

use super::{Check, join};
use crate::error::Result;
use crate::spec::{ClipBoxSpec, ClipSpec, TrimSpec};

/// Planes beyond which nobody writes them by hand, and finding out whether they leave anything takes long.
const MOST_PLANES: usize = 64;

pub(super) fn check_clip(check: Check<'_>, clip: &ClipSpec) -> Result<()> {
    let path = |key: &str| join("effects.clip", key);
    check.needed("effects.clip", clip.within.is_some() || clip.planes.is_some(), "box, planes or both")?;
    match &clip.within {
        Some(ClipBoxSpec::Voxels(ranges)) => check_ranges(check, &path("box.voxels"), ranges.map(|r| (r.low, r.high)))?,
        Some(ClipBoxSpec::Mm(ranges)) => check_ranges(check, &path("box.mm"), ranges.map(|r| (r.low, r.high)))?,
        Some(ClipBoxSpec::TrimMm(trim)) => check_trim(check, &path("box.trim_mm"), trim)?,
        None => {}
    }
    let Some(planes) = &clip.planes else { return Ok(()) };
    let count = (1..=MOST_PLANES).contains(&planes.len());
    check.require(&path("planes"), count, &format!("1 to {MOST_PLANES} planes"))?;
    for (i, plane) in planes.iter().enumerate() {
        let path = path(&format!("planes.{i}"));
        let given = [("point_mm", plane.point_mm.is_some()), ("offset_mm", plane.offset_mm.is_some())];
        check.exactly_one(&path, &given)?;
        let directed = plane.normal.iter().any(|x| *x != 0.0);
        check.require(&join(&path, "normal"), directed, "a direction of any length but 0")?;
    }
    Ok(())
}

fn check_ranges(check: Check<'_>, path: &str, ranges: [(Option<f64>, Option<f64>); 3]) -> Result<()> {
    for (axis, ends) in ranges.into_iter().enumerate() {
        let ascending = ends.0.zip(ends.1).is_none_or(|(low, high)| low < high);
        check.require(&join(path, &axis.to_string()), ascending, "[lowest, highest], the lower first")?;
    }
    Ok(())
}

fn check_trim(check: Check<'_>, path: &str, trim: &TrimSpec) -> Result<()> {
    let TrimSpec { left, right, anterior, posterior, superior, inferior } = *trim;
    let sides = [
        ("left", left),
        ("right", right),
        ("anterior", anterior),
        ("posterior", posterior),
        ("superior", superior),
        ("inferior", inferior),
    ];
    for (side, mm) in sides {
        check.at_least(&join(path, side), mm, 0.0)?;
    }
    let some = sides.iter().any(|(_, mm)| mm.is_some());
    check.needed(path, some, "left, right, anterior, posterior, superior or inferior")
}
