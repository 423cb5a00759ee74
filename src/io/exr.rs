//! OpenEXR pictures, linear f32, premultiplied alpha.
//!
//! Compressed without loss (ZIP, 16 lines). The order of the texts in the file is not fixed.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use exr::image as exr_image;
use exr::meta::attribute::{AttributeValue, Text};
use exr::prelude::{ReadChannels, ReadLayers, WritableImage};

use crate::error::{Error, Fault, Result};
use crate::image::Image;
use crate::io::{Picture, refuse_not_finite, whole_file};

/// The densest of the format's compressions makes at most this many bytes of one.
const MOST_BYTES_FROM_ONE: u64 = 1032;
/// Bytes of the thinnest pixel that can be read: three channels of 16 bits.
const FEWEST_BYTES_OF_A_PIXEL: u64 = 6;

/// Writes a picture with texts by name, as UTF-8.
///
/// # Errors
/// `Fault::Output` if the file cannot be written or a name is empty or longer than 255 bytes, `Fault::Internal` for a
/// pixel that is not finite.
pub fn write(path: &Path, image: &Image, texts: &[(String, String)]) -> Result<()> {
    refuse_not_finite(path, image)?;
    let pixel = |at: exr::math::Vec2<usize>| {
        let [r, g, b, a] = image.pixel(at.x(), at.y());
        (r, g, b, a)
    };
    let mut picture = exr_image::Image::from_encoded_channels(
        (image.width(), image.height()),
        exr_image::Encoding::SMALL_LOSSLESS,
        exr_image::SpecificChannels::rgba(pixel),
    );
    let own = &mut picture.layer_data.attributes.other;
    for (name, text) in texts {
        own.insert(utf8(name), AttributeValue::Text(utf8(text)));
    }
    whole_file::write(path, |file| picture.write().to_buffered(file))
}

/// The format's strings are bytes; UTF-8 by convention.
fn utf8(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

fn text(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

/// Reads the first layer with red, green and blue; without alpha it is opaque.
///
/// # Errors
/// `Fault::Input` for a file that is missing or damaged, or has no such layer.
pub fn read(path: &Path) -> Result<Picture> {
    let damaged = |cause: exr::error::Error| {
        Error::new(Fault::Input, "the picture cannot be read as OpenEXR").at(path).caused_by(cause)
    };
    let file = File::open(path).map_err(|cause| damaged(cause.into()))?;
    let length = file.metadata().map_err(|cause| damaged(cause.into()))?.len();
    let chunks = exr::block::read(BufReader::new(file), false).map_err(damaged)?;
    for header in chunks.headers() {
        let pixels = (header.layer_size.x() as u64).checked_mul(header.layer_size.y() as u64);
        let fewest = pixels.and_then(|n| n.checked_mul(FEWEST_BYTES_OF_A_PIXEL));
        if fewest.is_none_or(|n| n > length.saturating_mul(MOST_BYTES_FROM_ONE)) {
            return Err(Error::new(Fault::Input, "the file is too short for its picture")
                .at(path)
                .found(format!("{length} bytes"))
                .expected(format!("{} x {} pixels", header.layer_size.x(), header.layer_size.y())));
        }
    }
    let picture = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| Image::transparent(size.x(), size.y()),
            |image: &mut Image, at, (r, g, b, a): (f32, f32, f32, f32)| {
                let index = at.y() * image.width() + at.x();
                image.pixels_mut()[index] = [r, g, b, a];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_chunks(chunks)
        .map_err(damaged)?;
    let mut texts: Vec<(String, String)> = picture
        .layer_data
        .attributes
        .other
        .iter()
        .filter_map(|(name, value)| match value {
            AttributeValue::Text(value) => Some((text(name), text(value))),
            _ => None,
        })
        .collect();
    texts.sort();
    Ok(Picture { image: picture.layer_data.channel_data.pixels, texts })
}
