//! PNG pictures, sRGB, 8 or 16 bits, straight alpha.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use png::{BitDepth, ColorType, SrgbRenderingIntent, Transformations};

use crate::error::{Error, Fault, Result};
use crate::image::over::Association;
use crate::image::{Image, srgb};
use crate::io::{Picture, refuse_not_finite, whole_file};

/// Bits of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Depth {
    /// 8 bits.
    Eight,
    /// 16 bits.
    Sixteen,
}

/// Deflate makes at most 1032 bytes of one, so a smaller file cannot hold more.
const MOST_BYTES_FROM_ONE: u64 = 1032;
/// What stands for sRGB in the gamma chunk, 1/2.2 in units of 1e-5 (PNG 11.3.2.5).
const SRGB_GAMMA: u32 = 45_455;
/// How far a gamma may be from it.
const GAMMA_TOLERANCE: u32 = 1000;

/// Writes a picture: RGB if it is opaque, RGBA if not, with texts by keyword.
///
/// # Errors
/// `Fault::Output` if the file cannot be written or a keyword is not 1 to 79 characters of Latin-1;
/// `Fault::Internal` for a pixel that is not finite.
pub fn write(path: &Path, image: &Image, depth: Depth, texts: &[(String, String)]) -> Result<()> {
    refuse_not_finite(path, image)?;
    let size = |n: usize| u32::try_from(n).map_err(|_| png::EncodingError::LimitsExceeded);
    whole_file::write(path, |file| -> Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(file, size(image.width())?, size(image.height())?);
        let opaque = image.pixels().iter().all(|pixel| pixel[3] >= 1.0);
        encoder.set_color(if opaque { ColorType::Rgb } else { ColorType::Rgba });
        encoder.set_depth(match depth {
            Depth::Eight => BitDepth::Eight,
            Depth::Sixteen => BitDepth::Sixteen,
        });
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        // For programs that do not know the sRGB chunk.
        encoder.set_source_gamma(png::ScaledFloat::from_scaled(SRGB_GAMMA));
        for (keyword, text) in texts {
            if text.chars().all(|c| u32::from(c) < 256) {
                encoder.add_text_chunk(keyword.clone(), text.clone())?;
            } else {
                encoder.add_itxt_chunk(keyword.clone(), text.clone())?;
            }
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&encode(image, depth, if opaque { 3 } else { 4 }))?;
        writer.finish()
    })
}

/// Samples as the file holds them, big-endian.
fn encode(image: &Image, depth: Depth, channels: usize) -> Vec<u8> {
    let pixels = image.pixels().iter();
    match depth {
        Depth::Eight => pixels.flat_map(|&p| srgb::encode8(p).into_iter().take(channels)).collect(),
        Depth::Sixteen => {
            pixels.flat_map(|&p| srgb::encode16(p).into_iter().take(channels).flat_map(u16::to_be_bytes)).collect()
        }
    }
}

/// Reads a picture of any PNG type, as sRGB.
///
/// # Errors
/// `Fault::Input` for a file that is missing or damaged, `Fault::Unsupported` for one that says its samples are not
/// sRGB.
pub fn read(path: &Path) -> Result<Picture> {
    read_as(path, Association::Straight)
}

/// As [`read`], for files whose colours are multiplied by their alpha too.
///
/// # Errors
/// As [`read`], and `Fault::Input` for a pixel whose colour is above its alpha where colours are said to be multiplied by it.
pub fn read_as(path: &Path, association: Association) -> Result<Picture> {
    let damaged = |cause: png::DecodingError| {
        Error::new(Fault::Input, "the picture cannot be read as PNG").at(path).caused_by(cause)
    };
    let file = File::open(path).map_err(|cause| damaged(cause.into()))?;
    let length = file.metadata().map_err(|cause| damaged(cause.into()))?.len();
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(damaged)?;

    // Where an sRGB chunk is given, this is its substitute.
    let gamma = reader.info().gamma();
    if let Some(gamma) = gamma
        && gamma.into_scaled().abs_diff(SRGB_GAMMA) > GAMMA_TOLERANCE
    {
        return Err(Error::new(Fault::Unsupported, "the picture is not in sRGB")
            .at(path)
            .element("gAMA")
            .found(gamma.into_value().to_string())
            .expected("0.45455, or an sRGB chunk"));
    }
    // Expansion makes up to 32 bytes of one: each bit of a palette's index becomes RGB and alpha.
    let most = length.saturating_mul(32 * MOST_BYTES_FROM_ONE);
    let bytes = reader.output_buffer_size().filter(|&n| n as u64 <= most).ok_or_else(|| {
        Error::new(Fault::Input, "the file is too short for its picture").at(path).found(format!("{length} bytes"))
    })?;
    let mut samples = vec![0; bytes];
    let frame = reader.next_frame(&mut samples).map_err(damaged)?;
    samples.truncate(frame.buffer_size());
    // Texts may follow the picture.
    reader.finish().map_err(damaged)?;

    let (width, height) = (frame.width as usize, frame.height as usize);
    let pixels = match association {
        Association::Straight => decode(&samples, frame.color_type, frame.bit_depth),
        Association::Associated => decode_associated(path, width, &samples, frame.color_type, frame.bit_depth)?,
    };
    if pixels.len() != width * height {
        return Err(Error::new(Fault::Input, "the picture has the wrong number of samples").at(path));
    }
    let info = reader.info();
    let latin = info.uncompressed_latin1_text.iter().map(|chunk| (chunk.keyword.clone(), chunk.text.clone()));
    let utf8 = info.utf8_text.iter().filter_map(|chunk| Some((chunk.keyword.clone(), chunk.get_text().ok()?)));
    Ok(Picture { image: Image::from_pixels(width, height, pixels), texts: latin.chain(utf8).collect() })
}

/// Linear premultiplied pixels of expanded samples.
fn decode(samples: &[u8], color: ColorType, depth: BitDepth) -> Vec<[f32; 4]> {
    let channels = color.samples();
    match depth {
        BitDepth::Sixteen => {
            let sample = |bytes: &[u8]| u16::from_be_bytes([bytes[0], bytes[1]]);
            let pixel = |bytes: &[u8]| srgb::decode16(rgba(bytes.chunks_exact(2).map(sample), color, u16::MAX));
            samples.chunks_exact(2 * channels).map(pixel).collect()
        }
        _ => {
            let pixel = |bytes: &[u8]| srgb::decode8(rgba(bytes.iter().copied(), color, u8::MAX));
            samples.chunks_exact(channels).map(pixel).collect()
        }
    }
}

/// The same where encoded colours are multiplied by their alpha.
fn decode_associated(
    path: &Path,
    width: usize,
    samples: &[u8],
    color: ColorType,
    depth: BitDepth,
) -> Result<Vec<[f32; 4]>> {
    let channels = color.samples();
    let stored: Vec<[f32; 4]> = match depth {
        BitDepth::Sixteen => {
            let sample = |bytes: &[u8]| f32::from(u16::from_be_bytes([bytes[0], bytes[1]])) / f32::from(u16::MAX);
            samples.chunks_exact(2 * channels).map(|p| rgba(p.chunks_exact(2).map(sample), color, 1.0)).collect()
        }
        _ => {
            let sample = |&byte: &u8| f32::from(byte) / f32::from(u8::MAX);
            samples.chunks_exact(channels).map(|p| rgba(p.iter().map(sample), color, 1.0)).collect()
        }
    };
    let pixel = |(index, pixel): (usize, &[f32; 4])| {
        srgb::decode_associated(*pixel).ok_or_else(|| {
            Error::new(Fault::Input, "a pixel's colour is above its alpha, and so is not multiplied by it")
                .at(path)
                .element(format!("column {}, row {}", index % width, index / width))
                .found(format!("{pixel:.3?}"))
                .expected("red, green and blue of at most alpha")
                .remedy("write alpha: straight")
        })
    };
    stored.iter().enumerate().map(pixel).collect()
}

/// The samples of one pixel as red, green, blue and alpha.
fn rgba<T: Copy>(mut samples: impl Iterator<Item = T>, color: ColorType, opaque: T) -> [T; 4] {
    let mut next = || samples.next().unwrap_or(opaque);
    match color {
        ColorType::Grayscale | ColorType::GrayscaleAlpha => {
            let gray = next();
            [gray, gray, gray, if color == ColorType::GrayscaleAlpha { next() } else { opaque }]
        }
        _ => [next(), next(), next(), next()],
    }
}
