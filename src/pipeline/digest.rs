//! SHA-256 of what goes in and of what comes out.

use sha2::{Digest, Sha256};

use crate::image::Image;

/// Hash of a text, in hexadecimal digits.
pub(super) fn of_text(text: &str) -> String {
    hexadecimal(&Sha256::digest(text.as_bytes()))
}

/// Hash of a picture before encoding: linear premultiplied RGBA, row by row from the top left, each channel as the four
/// bytes of its f32 in little-endian order.
pub(super) fn of_pixels(image: &Image) -> String {
    let mut hash = Sha256::new();
    for channel in image.pixels().as_flattened() {
        hash.update(channel.to_le_bytes());
    }
    hexadecimal(&hash.finalize())
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_that_of_the_standard() {
        // FIPS 180-4, the example of one block: "abc".
        assert_eq!(of_text("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }

    #[test]
    fn pixels_are_hashed_as_little_endian_floats() {
        let image = Image::from_pixels(1, 1, vec![[1.0, 0.0, 0.5, 1.0]]);
        let bytes = [0, 0, 0x80, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0x3f, 0, 0, 0x80, 0x3f];
        assert_eq!(of_pixels(&image), hexadecimal(&Sha256::digest(bytes)));
    }
}
