//! What a header says.

use super::data_file::DataFile;
use super::encoding::{ElementType, Encoding, Endian};
use super::kind::Kind;
use super::space::Space;
use crate::error::{Error, Fault, Result};

/// The header of a NRRD file: the fields of its definition, with `None` where a file leaves one out.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Version of the format, 1 to 5.
    pub version: u8,
    /// Type of the elements.
    pub element_type: ElementType,
    /// How the elements are written.
    pub encoding: Encoding,
    /// Order of the bytes; always known where it matters.
    pub endian: Option<Endian>,
    /// The axes, fastest first; 1 to 16.
    pub axes: Vec<Axis>,
    /// The world space by name.
    pub space: Option<Space>,
    /// Number of world coordinates, from `space` or `space dimension`.
    pub space_dimension: Option<usize>,
    /// Units of the world coordinates.
    pub space_units: Vec<String>,
    /// World coordinates of the centre of the first sample.
    pub space_origin: Option<Vec<f64>>,
    /// Columns that map measured vectors to the world.
    pub measurement_frame: Option<Vec<Vec<f64>>>,
    /// What the file holds, in words.
    pub content: Option<String>,
    /// Units of the elements.
    pub sample_units: Option<String>,
    /// Values that the smallest and largest element stand for, as written (`min`, `max`).
    pub value_range: [Option<f64>; 2],
    /// Range before the elements were quantised (`old min`, `old max`).
    pub old_range: [Option<f64>; 2],
    /// Where the elements are.
    pub data_file: DataFile,
    /// Lines to skip before the elements, in each data file.
    pub line_skip: u64,
    /// Bytes to skip after those lines; after decompression where the encoding compresses.
    pub byte_skip: ByteSkip,
    /// Key/value pairs in the order of the file, without their escapes.
    pub key_values: Vec<(String, String)>,
    /// Comments in the order of the file.
    pub comments: Vec<String>,
}

/// One axis of the array.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// Number of samples; not 0.
    pub size: usize,
    /// Distance between samples.
    pub spacing: Option<f64>,
    /// Extent of one sample along the axis.
    pub thickness: Option<f64>,
    /// Lowest position along the axis.
    pub min: Option<f64>,
    /// Highest position along the axis.
    pub max: Option<f64>,
    /// Whether positions are of cells or of nodes.
    pub center: Option<Center>,
    /// What the samples along the axis are.
    pub kind: Option<Kind>,
    /// Step in the world from one sample to the next; `None` for an axis that is not spatial.
    pub direction: Option<Vec<f64>>,
    /// Name of the axis.
    pub label: Option<String>,
    /// Unit of spacing, thickness and positions.
    pub unit: Option<String>,
}

/// Whether the ends of an axis are the borders of its outer samples or their centres.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Center {
    /// Ends at the borders of the outer samples.
    Cell,
    /// Ends at the centres of the outer samples.
    Node,
}

/// Bytes to skip before the elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ByteSkip {
    /// This many.
    Bytes(u64),
    /// As many as leave exactly the elements (`-1`, raw encoding only).
    AllButData,
}

impl Header {
    /// Number of elements of the array.
    ///
    /// # Errors
    /// `Fault::Input` if they have more bytes than can be counted.
    pub fn element_count(&self) -> Result<usize> {
        let count = self.axes.iter().try_fold(1_usize, |n, axis| n.checked_mul(axis.size));
        count.filter(|n| n.checked_mul(self.element_type.bytes()).is_some_and(|b| b <= isize::MAX as usize)).ok_or_else(
            || {
                Error::new(Fault::Input, "the array is larger than any memory").element("sizes").found(format!(
                    "{} of {}",
                    self.shape(),
                    self.element_type.name()
                ))
            },
        )
    }

    /// Sizes and kinds of the axes for people: `4 (RGBA-color) x 64 x 64 x 93`.
    pub fn shape(&self) -> String {
        let axis = |axis: &Axis| match axis.kind.filter(|kind| !kind.is_spatial()) {
            Some(kind) => format!("{} ({})", axis.size, kind.name()),
            None => axis.size.to_string(),
        };
        self.axes.iter().map(axis).collect::<Vec<_>>().join(" x ")
    }

    /// Value of a key, the last one if it occurs twice.
    pub fn value_of(&self, key: &str) -> Option<&str> {
        self.key_values.iter().rev().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
    }

    /// Index of the axis that holds the components of a colour.
    pub fn color_axis(&self) -> Option<usize> {
        self.axes.iter().position(|axis| axis.kind.is_some_and(Kind::is_color))
    }
}
