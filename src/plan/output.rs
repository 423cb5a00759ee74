//! The file to write.

use std::path::{Path, PathBuf};

use crate::error::{Error, Fault, Result};
use crate::spec::{Bits, Spec};

/// The file to write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    /// Its path; relative to the working directory.
    pub path: PathBuf,
    /// Its format.
    pub format: Format,
}

/// Format of a picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// PNG, 8 bits per channel, sRGB, straight alpha.
    Png8,
    /// PNG, 16 bits per channel, sRGB, straight alpha.
    Png16,
    /// OpenEXR, 32-bit floats, linear, premultiplied alpha.
    Exr,
}

impl Output {
    /// The path a caller wants, else that of the spec, else the pipeline's name with `.png`.
    pub(super) fn resolve(spec: &Spec, wanted: Option<&Path>) -> Result<Self> {
        let path = wanted.map(Path::to_path_buf).or_else(|| spec.output());
        let path = path.unwrap_or_else(|| spec.path().with_extension("png"));
        let bits = spec.pipeline.image.as_ref().and_then(|image| image.bits).unwrap_or(Bits::Eight);
        Output::at(path, bits)
    }

    /// The file of a view, of so many: `head-03.png` for the third of 36 views of `head.png`; the file itself if there is one view.
    pub(super) fn of_view(self, view: usize, views: usize) -> Self {
        if views == 1 {
            return self;
        }
        let [stem, suffix] = [self.path.file_stem(), self.path.extension()];
        let [stem, suffix] = [stem, suffix].map(|part| part.unwrap_or_default().to_string_lossy().into_owned());
        let digits = views.to_string().len();
        let path = self.path.with_file_name(format!("{stem}-{:0digits$}.{suffix}", view + 1));
        Output { path, ..self }
    }

    /// The file of this name, with so many bits per channel if it is a PNG.
    pub(super) fn at(path: PathBuf, bits: Bits) -> Result<Self> {
        let suffix = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let format = match (suffix.as_str(), bits) {
            ("png", Bits::Eight) => Format::Png8,
            ("png", Bits::Sixteen) => Format::Png16,
            ("exr", _) => Format::Exr,
            _ => {
                return Err(Error::new(Fault::Spec, "the picture's suffix names no format")
                    .at(&path)
                    .expected(".png or .exr"));
            }
        };
        Ok(Output { path, format })
    }
}

impl Format {
    /// The format in words.
    pub(super) fn describe(self) -> &'static str {
        match self {
            Format::Png8 => "PNG, 8 bits, sRGB, straight alpha",
            Format::Png16 => "PNG, 16 bits, sRGB, straight alpha",
            Format::Exr => "OpenEXR, 32-bit floats, linear, premultiplied alpha",
        }
    }

    /// Bytes that the encoder holds whatever the size of the picture, as measured.
    pub(super) fn encoder_bytes(self) -> u64 {
        match self {
            Format::Png8 | Format::Png16 => 460_000,
            Format::Exr => 0,
        }
    }

    /// Bytes per pixel before compression.
    pub(super) fn bytes_per_pixel(self) -> u64 {
        match self {
            Format::Png8 => 4,
            Format::Png16 => 8,
            Format::Exr => 16,
        }
    }
}
