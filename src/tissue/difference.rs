//! A picture of where labels and reference differ: a row of slices for each tissue.

use glam::DVec3;

use super::{Comparison, Pair};
use crate::image::{Image, srgb};
use crate::volume::{LabelMap, Volume};

/// Slices in a row.
const SLICES: usize = 6;
/// Pixels between pictures of slices.
const GAP: usize = 4;
/// Window of the scan's values as grey, HU: soft tissue with fat and bone still apart.
const WINDOW_HU: [f64; 2] = [-200.0, 300.0];

/// Colours in sRGB that are told apart with any colour vision (Okabe and Ito 2008), and how much of each covers the scan.
const BOTH: ([f32; 3], f32) = ([0.0, 0.62, 0.45], 0.35);
const LABELS_ONLY: ([f32; 3], f32) = ([0.90, 0.62, 0.0], 0.85);
const REFERENCE_ONLY: ([f32; 3], f32) = ([0.34, 0.71, 0.91], 0.85);

/// For each tissue a row of axial slices, over the scan if there is one: green where both have the tissue, orange where only
/// the labels do, blue where only the reference does. The patient's left is on the right, the front at the top.
pub fn picture(comparison: &Comparison<'_>, scan: Option<&Volume>) -> Image {
    let [nx, ny, _] = comparison.labels.grid().dims();
    let rows = comparison.pairs.len().max(1);
    let (width, height) = (SLICES * nx + (SLICES - 1) * GAP, rows * ny + (rows - 1) * GAP);
    let mut image = Image::from_pixels(width, height, vec![[0.0, 0.0, 0.0, 1.0]; width * height]);
    for (row, pair) in comparison.pairs.iter().enumerate() {
        for (column, k) in slices(comparison, pair).into_iter().enumerate() {
            draw(comparison, pair, scan, k, [column * (nx + GAP), row * (ny + GAP)], &mut image);
        }
    }
    image
}

/// Slices evenly spread over those in which either has the tissue; over all if none has.
fn slices(comparison: &Comparison<'_>, pair: &Pair) -> Vec<usize> {
    let [_, _, nz] = comparison.labels.grid().dims();
    let bounds = [comparison.mask(pair).bounds(), comparison.reference_mask(pair).bounds()];
    let ends = bounds.into_iter().flatten().map(|bounds| bounds[2]);
    let [first, last] = ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or([0, nz - 1]);
    (0..SLICES).map(|n| first + (2 * n + 1) * (last - first) / (2 * SLICES)).collect()
}

fn draw(
    comparison: &Comparison<'_>,
    pair: &Pair,
    scan: Option<&Volume>,
    k: usize,
    corner: [usize; 2],
    image: &mut Image,
) {
    let [nx, ny, _] = comparison.labels.grid().dims();
    let [flip_i, flip_j] = flips(comparison.labels);
    let width = image.width();
    for j in 0..ny {
        for i in 0..nx {
            let index = comparison.labels.grid().flatten([i, j, k]);
            let inside = comparison.labels.voxels()[index] == pair.label && pair.label != 0;
            let expected = pair.reference.contains(&comparison.reference.voxels()[index]);
            let grey = scan.map_or(0.0, |scan| grey(scan.value([i, j, k])));
            let (color, share) = match (inside, expected) {
                (true, true) => BOTH,
                (true, false) => LABELS_ONLY,
                (false, true) => REFERENCE_ONLY,
                (false, false) => ([0.0; 3], 0.0),
            };
            // Blended as seen, in sRGB: this is a drawing, and not light.
            let [r, g, b] = color.map(|channel| srgb::decode_f32(share * channel + (1.0 - share) * grey));
            let x = corner[0] + if flip_i { nx - 1 - i } else { i };
            let y = corner[1] + if flip_j { ny - 1 - j } else { j };
            image.pixels_mut()[y * width + x] = [r, g, b, 1.0];
        }
    }
}

/// Whether i goes to the patient's right, and j to the front, so that they are turned around.
fn flips(labels: &LabelMap) -> [bool; 2] {
    let m = labels.grid().index_to_lps_mm().matrix3;
    [m.x_axis.dot(DVec3::X) < 0.0, m.y_axis.dot(DVec3::Y) < 0.0]
}

fn grey(value: f64) -> f32 {
    let [black, white] = WINDOW_HU;
    ((value - black) / (white - black)).clamp(0.0, 1.0) as f32
}
