//! ꟻLIP (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild 2020): how much of a difference is seen when
//! two pictures are flipped between on one display.

use crate::image::Image;
use crate::image::color_space::{displayed, lab, rgb_of, xyz_of_white};
use crate::image::plane::{Plane, gaussian, kernel};

/// Pixels per degree of the paper's display: 3840 pixels on 0.7 m, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;

/// The paper's constants: exponents of colours and features, and where the colour difference bends.
const COLOR_EXPONENT: f64 = 0.7;
const FEATURE_EXPONENT: f64 = 0.5;
const BEND_AT: f64 = 0.4;
const BEND_TO: f64 = 0.95;
/// Width of the feature detectors, degrees.
const FEATURE_DEGREES: f64 = 0.082;

/// Contrast sensitivity per channel (luminance, red-green, blue-yellow) as sums of Gaussians: `[a, b]` of table 1.
const SENSITIVITY: [&[[f64; 2]]; 3] = [&[[1.0, 0.0047]], &[[1.0, 0.0053]], &[[34.1, 0.04], [13.5, 0.025]]];

/// ꟻLIP's error per pixel, row by row, from 0 (not seen) to 1, of what a display shows in front of black. The pictures must
/// have one size.
pub fn flip(reference: &Image, test: &Image, pixels_per_degree: f64) -> Vec<f64> {
    let [reference, test] = [reference, test].map(|image| Seen::new(image, pixels_per_degree));
    let largest = hyab(hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0])).powf(COLOR_EXPONENT);
    (0..reference.colors.len())
        .map(|i| {
            let color = bent(hyab(reference.colors[i], test.colors[i]).powf(COLOR_EXPONENT), largest);
            let edge = (reference.edges[i] - test.edges[i]).abs();
            let point = (reference.points[i] - test.points[i]).abs();
            let feature = (edge.max(point) * std::f64::consts::FRAC_1_SQRT_2).powf(FEATURE_EXPONENT);
            color.powf(1.0 - feature)
        })
        .collect()
}

/// A picture as the eye sees it from the display's distance.
struct Seen {
    /// Filtered by contrast sensitivity, CIELAB after Hunt.
    colors: Vec<[f64; 3]>,
    /// Strength of edges and points of the luminance.
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Seen {
    fn new(image: &Image, pixels_per_degree: f64) -> Self {
        let opponent: Vec<[f64; 3]> = displayed(image).into_iter().map(opponent).collect();
        let plane = |c: usize| Plane {
            width: image.width(),
            height: image.height(),
            values: opponent.iter().map(|o| o[c]).collect(),
        };
        let luminance = plane(0);
        let filtered: [Plane; 3] = std::array::from_fn(|c| blurred(&plane(c), SENSITIVITY[c], pixels_per_degree));
        let color = |i: usize| hunt(from_opponent([0, 1, 2].map(|c| filtered[c].values[i])).map(|v| v.clamp(0.0, 1.0)));
        let [edges, points] = features(&luminance, pixels_per_degree);
        Seen { colors: (0..opponent.len()).map(color).collect(), edges, points }
    }
}

/// The linear opponent space YCxCz of linear RGB, with the luminance from 0 to 1.
fn opponent(rgb: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = xyz_of_white(rgb);
    [y, x - y, y - z]
}

fn from_opponent([y, cx, cz]: [f64; 3]) -> [f64; 3] {
    rgb_of([cx + y, y, y - cz])
}

/// Filtered by a sum of Gaussians of distances in degrees, `a √(π/b) exp(-π² d²/b)`, normalised together.
fn blurred(plane: &Plane, gaussians: &[[f64; 2]], pixels_per_degree: f64) -> Plane {
    use std::f64::consts::PI;
    // One radius for all channels: three standard deviations of the widest.
    let widest = SENSITIVITY.iter().flat_map(|g| g.iter()).map(|[_, b]| *b).fold(0.0, f64::max);
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as usize;
    let mut sum: Option<Plane> = None;
    let mut total = 0.0;
    for &[a, b] in gaussians {
        let weights = kernel(radius, |x| (-(PI * x / pixels_per_degree).powi(2) / b).exp());
        let scale = a * (PI / b).sqrt();
        total += scale * weights.iter().sum::<f64>().powi(2);
        let part = plane.filtered(&weights, &weights);
        sum = Some(match sum {
            None => part.combined(&part, |x, _| scale * x),
            Some(sum) => sum.combined(&part, |s, x| s + scale * x),
        });
    }
    let sum = sum.unwrap_or_else(|| plane.clone());
    sum.combined(&sum, |s, _| s / total)
}

/// Strengths of edges (first derivatives) and points (second derivatives) of the luminance.
fn features(luminance: &Plane, pixels_per_degree: f64) -> [Vec<f64>; 2] {
    let deviation = 0.5 * FEATURE_DEGREES * pixels_per_degree;
    let radius = (3.0 * deviation).ceil() as usize;
    let smooth = gaussian(radius, deviation);
    let bell = |x: f64| (-0.5 * (x / deviation).powi(2)).exp();
    let edge = balanced(kernel(radius, |x| -x * bell(x)));
    let point = balanced(kernel(radius, |x| ((x / deviation).powi(2) - 1.0) * bell(x)));
    [edge, point].map(|across| {
        let x = luminance.filtered(&across, &smooth);
        let y = luminance.filtered(&smooth, &across);
        x.combined(&y, f64::hypot).values
    })
}

/// Scaled so that the weights above 0 add up to 1 and those below to -1.
fn balanced(weights: Vec<f64>) -> Vec<f64> {
    let above: f64 = weights.iter().filter(|w| **w > 0.0).sum();
    let below: f64 = -weights.iter().filter(|w| **w < 0.0).sum::<f64>();
    weights.into_iter().map(|w| if w > 0.0 { w / above } else { w / below }).collect()
}

/// CIELAB with the chroma weakened in the dark (Hunt's effect).
fn hunt(rgb: [f64; 3]) -> [f64; 3] {
    let [l, a, b] = lab(rgb);
    [l, 0.01 * l * a, 0.01 * l * b]
}

/// The HyAB distance (Abasi, Amani Tehran and Fairchild 2020).
fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// The colour difference redistributed to [0, 1]: most of the range for what is not extreme.
fn bent(difference: f64, largest: f64) -> f64 {
    let bend = BEND_AT * largest;
    if difference < bend {
        difference * BEND_TO / bend
    } else {
        BEND_TO + (difference - bend) / (largest - bend) * (1.0 - BEND_TO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::metrics::test_pictures;

    const AUTHORS_MEAN: f64 = 0.239_605_650;
    /// Pixels counted row by row, and what they show.
    const AUTHORS: [(usize, f64); 6] = [
        (0, 0.151_779_294),
        (500, 0.236_533_180),
        (740, 0.220_632_613),
        (1003, 0.220_809_981),
        (1500, 0.161_320_865),
        (1919, 0.429_957_271),
    ];

    #[test]
    fn it_is_what_the_authors_program_finds() {
        let (a, b) = test_pictures();
        let map = flip(&a, &b, PIXELS_PER_DEGREE);
        let mean = map.iter().sum::<f64>() / map.len() as f64;
        // flip-evaluator 1.7 (the authors' C++ in f32), LDR, of the same pictures in sRGB.
        assert!((mean - AUTHORS_MEAN).abs() < 2e-5, "mean: found {mean}, expected {AUTHORS_MEAN}");
        for (place, expected) in AUTHORS {
            assert!((map[place] - expected).abs() < 2e-4, "pixel {place}: found {}, expected {expected}", map[place]);
        }
    }

    #[test]
    fn equal_pictures_do_not_flicker() {
        let (a, _) = test_pictures();
        assert!(flip(&a, &a, PIXELS_PER_DEGREE).iter().all(|&e| e == 0.0));
    }
}
