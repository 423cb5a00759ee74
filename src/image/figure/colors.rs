//! A colour scale whose lightness rises evenly, so that it reads in grey and by the colour-blind alike.

use crate::image::srgb;

/// Encoded sRGB at equal distances, from nothing to full scale: near black over violet and orange to near white.
const STOPS: [[f64; 3]; 9] = [
    [0.00, 0.00, 0.02],
    [0.12, 0.06, 0.29],
    [0.31, 0.07, 0.48],
    [0.51, 0.15, 0.51],
    [0.71, 0.21, 0.48],
    [0.90, 0.31, 0.39],
    [0.98, 0.53, 0.38],
    [0.996, 0.77, 0.54],
    [0.99, 0.99, 0.75],
];

/// The colour of a share of full scale, linear and opaque; beyond its ends, and for what is not a number, as at an end.
pub(super) fn color_of(share: f64) -> [f32; 4] {
    let at = share.clamp(0.0, 1.0);
    let at = if at.is_nan() { 1.0 } else { at } * (STOPS.len() - 1) as f64;
    let below = (at as usize).min(STOPS.len() - 2);
    let u = at - below as f64;
    let channel = |c: usize| srgb::decode((1.0 - u) * STOPS[below][c] + u * STOPS[below + 1][c]) as f32;
    [channel(0), channel(1), channel(2), 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::color_space::lab;

    #[test]
    fn lightness_rises_evenly() {
        let lightness = |i: u16| lab([0, 1, 2].map(|c| f64::from(color_of(f64::from(i) / 64.0)[c])))[0];
        let steps: Vec<f64> = (0..64).map(|i| lightness(i + 1) - lightness(i)).collect();
        let (least, most) = steps.iter().fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), &s| (l.min(s), m.max(s)));
        assert!(least > 0.5 && most < 2.7, "steps of lightness from {least} to {most}");
    }
}
