//! What a number along a ray is a number of: the stored value, or the extinction. Chosen by type, once per frame.

use crate::classify::Classifier;
use crate::field::{Cell, Magnitude, Trilinear, Voxel};

/// Reads one number at a place.
pub(super) trait Probe: Sync {
    /// Number of voxels along i, j and k.
    fn dims(&self) -> [usize; 3];
    /// The number at a place.
    fn at(&self, cell: &Cell) -> f32;
}

/// The stored value.
pub(super) struct Stored<'a, V>(pub(super) Trilinear<'a, V>);

impl<V: Voxel> Probe for Stored<'_, V> {
    fn dims(&self) -> [usize; 3] {
        self.0.dims()
    }

    #[inline(always)]
    fn at(&self, cell: &Cell) -> f32 {
        self.0.value(cell)
    }
}

/// The extinction, 1/mm.
pub(super) struct Extinction<'a, V, C> {
    pub(super) field: Trilinear<'a, V>,
    /// The gradient magnitude, HU/mm; there if the transfer function reads it.
    pub(super) magnitude: Option<Magnitude<'a>>,
    pub(super) classifier: &'a C,
}

impl<V: Voxel, C: Classifier<f32>> Probe for Extinction<'_, V, C> {
    fn dims(&self) -> [usize; 3] {
        self.field.dims()
    }

    #[inline(always)]
    fn at(&self, cell: &Cell) -> f32 {
        let magnitude = match &self.magnitude {
            Some(magnitude) if C::READS_GRADIENT => magnitude.value(cell),
            _ => 0.0,
        };
        let [.., extinction] = self.classifier.classify(self.field.value(cell), magnitude);
        // Rounding may leave a trace below 0 at the foot of a ramp.
        extinction.max(0.0)
    }
}
