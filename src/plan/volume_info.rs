//! What a plan needs to know of a volume: all but its samples.

use std::collections::BTreeMap;

use crate::io::Labels;
use crate::volume::{Grid, Quantity, Samples, Volume};

/// What a plan needs to know of a volume: all but its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct VolumeInfo {
    /// Lattice and affine.
    pub grid: Grid,
    /// How samples are stored.
    pub storage: Storage,
    /// Smallest and largest value.
    pub value_range: [f64; 2],
    /// What the values measure.
    pub quantity: Quantity,
    /// Its labels, where a mask asks for them.
    pub labels: Option<LabelInfo>,
}

/// What a plan needs to know of labels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelInfo {
    /// How many voxels have each label that occurs.
    pub counts: BTreeMap<u16, u64>,
    /// Labels by their names, where they have names.
    pub names: BTreeMap<String, u16>,
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
        VolumeInfo {
            grid: *volume.grid(),
            storage,
            value_range: volume.value_range(),
            quantity: volume.quantity(),
            labels: None,
        }
    }
}

impl From<&Labels> for LabelInfo {
    fn from(labels: &Labels) -> Self {
        LabelInfo { counts: labels.counts().clone(), names: labels.names().clone() }
    }
}
