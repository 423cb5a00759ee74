//! Colour differences by CIEDE2000 (ISO/CIE 11664-6), of what a display shows.

use crate::image::Image;
use crate::image::color_space::{displayed, lab};

/// CIEDE2000 per pixel, row by row, of what a display shows in front of black; 1 is about what people can tell apart side
/// by side. The pictures must have one size.
pub fn delta_e_2000(a: &Image, b: &Image) -> Vec<f64> {
    let pairs = displayed(a).into_iter().zip(displayed(b));
    pairs.map(|(a, b)| if a == b { 0.0 } else { of_lab(lab(a), lab(b)) }).collect()
}

/// CIEDE2000 of two colours in CIELAB, with the parametric factors at 1; the formulas as Sharma, Wu and Dalal (2005) write
/// them out, including the cases of their §2 for hues.
fn of_lab([l1, a1, b1]: [f64; 3], [l2, a2, b2]: [f64; 3]) -> f64 {
    let seventh = |c: f64| {
        let c7 = c.powi(7);
        (c7 / (c7 + 25.0_f64.powi(7))).sqrt()
    };
    let mean_c = 0.5 * (a1.hypot(b1) + a2.hypot(b2));
    let stretch = 1.0 + 0.5 * (1.0 - seventh(mean_c));
    let (a1, a2) = (stretch * a1, stretch * a2);
    let (c1, c2) = (a1.hypot(b1), a2.hypot(b2));
    let hue = |a: f64, b: f64| if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a).to_degrees().rem_euclid(360.0) };
    let (h1, h2) = (hue(a1, b1), hue(a2, b2));
    let grey = c1 * c2 == 0.0;

    let turn = match h2 - h1 {
        _ if grey => 0.0,
        d if d > 180.0 => d - 360.0,
        d if d < -180.0 => d + 360.0,
        d => d,
    };
    let mean_h = match h1 + h2 {
        sum if grey => sum,
        sum if (h1 - h2).abs() <= 180.0 => 0.5 * sum,
        sum if sum < 360.0 => 0.5 * (sum + 360.0),
        sum => 0.5 * (sum - 360.0),
    };
    let cos = |degrees: f64| degrees.to_radians().cos();
    let (mean_l, mean_c) = (0.5 * (l1 + l2), 0.5 * (c1 + c2));
    let t = 1.0 - 0.17 * cos(mean_h - 30.0) + 0.24 * cos(2.0 * mean_h) + 0.32 * cos(3.0 * mean_h + 6.0)
        - 0.20 * cos(4.0 * mean_h - 63.0);
    let middle = (mean_l - 50.0).powi(2);
    let s_l = 1.0 + 0.015 * middle / (20.0 + middle).sqrt();
    let s_c = 1.0 + 0.045 * mean_c;
    let s_h = 1.0 + 0.015 * mean_c * t;
    let blue = 30.0 * (-((mean_h - 275.0) / 25.0).powi(2)).exp();
    let rotation = -2.0 * seventh(mean_c) * (2.0 * blue).to_radians().sin();

    let l = (l2 - l1) / s_l;
    let c = (c2 - c1) / s_c;
    let h = 2.0 * (c1 * c2).sqrt() * (0.5 * turn).to_radians().sin() / s_h;
    (l * l + c * c + h * h + rotation * c * h).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of the test data of Sharma, Wu and Dalal (2005), table 1, with the difference that they print: those that
    /// tell the cases of the hue apart, and ordinary ones.
    const PUBLISHED: [([f64; 3], [f64; 3], f64); 14] = [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 3.1571, -77.2803], [50.0, 0.0, -82.7485], 2.8615),
        ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0000),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0009], 7.1792),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0011], 7.2195),
        ([50.0, -0.0010, 2.4900], [50.0, 0.0011, -2.4900], 4.7461),
        ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
        ([50.0, 2.5, 0.0], [56.0, -27.0, -3.0], 31.9030),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ([35.0831, -44.1164, 3.7933], [35.0232, -40.0716, 1.5901], 1.8645),
        ([90.9257, -0.5406, -0.9208], [88.6381, -0.8985, -0.7239], 1.5381),
        ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514], 0.9082),
    ];

    #[test]
    fn published_differences_are_met() {
        for (a, b, expected) in PUBLISHED {
            for found in [of_lab(a, b), of_lab(b, a)] {
                assert!((found - expected).abs() < 5.1e-5, "{a:?} and {b:?}: found {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn black_and_white_are_a_hundred_apart() {
        let plain = |v: f32| Image::from_pixels(1, 1, vec![[v, v, v, 1.0]]);
        let found = delta_e_2000(&plain(0.0), &plain(1.0))[0];
        assert!((found - 100.0).abs() < 1e-6, "found {found}");
        assert_eq!(delta_e_2000(&plain(0.3), &plain(0.3)), [0.0]);
    }
}
