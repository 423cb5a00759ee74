//! Pictures, written and read.

mod exr;
mod png;
mod whole_file;

use pellucid::Image;

/// A picture with opaque, translucent and transparent pixels.
fn translucent() -> Image {
    let pixel = |i: usize| {
        let a = [1.0, 0.5, 0.0, 1.0 / 255.0][i % 4];
        let c = i as f32 / 34.0;
        [c * a, (1.0 - c) * a, 0.25 * a, a]
    };
    Image::from_pixels(7, 5, (0..35).map(pixel).collect())
}

/// The same without transparency.
fn opaque() -> Image {
    let pixels = translucent().pixels().iter().map(|&[r, g, b, _]| [r, g, b, 1.0]).collect();
    Image::from_pixels(7, 5, pixels)
}

fn texts(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect()
}
