//! Slices at uneven distances: a rectilinear lattice.

use std::sync::Arc;

use crate::error::{Error, Fault, Result};

/// Slices closer than this, as a part of the mean distance, are at one place.
const SAME_PLACE: f64 = 1e-6;

/// Where the slices of a rectilinear lattice lie along k: `p₀ = 0 < p₁ < … < p₍ₙ₋₁₎ = n − 1`, in steps of the grid's affine,
/// which is thus the mean step. The voxel `(i, j, k)` lies at `A · (i, j, p_k)`.
///
/// The first and the last slice are where those of an even lattice would be, so the domain, its corners and its centre
/// are the grid's own, and only what looks for cells or divides by their height reads this table. It is along k alone:
/// pixels of a scan have one spacing along rows and one along columns (DICOM PS3.3 §10.7.1.3), while slices lie where the
/// table stood.
#[derive(Debug, Clone, PartialEq)]
pub struct Slices {
    positions: Arc<[f64]>,
}

impl Slices {
    /// Slices at these places in ascending order, measured from anywhere in any unit.
    ///
    /// # Errors
    /// `Fault::Geometry` for fewer than two slices, places that are not finite or not ascending, and slices closer than a
    /// millionth of the mean distance.
    pub fn new(places: &[f64]) -> Result<Self> {
        let refused = |what: &str| Error::new(Fault::Geometry, what.to_owned());
        let (Some(&first), Some(&last)) = (places.first(), places.last()) else {
            return Err(refused("there are no slices"));
        };
        if places.len() < 2 {
            return Err(refused("one slice has no distance to the next").expected("at least two slices"));
        }
        let steps = (places.len() - 1) as f64;
        let mean = (last - first) / steps;
        let too_close =
            |pair: &[f64]| (pair[1] - pair[0]) / mean <= SAME_PLACE || pair.iter().any(|place| place.is_nan());
        if !(mean.is_finite() && mean > 0.0) || places.windows(2).any(too_close) {
            let at = places.windows(2).position(too_close).unwrap_or(0);
            return Err(refused("the slices are not in ascending order")
                .element(format!("slices {at} and {}", at + 1))
                .found(format!("{} and {}", places[at], places[at + 1]))
                .expected("finite places, each above the one before"));
        }
        let mut positions: Vec<f64> = places.iter().map(|place| (place - first) / (last - first) * steps).collect();
        // Exact whatever the rounding: the domain ends here.
        positions[places.len() - 1] = steps;
        Ok(Slices { positions: positions.into() })
    }

    /// `p_k` of each slice, in steps of the grid's affine.
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// The smallest and the largest distance between neighbouring slices, in steps of the grid's affine.
    pub fn step_range(&self) -> [f64; 2] {
        let steps = self.positions.windows(2).map(|pair| pair[1] - pair[0]);
        steps.fold([f64::INFINITY, 0.0], |[least, most], step| [least.min(step), most.max(step)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_become_steps_of_the_mean() {
        let slices = Slices::new(&[-10.0, -9.0, -7.0, -4.0]).unwrap();
        assert_eq!(slices.positions(), [0.0, 0.5, 1.5, 3.0]);
        assert_eq!(slices.step_range(), [0.5, 1.5]);
    }

    #[test]
    fn what_is_no_order_is_refused() {
        for wrong in [
            &[][..],
            &[1.0],
            &[1.0, 1.0],
            &[0.0, 2.0, 1.0, 3.0],
            &[3.0, 2.0, 1.0],
            &[0.0, 1e-9, 1.0],
            &[0.0, f64::NAN, 1.0],
            &[0.0, f64::INFINITY],
            &[f64::NAN, 0.0],
        ] {
            let error = Slices::new(wrong).expect_err("no order");
            assert_eq!(error.fault(), Fault::Geometry, "{wrong:?}: {error}");
        }
    }
}
