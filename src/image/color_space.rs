//! Colours as people see them: CIE XYZ and CIELAB from linear RGB with the primaries and the white of sRGB.

use super::Image;

/// Linear RGB to CIE XYZ, from the chromaticities of IEC 61966-2-1 (ITU-R BT.709 primaries, D65).
const TO_XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// What a display shows of a picture in front of black: linear RGB clipped to [0, 1]; what is not a number is black.
pub(super) fn displayed(image: &Image) -> Vec<[f64; 3]> {
    let shown = |v: f32| if v > 0.0 { f64::from(v).min(1.0) } else { 0.0 };
    image.pixels().iter().map(|&[r, g, b, _]| [r, g, b].map(shown)).collect()
}

/// CIE XYZ over that of white, so that white is (1, 1, 1).
pub(super) fn xyz_of_white(rgb: [f64; 3]) -> [f64; 3] {
    TO_XYZ.map(|row| {
        let white: f64 = row.iter().sum();
        row.iter().zip(rgb).map(|(m, c)| m * c).sum::<f64>() / white
    })
}

/// Linear RGB of CIE XYZ over that of white; the inverse of [`xyz_of_white`].
pub(super) fn rgb_of(xyz: [f64; 3]) -> [f64; 3] {
    let rows = TO_XYZ.map(|row| {
        let white: f64 = row.iter().sum();
        row.map(|m| m / white)
    });
    let matrix = glam::DMat3::from_cols_array_2d(&rows).transpose().inverse();
    (matrix * glam::DVec3::from_array(xyz)).to_array()
}

/// CIELAB (ISO/CIE 11664-4) of linear RGB.
pub(super) fn lab(rgb: [f64; 3]) -> [f64; 3] {
    let delta: f64 = 6.0 / 29.0;
    let [fx, fy, fz] =
        xyz_of_white(rgb).map(|t| if t > delta.powi(3) { t.cbrt() } else { t / (3.0 * delta * delta) + 4.0 / 29.0 });
    [116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_grey_and_the_primaries_are_where_the_standards_put_them() {
        // L*, a*, b* of the sRGB primaries under D65, as tables of the colour space print them.
        for (rgb, expected) in [
            ([1.0, 1.0, 1.0], [100.0, 0.0, 0.0]),
            ([1.0, 0.0, 0.0], [53.24, 80.09, 67.20]),
            ([0.0, 1.0, 0.0], [87.73, -86.18, 83.18]),
            ([0.0, 0.0, 1.0], [32.30, 79.19, -107.86]),
        ] {
            let found = lab(rgb);
            let off = (0..3).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f64::max);
            assert!(off < 0.02, "{rgb:?}: found {found:?}, expected {expected:?}");
        }
        let back = rgb_of(xyz_of_white([0.1, 0.5, 0.9]));
        assert!((back[0] - 0.1).abs() + (back[1] - 0.5).abs() + (back[2] - 0.9).abs() < 1e-14, "found {back:?}");
    }

    #[test]
    fn what_a_display_cannot_show_is_clipped() {
        let image = Image::from_pixels(2, 1, vec![[f32::NAN, -1.0, 2.0, 0.0], [0.5, 0.0, 1.0, 1.0]]);
        assert_eq!(displayed(&image), [[0.0, 0.0, 1.0], [0.5, 0.0, 1.0]]);
    }
}
