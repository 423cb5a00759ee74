//! Slices that belong together, and whether they make a volume.

use std::path::Path;
use std::sync::Arc;

use super::geometry::Stack;
use super::group::Group;
use super::header::{FrameHeader, ImageFile};
use super::spacing::SliceSpacing;
use super::transfer_syntax;
use crate::error::{Error, Fault, Result};

/// One frame of one file.
#[derive(Debug, Clone)]
pub(super) struct Slice {
    file: Arc<ImageFile>,
    frame: usize,
}

impl Slice {
    /// Every frame of a file.
    pub(super) fn all_of(file: ImageFile) -> Vec<Slice> {
        let file = Arc::new(file);
        (0..file.frames.len()).map(|frame| Slice { file: Arc::clone(&file), frame }).collect()
    }

    pub(super) fn file(&self) -> &Arc<ImageFile> {
        &self.file
    }

    pub(super) fn frame_index(&self) -> usize {
        self.frame
    }

    pub(super) fn frame(&self) -> &FrameHeader {
        &self.file.frames[self.frame]
    }

    pub(super) fn path(&self) -> &Path {
        &self.file.path
    }

    /// File name, and the frame (counted from 1, as in the standard) where the file has several.
    pub(super) fn name(&self) -> String {
        let file = self.path().file_name().unwrap_or(self.path().as_os_str()).to_string_lossy();
        if self.file.frames.len() > 1 { format!("{file} frame {}", self.frame + 1) } else { file.into_owned() }
    }
}

/// Whether a series can be read as a volume.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// It can, as far as its headers tell.
    Renderable,
    /// It cannot.
    Refused {
        /// Whose fault that is.
        fault: Fault,
        /// The first line of the error that reading it gives.
        reason: String,
    },
}

/// Slices of one Series Instance UID and one geometry.
#[derive(Debug, Clone)]
pub struct Series {
    /// Series Instance UID.
    pub uid: String,
    /// Series Number, which people know a series by; not unique.
    pub number: Option<i64>,
    /// Series Description; may be empty.
    pub description: String,
    /// Such as CT.
    pub modality: String,
    /// Names and UIDs of the transfer syntaxes, usually one.
    pub transfer_syntax: String,
    /// True if this build decodes them.
    pub decodable: bool,
    /// Columns, rows, slices.
    pub dims: [usize; 3],
    /// Distance in mm between columns, rows and slices; `None` where the geometry is refused.
    pub spacing_mm: Option<[f64; 3]>,
    /// Positions in mm of the first and last slice along the normal; `None` where not known.
    pub position_range_mm: Option<[f64; 2]>,
    /// Whether it can be read, or why not.
    pub verdict: Verdict,
    pub(super) slices: Vec<Slice>,
}

impl Series {
    /// The series of slices that [`Group`] gathered; judged here, once.
    pub(super) fn of(group: Group) -> Self {
        let slices = group.slices;
        let first = Arc::clone(slices[0].file());
        let mut syntaxes: Vec<&str> = slices.iter().map(|s| s.file().transfer_syntax_uid.as_str()).collect();
        syntaxes.sort_unstable();
        syntaxes.dedup();
        let decodable = syntaxes.iter().all(|uid| transfer_syntax::can_decode(uid));
        let transfer_syntax = syntaxes.iter().map(|uid| transfer_syntax::name(uid)).collect::<Vec<_>>().join(", ");
        let stack = judge(&slices, SliceSpacing::Even);
        let spacing = |stack: &Stack| {
            let m = stack.index_to_lps_mm.matrix3;
            [m.x_axis.length(), m.y_axis.length(), m.z_axis.length()]
        };
        Series {
            uid: first.series_uid.clone(),
            number: first.series_number,
            description: first.description.clone(),
            modality: first.modality.clone(),
            transfer_syntax,
            decodable,
            dims: [first.format.columns, first.format.rows, slices.len()],
            spacing_mm: stack.as_ref().ok().map(spacing),
            position_range_mm: stack.as_ref().map(|stack| stack.range_mm).ok().or_else(|| position_range(&slices)),
            verdict: match stack {
                Ok(_) => Verdict::Renderable,
                Err(error) => Verdict::Refused {
                    fault: error.fault(),
                    reason: error.to_string().lines().next().unwrap_or_default().to_owned(),
                },
            },
            slices,
        }
    }

    /// Its lattice.
    ///
    /// # Errors
    /// What the verdict says, in full.
    pub(super) fn stack(&self, spacing: SliceSpacing) -> Result<Stack> {
        judge(&self.slices, spacing)
    }

    /// The files and their positions in mm along the normal (`None` where not known), in the order of the volume where
    /// there is one, else by path.
    pub fn files(&self) -> Vec<(&Path, Option<f64>)> {
        let order =
            self.stack(SliceSpacing::Even).map_or_else(|_| (0..self.slices.len()).collect(), |stack| stack.order);
        order.iter().map(|&s| (self.slices[s].path(), along(&self.slices[s]))).collect()
    }

    /// One line for people: number, description, dimensions, UID.
    pub fn label(&self) -> String {
        let number = self.number.map_or_else(|| "no number".to_owned(), |n| format!("number {n}"));
        let [columns, rows, slices] = self.dims;
        format!("{number}, '{}', {} {columns} x {rows} x {slices}, UID {}", self.description, self.modality, self.uid)
    }

    /// Voxels, for "largest".
    pub(super) fn voxels(&self) -> usize {
        self.dims.iter().fold(1, |product: usize, n| product.saturating_mul(*n))
    }

    /// True for overview images, which share a series with the slices that were planned on them.
    pub fn is_localizer(&self) -> bool {
        is_localizer(self.slices[0].file())
    }
}

/// Position along the slice's own normal.
fn along(slice: &Slice) -> Option<f64> {
    slice.frame().pose.as_ref().ok().map(|pose| pose.position_mm.dot(pose.normal()))
}

fn position_range(slices: &[Slice]) -> Option<[f64; 2]> {
    let positions: Vec<f64> = slices.iter().filter_map(along).collect();
    let low = positions.iter().copied().reduce(f64::min)?;
    let high = positions.iter().copied().reduce(f64::max)?;
    Some([low, high])
}

fn is_localizer(file: &ImageFile) -> bool {
    file.image_type.iter().any(|value| value == "LOCALIZER")
}

/// All that headers can tell about whether slices make a volume.
fn judge(slices: &[Slice], spacing: SliceSpacing) -> Result<Stack> {
    let unsupported = |slice: &Slice, what: String| Error::new(Fault::Unsupported, what).at(slice.path());
    if is_localizer(slices[0].file()) {
        return Err(Error::new(Fault::Geometry, "a localizer: an overview image, not slices of a volume")
            .at(slices[0].path())
            .remedy("choose the series of axial slices"));
    }
    for slice in slices {
        let file = slice.file();
        if let Some(reason) = file.format.refusal() {
            return Err(unsupported(slice, reason).remedy("convert the series to monochrome images of 8 or 16 bits"));
        }
        if !transfer_syntax::can_decode(&file.transfer_syntax_uid) {
            let name = transfer_syntax::name(&file.transfer_syntax_uid);
            return Err(unsupported(slice, "this build does not decode the transfer syntax".to_owned())
                .found(name)
                .remedy("convert the series to Explicit VR Little Endian"));
        }
        if file.has_modality_lut {
            return Err(unsupported(slice, "values given by a Modality LUT Sequence are not read".to_owned())
                .remedy("convert the series to Rescale Slope and Intercept"));
        }
        if let Err(reason) = &slice.frame().rescale {
            return Err(Error::new(Fault::Input, "the rescale is not usable")
                .at(slice.path())
                .found(reason.clone())
                .remedy("export the series again"));
        }
    }
    Stack::of(slices, spacing)
}
