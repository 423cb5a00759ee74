//! Stacks of pictures, from their files to the composited one.

use std::fs::File;
use std::path::Path;

use pellucid::image::{Image, srgb};
use pellucid::io::png::{Depth, read, write};

use super::program::{Folder, pellucid};

const SIZE: [usize; 2] = [9, 5];

/// Encoded colours and alphas of three layers, in 16 bits.
fn texel(layer: usize, pixel: usize) -> [u16; 4] {
    let component = |c: usize| ((pixel + 1) * (7919 * (layer + 1) + 104_729 * c) % 65_536) as u16;
    [component(1), component(2), component(3), component(4)]
}

/// Writes a layer, its encoded colours multiplied by alpha if `associated`.
fn write_layer(path: &str, layer: usize, associated: bool) {
    let [width, height] = SIZE.map(|n| n as u32);
    let mut encoder = png::Encoder::new(File::create(path).unwrap(), width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Sixteen);
    let stored = (0..SIZE[0] * SIZE[1]).flat_map(|pixel| {
        let [r, g, b, a] = texel(layer, pixel);
        let times = |c: u16| (f64::from(c) * f64::from(a) / 65_535.0).round() as u16;
        if associated { [times(r), times(g), times(b), a] } else { [r, g, b, a] }
    });
    let bytes: Vec<u8> = stored.flat_map(u16::to_be_bytes).collect();
    encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
}

/// The formula C = Σ c α Π (1 − α) over a background.
fn expected(pixel: usize, behind: [f64; 3]) -> [f64; 3] {
    let (mut sum, mut left) = ([0.0; 3], 1.0);
    for layer in 0..3 {
        let [color @ .., alpha] = texel(layer, pixel).map(|x| f64::from(x) / 65_535.0);
        for (sum, c) in sum.iter_mut().zip(color) {
            *sum += left * alpha * srgb::decode(c);
        }
        left *= 1.0 - alpha;
    }
    std::array::from_fn(|c| sum[c] + left * behind[c])
}

#[test]
fn a_stack_is_the_formula_whether_straight_or_associated() {
    let folder = Folder::new("stack");
    for (alpha, associated) in [("straight", false), ("associated", true)] {
        for layer in 0..3 {
            write_layer(&folder.path(&format!("DOE{layer}.png")), layer, associated);
        }
        let stack = folder.write(
            "stack.yaml",
            &format!(
                "version: 1\nlayers: [DOE0.png, DOE1.png, DOE2.png]\nalpha: {alpha}\n\
                 image: {{ background: [0.25, 0.5, 1], bits: 16 }}\noutput: {alpha}.png\n"
            ),
        );
        let printed = pellucid(&["render", &stack]).success().stdout;
        assert_eq!(printed.trim_end(), folder.path(&format!("{alpha}.png")));
        let image = read(Path::new(printed.trim_end())).unwrap().image;
        assert_eq!([image.width(), image.height()], SIZE);
        for (pixel, found) in image.pixels().iter().enumerate() {
            for (found, expected) in found.iter().zip(expected(pixel, [0.25, 0.5, 1.0])) {
                let off = (f64::from(*found) - expected).abs();
                assert!(off < 6e-5, "{alpha}, pixel {pixel}: found {found}, expected {expected}");
            }
        }
        let sidecar = std::fs::read_to_string(folder.path(&format!("{alpha}.png.json"))).unwrap();
        assert!(!sidecar.contains("DOE"), "layers are known by their hashes alone; found:\n{sidecar}");
        let sidecar: serde_json::Value = serde_json::from_str(&sidecar).unwrap();
        assert_eq!(sidecar["inputs_sha256"].as_array().map(Vec::len), Some(4), "{sidecar}");
        assert_eq!(sidecar["plan"]["alpha"], alpha);
    }
}

#[test]
fn layers_that_do_not_fit_are_refused() {
    let folder = Folder::new("stack-refused");
    let layer = |name: &str, [width, height]: [usize; 2]| {
        let image = Image::from_pixels(width, height, vec![[0.5, 0.25, 0.0, 0.5]; width * height]);
        write(Path::new(&folder.path(name)), &image, Depth::Eight, &[]).unwrap();
    };
    layer("a.png", [4, 3]);
    layer("b.png", [3, 4]);
    let stack = folder.write("stack.yaml", "version: 1\nlayers: [a.png, b.png]\n");
    pellucid(&["render", &stack]).failure(4).says(&["b.png", "not of one size", "3 x 4", "4 x 3"]);
    let bright = folder.write("bright.yaml", "version: 1\nlayers: [a.png]\nalpha: associated\n");
    pellucid(&["render", &bright]).failure(4).says(&["a.png", "above its alpha", "alpha: straight"]);
    pellucid(&["explain", &stack]).success().says(&[]);
    assert_eq!(folder.names(), ["a.png", "b.png", "bright.yaml", "stack.yaml"], "nothing was written");
}
