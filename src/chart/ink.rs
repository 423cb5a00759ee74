//! Colours for counts: on white paper, the more the darker.

use crate::image::srgb;

/// The colour of a share in [0, 1], sRGB: lightness falls evenly from near white to near black in Oklab (Ottosson 2020), a
/// space made so that equal steps look equal; the hue only turns from cyan to blue, away from those of tissues.
pub(super) fn color(share: f64) -> [f64; 3] {
    let share = share.clamp(0.0, 1.0);
    let lightness = 0.93 - 0.70 * share;
    let chroma = 0.035 + 0.065 * (std::f64::consts::PI * share).sin();
    let hue = (215.0 + 50.0 * share).to_radians();
    oklab_to_srgb([lightness, chroma * hue.cos(), chroma * hue.sin()])
}

fn oklab_to_srgb([lightness, a, b]: [f64; 3]) -> [f64; 3] {
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    let linear = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ];
    linear.map(|channel| srgb::encode(channel.clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance (Rec. 709).
    fn luminance(share: f64) -> f64 {
        let [r, g, b] = color(share).map(srgb::decode);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    #[test]
    fn more_is_darker_from_light_to_dark() {
        let all: Vec<f64> = (0..=100).map(|n| luminance(f64::from(n) / 100.0)).collect();
        assert!(all.windows(2).all(|pair| pair[0] > pair[1]), "luminance falls: {all:?}");
        assert!(all[0] > 0.7 && all[0] < 0.9, "one voxel is seen on white paper: {}", all[0]);
        assert!(all[100] < 0.03, "the fullest bin is dark: {}", all[100]);
    }

    #[test]
    fn without_chroma_it_is_grey() {
        let [r, g, b] = oklab_to_srgb([1.0, 0.0, 0.0]);
        assert!((r - 1.0).abs() < 1e-4 && (g - 1.0).abs() < 1e-4 && (b - 1.0).abs() < 1e-4, "white, found {r} {g} {b}");
    }
}
