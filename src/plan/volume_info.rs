//! What a plan needs to know of a volume: all but its samples.

use std::collections::BTreeMap;

use crate::io::Labels;
use crate::volume::{Grid, Quantity, Rescale, RgbaEncoding, Samples, Volume};

/// What a plan needs to know of a volume: all but its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct VolumeInfo {
    /// Lattice and affine.
    pub grid: Grid,
    /// Smallest and largest distance between neighbouring slices, mm, where it is uneven.
    pub uneven_slices_mm: Option<[f64; 2]>,
    /// How samples are stored.
    pub storage: Storage,
    /// Map from stored samples to values.
    pub rescale: Rescale,
    /// Smallest and largest value.
    pub value_range: [f64; 2],
    /// What the values measure.
    pub quantity: Quantity,
    /// Most bytes held while it was read.
    pub reading_bytes: u64,
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Storage {
    /// 16-bit integers.
    I16,
    /// 32-bit floats.
    F32,
    /// Colours with an opacity, four integers of 8 bits.
    Rgba8(RgbaEncoding),
    /// Colours with an opacity, four integers of 16 bits.
    Rgba16(RgbaEncoding),
}

impl Storage {
    /// Name in kernels.
    pub(super) fn name(self) -> &'static str {
        match self {
            Storage::I16 => "i16",
            Storage::F32 => "f32",
            Storage::Rgba8(_) => "rgba8",
            Storage::Rgba16(_) => "rgba16",
        }
    }

    /// Bytes per voxel.
    pub(super) fn bytes(self) -> u64 {
        match self {
            Storage::I16 => 2,
            Storage::F32 | Storage::Rgba8(_) => 4,
            Storage::Rgba16(_) => 8,
        }
    }

    /// How colours are understood; `None` for values.
    pub(super) fn rgba_encoding(self) -> Option<RgbaEncoding> {
        match self {
            Storage::I16 | Storage::F32 => None,
            Storage::Rgba8(encoding) | Storage::Rgba16(encoding) => Some(encoding),
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
        let storage = match (volume.samples(), volume.rgba_encoding()) {
            (Samples::I16(_), _) => Storage::I16,
            (Samples::Rgba8(_), Some(encoding)) => Storage::Rgba8(encoding),
            (Samples::Rgba16(_), Some(encoding)) => Storage::Rgba16(encoding),
            _ => Storage::F32,
        };
        let uneven_slices_mm = volume.slices().map(|_| volume.slice_step_range_mm());
        VolumeInfo {
            grid: *volume.grid(),
            uneven_slices_mm,
            storage,
            rescale: volume.rescale(),
            value_range: volume.value_range(),
            quantity: volume.quantity(),
            reading_bytes: storage.bytes() * volume.grid().voxel_count() as u64,
            labels: None,
        }
    }
}

impl From<&Labels> for LabelInfo {
    fn from(labels: &Labels) -> Self {
        LabelInfo { counts: labels.counts().clone(), names: labels.names().clone() }
    }
}
