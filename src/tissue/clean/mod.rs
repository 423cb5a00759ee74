//! Cleaning of labels: steps that know of places, done only if asked for.

mod body;
mod closing;
mod majority;
mod regions;

use super::Mask;
use crate::error::Result;
use crate::plan::{Classification, CleanStep};
use crate::volume::{LabelMap, Volume};

/// The labels after the steps of each tissue.
///
/// Each tissue is cleaned by itself, as a mask of `labels`, by its steps in their order; a tissue without steps is its mask.
/// Where two masks then overlap, the tissue of greater peak extinction has the voxel; of equals, the first.
///
/// It takes two bytes per voxel, and a closing nine more in a box around the tissue: beyond what [`classify`](super::classify)
/// takes, and only here.
///
/// # Errors
/// `Fault::Unsupported` for a closing on a lattice whose axes are not at right angles, and for the body of a volume whose
/// values are not HU.
pub fn clean(labels: LabelMap, volume: &Volume, classification: &Classification) -> Result<LabelMap> {
    let tissues = &classification.tissues;
    if tissues.iter().all(|tissue| tissue.clean.is_empty()) {
        return Ok(labels);
    }
    let mut order: Vec<usize> = (0..tissues.len()).collect();
    // Later ones overwrite earlier ones: from the faintest to the densest, and of equals the first last.
    order.sort_by(|&a, &b| {
        tissues[a].peak_extinction_per_mm.total_cmp(&tissues[b].peak_extinction_per_mm).then(b.cmp(&a))
    });
    let mut cleaned = vec![0_u8; labels.voxels().len()];
    for t in order {
        // A classification has at most 255 tissues.
        let own = (t + 1) as u8;
        let mut mask = Mask::new(labels.grid(), |index| labels.voxels()[index] == own);
        for step in &tissues[t].clean {
            apply(*step, volume, &mut mask)?;
        }
        for (label, _) in cleaned.iter_mut().zip(&mask.inside).filter(|(_, inside)| **inside) {
            *label = own;
        }
    }
    LabelMap::new(*labels.grid(), labels.segments().to_vec(), cleaned)
}

fn apply(step: CleanStep, volume: &Volume, mask: &mut Mask) -> Result<()> {
    let grid = volume.grid();
    match step {
        CleanStep::LargestPart => regions::keep_largest(mask),
        CleanStep::SmallestPartMl(ml) => regions::keep_of_at_least(mask, ml * 1000.0 / grid.voxel_mm3()),
        CleanStep::FillHoles => regions::fill_holes(mask),
        CleanStep::Body => {
            let body = body::of(volume)?;
            mask.inside.iter_mut().zip(&body.inside).for_each(|(inside, body)| *inside &= *body);
        }
        CleanStep::ClosingMm(radius_mm) => closing::close(mask, grid, radius_mm)?,
        CleanStep::MajorityMm(reach_mm) => majority::vote(mask, grid.spacing_mm(), reach_mm),
    }
    Ok(())
}
