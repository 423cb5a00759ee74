//! OpenEXR: linear and premultiplied, nothing is lost.

use std::fs;

use pellucid::io::exr;
use pellucid::{Fault, Image};

use super::{opaque, texts, translucent};

#[test]
fn pictures_come_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let bright = Image::from_pixels(2, 1, vec![[1e30, -2.5, 1e-38, 0.0], [f32::MIN_POSITIVE, 7.0, 0.1, 3.0]]);
    for image in [translucent(), opaque(), bright] {
        exr::write(&path, &image, &[]).unwrap();
        assert_eq!(exr::read(&path).unwrap().image, image);
    }
}

#[test]
fn texts_come_back_in_every_script() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let written = texts(&[("pellucid:plan", "{\"a\": 1}\nb"), ("pellucid:title", "頭部 5 µm")]);
    exr::write(&path, &opaque(), &written).unwrap();
    assert_eq!(exr::read(&path).unwrap().texts, written);
    let error = exr::write(&path, &opaque(), &texts(&[(&"x".repeat(256), "too long a name")])).unwrap_err();
    assert_eq!(error.fault(), Fault::Output, "{error}");
}

#[test]
fn pictures_that_cannot_be_read_or_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let mut image = opaque();
    image.pixels_mut()[0][3] = f32::INFINITY;
    assert_eq!(exr::write(&path, &image, &[]).unwrap_err().fault(), Fault::Internal, "infinite");
    assert!(!path.exists(), "nothing is written");
    exr::write(&path, &opaque(), &[]).unwrap();
    let bytes = fs::read(&path).unwrap();
    for (name, bytes) in
        [("cut off", &bytes[..bytes.len() / 2]), ("empty", &[][..]), ("something else", b"P5 1 1 255 0")]
    {
        fs::write(&path, bytes).unwrap();
        assert_eq!(exr::read(&path).unwrap_err().fault(), Fault::Input, "{name}");
    }
}
