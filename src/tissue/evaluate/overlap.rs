//! Which tissue of the labels is which of the reference, and how many voxels they share.

use serde::Serialize;

use crate::error::{Error, Fault, Result};
use crate::tissue::Mask;
use crate::volume::{Grid, LabelMap};

/// How far corners of the two lattices may be apart, as a share of a voxel.
const SAME_PLACE: f64 = 0.01;

/// A tissue of the labels, and what of the reference it should be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pair {
    /// The tissue.
    pub tissue: String,
    /// Its position in the labels, counted from 1; 0 if the labels do not have it.
    pub label: u8,
    /// Its positions in the reference, counted from 1.
    pub reference: Vec<u8>,
}

/// Labels and a reference on the same lattice, and which tissues are compared.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    /// The labels.
    pub labels: &'a LabelMap,
    /// The reference.
    pub reference: &'a LabelMap,
    /// The tissues compared.
    pub pairs: Vec<Pair>,
}

/// How many voxels of each tissue of the labels are of which tissue of the reference.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Confusion {
    /// Names of the rows: tissues of the labels, then `none`.
    pub labels: Vec<String>,
    /// Names of the columns: compared tissues of the reference, then `other` tissues, then `none`.
    pub reference: Vec<String>,
    /// Voxels, row by row.
    pub voxels: Vec<Vec<u64>>,
}

impl<'a> Comparison<'a> {
    /// A comparison of these pairs.
    ///
    /// # Errors
    /// `Fault::Geometry` if the two do not lie on the same lattice; nothing is resampled.
    pub fn new(labels: &'a LabelMap, reference: &'a LabelMap, pairs: Vec<Pair>) -> Result<Self> {
        refuse_elsewhere(labels.grid(), reference.grid())?;
        Ok(Comparison { labels, reference, pairs })
    }

    /// Voxels of a tissue in the labels.
    pub fn mask(&self, pair: &Pair) -> Mask {
        mask_of(self.labels, &[pair.label])
    }

    /// Voxels of a tissue in the reference.
    pub fn reference_mask(&self, pair: &Pair) -> Mask {
        mask_of(self.reference, &pair.reference)
    }
}

/// Voxels of any of the segments at these positions, counted from 1.
pub fn mask_of(labels: &LabelMap, positions: &[u8]) -> Mask {
    let mut wanted = [false; 256];
    positions.iter().filter(|position| **position != 0).for_each(|position| wanted[usize::from(*position)] = true);
    Mask::new(labels.grid(), |index| wanted[usize::from(labels.voxels()[index])])
}

fn refuse_elsewhere(a: &Grid, b: &Grid) -> Result<()> {
    if a.dims() != b.dims() {
        return Err(Error::new(Fault::Geometry, "labels and reference differ in their number of voxels")
            .found(format!("{:?} and {:?}", a.dims(), b.dims()))
            .remedy("make both on the same scan"));
    }
    let apart = a.corners_mm().into_iter().zip(b.corners_mm()).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
    if apart <= SAME_PLACE * a.spacing_mm().min_element() {
        return Ok(());
    }
    Err(Error::new(Fault::Geometry, "labels and reference lie at different places")
        .found(format!("corners up to {apart:.3} mm apart"))
        .remedy("make both on the same scan"))
}

/// The confusion table of a comparison.
pub fn confusion(comparison: &Comparison<'_>) -> Confusion {
    let Comparison { labels, reference, pairs } = comparison;
    let other = pairs.len();
    let mut column = [other; 256];
    column[0] = other + 1;
    for (n, pair) in pairs.iter().enumerate() {
        pair.reference.iter().for_each(|position| column[usize::from(*position)] = n);
    }
    let rows = labels.segments().len();
    let mut voxels = vec![vec![0_u64; other + 2]; rows + 1];
    for (label, reference) in labels.voxels().iter().zip(reference.voxels()) {
        // None comes last.
        let row = usize::from(*label).checked_sub(1).unwrap_or(rows);
        voxels[row][column[usize::from(*reference)]] += 1;
    }
    let names = |names: Vec<&String>, last: &[&str]| {
        names.into_iter().cloned().chain(last.iter().map(|name| (*name).to_owned())).collect()
    };
    Confusion {
        labels: names(labels.segments().iter().map(|segment| &segment.name).collect(), &["none"]),
        reference: names(pairs.iter().map(|pair| &pair.tissue).collect(), &["other", "none"]),
        voxels,
    }
}
