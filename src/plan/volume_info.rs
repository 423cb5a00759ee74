//! What a plan needs to know of a volume: all but its samples.

use crate::volume::{Grid, Quantity, Samples, Volume};

/// What a plan needs to know of a volume: all but its samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeInfo {
    /// Lattice and affine.
    pub grid: Grid,
    /// Smallest and largest distance between neighbouring slices, mm, where it is uneven.
    pub uneven_slices_mm: Option<[f64; 2]>,
    /// How samples are stored.
    pub storage: Storage,
    /// Smallest and largest value.
    pub value_range: [f64; 2],
    /// What the values measure.
    pub quantity: Quantity,
}

/// How samples are stored in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// 16-bit integers.
    I16,
    /// 32-bit floats.
    F32,
}

impl Storage {
    /// Name in kernels.
    pub(super) fn name(self) -> &'static str {
        match self {
            Storage::I16 => "i16",
            Storage::F32 => "f32",
        }
    }

    /// Bytes per voxel.
    pub(super) fn bytes(self) -> u64 {
        match self {
            Storage::I16 => 2,
            Storage::F32 => 4,
        }
    }
}

impl VolumeInfo {
    /// Smallest distance between neighbouring voxels along an axis, mm.
    pub(super) fn smallest_spacing_mm(&self) -> f64 {
        let spacing_mm = self.grid.spacing_mm();
        let along_k = self.uneven_slices_mm.map_or(spacing_mm.z, |[least, _]| least);
        spacing_mm.x.min(spacing_mm.y).min(along_k)
    }

    /// Unit of the values, for messages.
    pub(super) fn unit(&self) -> &'static str {
        match self.quantity {
            Quantity::Hu => "HU",
            Quantity::Arbitrary => "of unknown unit",
        }
    }
}

impl From<&Volume> for VolumeInfo {
    fn from(volume: &Volume) -> Self {
        let storage = match volume.samples() {
            Samples::I16(_) => Storage::I16,
            Samples::F32(_) => Storage::F32,
        };
        let uneven_slices_mm = volume.slices().map(|_| volume.slice_step_range_mm());
        VolumeInfo {
            grid: *volume.grid(),
            uneven_slices_mm,
            storage,
            value_range: volume.value_range(),
            quantity: volume.quantity(),
        }
    }
}
