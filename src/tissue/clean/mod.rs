//! Cleaning of labels: steps that know of places, done only if asked for.

mod body;
mod claims;
mod closing;
mod majority;
mod regions;

use self::body::Body;
use self::claims::Claims;
use super::Mask;
use crate::error::Result;
use crate::plan::{Classification, CleanStep};
use crate::volume::{LabelMap, Volume};

/// The labels after the steps of each tissue.
///
/// Each tissue is cleaned by itself, as a mask of `labels`, by its steps in their order; a tissue without steps is its mask.
/// Where two masks then overlap, the tissue of greater peak extinction has the voxel; of equals, the first.
///
/// It takes one byte per voxel beyond what [`classify`](super::classify) takes, one more for the voxels of a box around the tissue
/// in a closing or a majority vote, and 24 bytes for each run of voxels in a row where parts are looked for.
///
/// # Errors
/// `Fault::Unsupported` for a closing on a lattice whose axes are not at right angles, and for the body of a volume whose
/// values are not HU.
pub fn clean(labels: LabelMap, volume: &Volume, classification: &Classification) -> Result<LabelMap> {
    let tissues = &classification.tissues;
    if tissues.iter().all(|tissue| tissue.clean.is_empty()) {
        return Ok(labels);
    }
    let wanted = tissues.iter().any(|tissue| tissue.clean.contains(&CleanStep::Body));
    let body = wanted.then(|| body::of(volume)).transpose()?;
    let mut order: Vec<usize> = (0..tissues.len()).collect();
    // From the densest to the faintest, and of equals the first first: what one has, no later one takes.
    order.sort_by(|&a, &b| tissues[b].peak_extinction_per_mm.total_cmp(&tissues[a].peak_extinction_per_mm));
    let (grid, segments, voxels) = labels.into_parts();
    let mut claims = Claims::new(voxels, tissues.len());
    for t in order {
        // A classification has at most 255 tissues.
        let own = (t + 1) as u8;
        let mut mask = claims.mask(grid.dims(), own);
        for step in &tissues[t].clean {
            apply(*step, volume, body.as_ref(), &mut mask)?;
        }
        claims.settle(own, &mask);
    }
    LabelMap::new(grid, segments, claims.voxels)
}

fn apply(step: CleanStep, volume: &Volume, body: Option<&Body>, mask: &mut Mask) -> Result<()> {
    let grid = volume.grid();
    match step {
        CleanStep::LargestPart => regions::keep_largest(mask),
        CleanStep::SmallestPartMl(ml) => regions::keep_of_at_least(mask, ml * 1000.0 / grid.voxel_mm3()),
        CleanStep::FillHoles => regions::fill_holes(mask),
        CleanStep::Body => body.into_iter().for_each(|body| body.keep(mask)),
        CleanStep::ClosingMm(radius_mm) => closing::close(mask, grid, radius_mm)?,
        CleanStep::MajorityMm(reach_mm) => majority::vote(mask, grid.spacing_mm(), reach_mm),
    }
    Ok(())
}
