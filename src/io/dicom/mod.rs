//! DICOM CT series: a folder of slices to a volume, and a volume to a series.
//!
//! The words are those of the standard (DICOM 2024, PS3); this page says which of its statements the reader relies on, and
//! what it does where files break them. Nothing is guessed: what is not stated is refused or, where the values do not
//! depend on it, warned of.
//!
//! # From files to series
//!
//! Every file below the folder is looked at ([`scan_folder`]). A file is DICOM if it has the prefix of PS3.10 §7.1. Images
//! form one series if they agree in Series Instance UID, modality, Frame of Reference UID, the first three values of Image
//! Type (PS3.3 §C.8.2.1.1.1, so that a LOCALIZER stays apart), rows, columns, direction cosines within 1e-4, and pixel
//! spacing within 1e-4 of itself. An image of which the place is not known joins its series, which is then refused: to leave
//! it out could shorten a scan unnoticed. Every file ends with a [`FileFate`](crate::io::FileFate).
//!
//! # From a series to the lattice
//!
//! PS3.3 §C.7.6.2.1.1: the voxel in column `i` and row `j` of a slice lies at
//!
//! ```text
//! P = S + i · Δi · X + j · Δj · Y       LPS mm
//! S       Image Position (Patient), the centre of the first pixel
//! X, Y    Image Orientation (Patient): along a row, and down a column
//! Δj, Δi  Pixel Spacing: first the distance between rows, then that between columns
//! ```
//!
//! Slices are sorted by `S · (X × Y)`, never by Instance Number, and the step along k is `(S_last − S_first) / (n − 1)`. Under
//! gantry tilt that step is not normal to the slices; the affine keeps it as shear, and Gantry/Detector Tilt (0018,1120),
//! which the standard reserves for people, is not read. Steps may differ from the median one by 1 % or 0.01 mm, whichever is
//! larger (but at most 10 % of it), and no slice may be farther than that from its place on the lattice; the largest
//! deviation is among the facts of the scan. Missing slices, several slices at one position, uneven steps and shifted slices
//! are errors of [`Fault::Geometry`](crate::Fault::Geometry) that name files and millimetres. Where changing steps are asked
//! for ([`SliceSpacing::Uneven`]), a series that is not even is read as a rectilinear volume
//! ([`Slices`](crate::volume::Slices)): each slice at its place, which may lie off the line from the first to the last by the
//! same tolerance. A gap is then a step that is a whole multiple of the larger of those beside it: 5 5 10 5 5 mm misses a
//! slice, 5 5 10 10 10 mm does not. Slice Thickness is a property of
//! the beam, not of the lattice; only the extent of a single slice is taken from it, with a warning.
//!
//! # From pixels to values
//!
//! | what | rule | PS3 |
//! |---|---|---|
//! | stored value | the Bits Stored bits below High Bit, sign from Pixel Representation | 5 §8.1.1 |
//! | JPEG 2000 | precision from the codestream, sign from Pixel Representation; a warning where they disagree | 5 §8.2.4 |
//! | padding | Pixel Padding Value up to Range Limit: replaced by the smallest other value of the volume, with a warning | 3 §C.7.5.1.1.2 |
//! | value | Rescale Slope · stored + Rescale Intercept, of each slice | 3 §C.11.1.1.2 |
//! | unit | HU for CT unless Rescale Type says otherwise or the rescale is missing; other modalities only if it says HU | 3 §C.8.2.1, §C.11.1.1.2 |
//! | MONOCHROME1 | the same values as MONOCHROME2; only their display differs | 3 §C.7.6.3.1.2 |
//! | enhanced CT | position, orientation, spacing and rescale of each frame, from its functional groups or the shared ones | 3 §C.7.6.16 |
//!
//! If all slices share one rescale, stored values stay as they are, 16 bits each. If not, values are kept in 16 bits where
//! all are whole and fit, else in f32.
//!
//! Decoded transfer syntaxes: implicit and explicit little endian, explicit big endian, deflated, RLE, JPEG baseline and
//! extended at 8 bits, JPEG lossless (without restart intervals, which the decoder gets wrong), JPEG 2000 and its
//! high-throughput variant. Not decoded: JPEG-LS, JPEG XL, JPEG of 12 bits by cosine transform, and video.
//!
//! # From a volume to a series
//!
//! [`write_series`] writes CT Image Storage (PS3.3 §A.3), one file per slice, that reads back to the same values and affine.

mod assemble;
mod attributes;
mod choice;
mod codestream;
mod ct_image;
mod decimal_string;
mod folder;
mod frame;
mod functional_groups;
mod geometry;
mod group;
mod header;
mod pixels;
mod read;
mod series;
mod spacing;
mod storage;
mod transfer_syntax;
mod uid;
mod write;

pub use choice::SeriesChoice;
pub use folder::{Folder, scan_folder};
pub use read::{read, read_spaced};
pub use series::{Series, Verdict};
pub use spacing::SliceSpacing;
pub use write::{SeriesDescription, write_series};

/// The innermost cause of a library's error, which is the part that says something about the file.
fn deepest(error: &(dyn std::error::Error + 'static)) -> String {
    let mut cause = error;
    while let Some(inner) = cause.source() {
        cause = inner;
    }
    cause.to_string()
}
