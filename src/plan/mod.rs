//! What will be done: a spec and the metadata of a volume, resolved until no option is left open.

mod method;

use std::path::PathBuf;

pub use method::{Colors, Emission, Exact, Jitter, JitterKind, Lattice, March, Method, Order, SampleRule};

use crate::demand::Demand;
use crate::scene::Scene;
use crate::spec::Tissue;
use crate::transfer::Term;
use crate::volume::{Grid, Quantity, Samples, Volume};

/// What a plan needs to know of a volume: all but its samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeInfo {
    /// Lattice and affine.
    pub grid: Grid,
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

impl From<&Volume> for VolumeInfo {
    fn from(volume: &Volume) -> Self {
        let storage = match volume.samples() {
            Samples::I16(_) => Storage::I16,
            Samples::F32(_) => Storage::F32,
        };
        VolumeInfo { grid: *volume.grid(), storage, value_range: volume.value_range(), quantity: volume.quantity() }
    }
}

/// What will be done, for one volume; the same for any number of threads.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What is pictured.
    pub scene: Scene,
    /// How the volume rendering integral is computed.
    pub method: Method,
    /// The layers whose sum is the scene's transfer function, in the order written; for classification.
    pub layers: Vec<Layer>,
    /// What the stages together read of the volume.
    pub demand: Demand,
    /// The file to write.
    pub output: Output,
    /// How many random pixels the oracle recomputes.
    pub certify: Option<usize>,
    /// What is computed, in order.
    pub stages: Vec<Stage>,
    /// What is not computed, and why.
    pub not_computed: Vec<Omission>,
    /// What a careful user should know.
    pub warnings: Vec<String>,
}

/// One layer of the transfer function.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Name of its preset, or `layer 2` for one written in the pipeline.
    pub name: String,
    /// The tissue it classifies.
    pub tissue: Option<Tissue>,
    /// Its terms; their sum over all layers is the transfer function.
    pub terms: Vec<Term>,
    /// How far the terms may be from the shapes that were written, as a share of a shape's height; 0 where they are exact.
    pub max_deviation: f64,
}

/// The file to write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    /// Its path; relative ones are resolved from the pipeline's folder.
    pub path: PathBuf,
    /// Its format.
    pub format: Format,
}

/// Format of a picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// PNG, 8 bits per channel, sRGB, straight alpha.
    Png8,
    /// PNG, 16 bits per channel, sRGB, straight alpha.
    Png16,
    /// OpenEXR, 32-bit floats, linear, premultiplied alpha.
    Exr,
}

/// One stage of the computation.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Stage {
    /// The module that does it: `volume`, `field`, `classify`, `integrate`, `image`.
    pub name: &'static str,
    /// What it does, with the kernel it uses.
    pub what: String,
    /// Bytes it keeps in memory, estimated.
    pub bytes: u64,
}

/// Something that is not computed.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Omission {
    /// What.
    pub what: &'static str,
    /// Why nobody needs it, or why it does not apply.
    pub why: String,
}
