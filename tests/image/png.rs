//! PNG: our own reader takes what our writer gives, and the bytes are what the standard says.

use std::fs;

use pellucid::image::metrics;
use pellucid::io::png::{self, Depth};
use pellucid::{Fault, Image};

use super::{opaque, texts, translucent};

#[test]
fn pictures_come_back_to_half_a_level() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    for (name, image) in [("translucent", translucent()), ("opaque", opaque())] {
        // Near white, one level of sRGB is 2.2 times as much in linear light; alpha is not encoded.
        for (depth, levels) in [(Depth::Eight, 255.0), (Depth::Sixteen, 65_535.0)] {
            png::write(&path, &image, depth, &[]).unwrap();
            let read = png::read(&path).unwrap().image;
            let difference = metrics::compare(&image, &read, 0.5 * 2.3 / levels + 1e-6).unwrap();
            assert_eq!(difference.pixels_over, 0, "{name}, {depth:?}: {:?}", difference.worst);
            assert!(difference.max_abs[3] <= 0.5 / levels + 1e-6, "{name}, {depth:?}: alpha {:?}", difference.max_abs);
        }
    }
}

#[test]
fn files_say_that_they_are_srgb() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    for (image, depth, bits, color) in [
        (translucent(), Depth::Eight, 8, 6),
        (translucent(), Depth::Sixteen, 16, 6),
        (opaque(), Depth::Eight, 8, 2),
        (opaque(), Depth::Sixteen, 16, 2),
    ] {
        png::write(&path, &image, depth, &texts(&[("Software", "pellucid")])).unwrap();
        let bytes = fs::read(&path).unwrap();
        // PNG, 11.2.2: width, height, bit depth, colour type after the name of the first chunk.
        assert_eq!(&bytes[12..26], [b"IHDR".as_slice(), &[0, 0, 0, 7, 0, 0, 0, 5, bits, color]].concat());
        let find = |chunk: &[u8]| bytes.windows(chunk.len()).any(|window| window == chunk);
        assert!(find(b"sRGB\0"), "perceptual intent");
        assert!(find(&[b"gAMA".as_slice(), &45_455_u32.to_be_bytes()].concat()), "gamma 1/2.2 for those who ask");
        assert!(find(b"tEXtSoftware\0pellucid"), "text");
    }
}

#[test]
fn one_gray_pixel_has_the_standards_level() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    // 18 % gray is level 118 of 255; half covered, it is the same colour at half alpha.
    let image = Image::from_pixels(2, 1, vec![[0.18, 0.18, 0.18, 1.0], [0.09, 0.09, 0.09, 0.5]]);
    png::write(&path, &image, Depth::Eight, &[]).unwrap();
    let mut decoder = ::png::Decoder::new(std::io::BufReader::new(fs::File::open(&path).unwrap())).read_info().unwrap();
    let mut samples = vec![0; decoder.output_buffer_size().unwrap()];
    decoder.next_frame(&mut samples).unwrap();
    assert_eq!(samples, [118, 118, 118, 255, 118, 118, 118, 128]);
}

#[test]
fn texts_come_back_in_every_script() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let written = texts(&[("Plan", "{\"a\": 1}\nb"), ("Größe", "5 µm"), ("Title", "頭部 CT")]);
    png::write(&path, &opaque(), Depth::Eight, &written).unwrap();
    assert_eq!(png::read(&path).unwrap().texts, written);
    let error = png::write(&path, &opaque(), Depth::Eight, &texts(&[("", "no keyword")])).unwrap_err();
    assert_eq!(error.fault(), Fault::Output, "{error}");
}

#[test]
fn gray_and_palette_pictures_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let write = |color, depth, palette: Option<Vec<u8>>, data: &[u8]| {
        let mut encoder = ::png::Encoder::new(fs::File::create(&path).unwrap(), 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if let Some(palette) = palette {
            encoder.set_palette(palette);
        }
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        png::read(&path).unwrap().image
    };
    use ::png::{BitDepth, ColorType};
    let black_and_white = [[0.0, 0.0, 0.0, 1.0], [1.0, 1.0, 1.0, 1.0]];
    assert_eq!(write(ColorType::Grayscale, BitDepth::One, None, &[0x40]).pixels(), black_and_white);
    assert_eq!(write(ColorType::Grayscale, BitDepth::Sixteen, None, &[0, 0, 255, 255]).pixels(), black_and_white);
    let half = write(ColorType::GrayscaleAlpha, BitDepth::Eight, None, &[255, 51, 0, 255]);
    assert_eq!(half.pixels(), [[0.2; 4], [0.0, 0.0, 0.0, 1.0]], "white at alpha 0.2 is premultiplied");
    let palette = Some(vec![0, 0, 0, 255, 255, 255]);
    assert_eq!(write(ColorType::Indexed, BitDepth::Eight, palette, &[0, 1]).pixels(), black_and_white);
}

#[test]
fn pictures_that_cannot_be_read_or_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let mut image = opaque();
    image.pixels_mut()[9][2] = f32::NAN;
    let error = png::write(&path, &image, Depth::Eight, &[]).unwrap_err();
    assert_eq!(error.fault(), Fault::Internal);
    assert!(error.to_string().contains("(column 2, row 1)"), "{error}");
    assert!(!path.exists(), "nothing is written");

    png::write(&path, &opaque(), Depth::Eight, &[]).unwrap();
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() - 30]).unwrap();
    assert_eq!(png::read(&path).unwrap_err().fault(), Fault::Input, "cut off");
    assert_eq!(png::read(&folder.path().join("none.png")).unwrap_err().fault(), Fault::Input, "missing");

    let mut encoder = ::png::Encoder::new(fs::File::create(&path).unwrap(), 1, 1);
    encoder.set_source_gamma(::png::ScaledFloat::new(1.0));
    encoder.write_header().unwrap().write_image_data(&[7]).unwrap();
    let error = png::read(&path).unwrap_err();
    assert_eq!((error.fault(), error.what()), (Fault::Unsupported, "the picture is not in sRGB"));
}
