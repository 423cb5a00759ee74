//! sRGB (IEC 61966-2-1): the transfer function both ways, and pixels as files hold them.
//!
//! In memory a pixel is linear and premultiplied; in a PNG it is sRGB with straight alpha. Straight alpha cannot hold
//! colour without opacity, nor colour brighter than its opacity: both are clipped.

/// Encodes a linear value in [0, 1]; the definition, in f64.
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Decodes an sRGB value in [0, 1] to a linear one; the definition, in f64.
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// As [`encode`], in f32.
pub fn encode_f32(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// As [`decode`], in f32.
pub fn decode_f32(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// A linear premultiplied pixel as sRGB with straight alpha, 8 bits, rounded to nearest.
pub fn encode8(pixel: [f32; 4]) -> [u8; 4] {
    // Rounded to whole numbers within the range.
    quantise(pixel, 255.0).map(|v| v as u8)
}

/// A linear premultiplied pixel as sRGB with straight alpha, 16 bits, rounded to nearest.
pub fn encode16(pixel: [f32; 4]) -> [u16; 4] {
    // Rounded to whole numbers within the range.
    quantise(pixel, 65_535.0).map(|v| v as u16)
}

/// An 8-bit sRGB pixel with straight alpha as linear and premultiplied; the inverse of [`encode8`].
pub fn decode8(pixel: [u8; 4]) -> [f32; 4] {
    premultiplied(pixel.map(|v| f32::from(v) / 255.0))
}

/// A 16-bit sRGB pixel with straight alpha as linear and premultiplied; the inverse of [`encode16`].
pub fn decode16(pixel: [u16; 4]) -> [f32; 4] {
    premultiplied(pixel.map(|v| f32::from(v) / 65_535.0))
}

/// An sRGB pixel in [0, 1] whose encoded colour was multiplied by its alpha, as linear and premultiplied; `None` if a colour
/// is above the alpha, which no product can be.
pub fn decode_associated([r, g, b, a]: [f32; 4]) -> Option<[f32; 4]> {
    if r.max(g).max(b) > a {
        return None;
    }
    Some(if a > 0.0 { premultiplied([r / a, g / a, b / a, a]) } else { [0.0; 4] })
}

/// Whole numbers from 0 to `largest`, red to alpha.
fn quantise([r, g, b, a]: [f32; 4], largest: f32) -> [f32; 4] {
    if a <= 0.0 {
        return [0.0; 4];
    }
    let color = |c: f32| encode_f32((c / a).clamp(0.0, 1.0));
    [color(r), color(g), color(b), a.min(1.0)].map(|v| (v * largest).round())
}

fn premultiplied([r, g, b, a]: [f32; 4]) -> [f32; 4] {
    [decode_f32(r) * a, decode_f32(g) * a, decode_f32(b) * a, a]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transfer_function_has_the_standards_values() {
        // The standard's two branches, evaluated by hand: linear, encoded.
        for (linear, encoded) in [
            (0.0, 0.0),
            (0.001, 0.012_92),
            (0.003_130_8, 0.040_449_936),
            (0.18, 0.461_356_129_500_442),
            (0.214_041_140_482_232_6, 0.5),
            (0.5, 0.735_356_983_052_449),
            (1.0, 1.0),
        ] {
            let found = encode(linear);
            assert!((found - encoded).abs() < 1e-9, "encode({linear}): found {found}, expected {encoded}");
            let found = decode(encoded);
            assert!((found - linear).abs() < 1e-7, "decode({encoded}): found {found}, expected {linear}");
        }
    }

    #[test]
    fn single_precision_follows_double_precision() {
        for step in 0..=10_000_u16 {
            let x = f64::from(step) / 10_000.0;
            let off = (f64::from(encode_f32(x as f32)) - encode(x)).abs();
            assert!(off < 3e-7, "encode({x}) is off by {off:e}");
            let off = (f64::from(decode_f32(x as f32)) - decode(x)).abs();
            assert!(off < 3e-7, "decode({x}) is off by {off:e}");
        }
    }

    #[test]
    fn pixels_survive_the_round_trip_at_every_level() {
        for alpha in [1, 2, 127, 254, 255] {
            for level in 0..=255 {
                let pixel = [level, 255 - level, 128, alpha];
                assert_eq!(encode8(decode8(pixel)), pixel);
            }
        }
        for level in (0..=65_535).step_by(17) {
            let pixel = [level, 65_535 - level, 1, 65_535];
            assert_eq!(encode16(decode16(pixel)), pixel);
        }
    }

    #[test]
    fn associated_and_straight_pixels_of_one_color_are_one() {
        for (straight, alpha) in [([0.5, 1.0, 0.0], 0.25), ([0.2, 0.04, 0.9], 1.0), ([1.0, 1.0, 1.0], 1.0 / 255.0)] {
            let [r, g, b] = straight.map(|c: f32| c * alpha);
            let found = decode_associated([r, g, b, alpha]).expect("a product");
            let expected = premultiplied([straight[0], straight[1], straight[2], alpha]);
            let off = found.iter().zip(expected).map(|(x, y)| (x - y).abs()).fold(0.0, f32::max);
            assert!(off < 1e-6, "found {found:?}, expected {expected:?}");
        }
        assert_eq!(decode_associated([0.0; 4]), Some([0.0; 4]), "nothing");
        assert_eq!(decode_associated([0.5, 0.0, 0.0, 0.25]), None, "brighter than its alpha allows");
    }

    #[test]
    fn what_straight_alpha_cannot_hold_is_clipped() {
        assert_eq!(encode8([0.5, 0.5, 0.5, 0.0]), [0; 4], "light without opacity");
        assert_eq!(encode8([2.0, -1.0, 0.25, 0.5]), [255, 0, 188, 128], "light brighter than its opacity");
        assert_eq!(encode8([1.0, 1.0, 1.0, 1.5]), [213, 213, 213, 255], "more than opaque");
    }
}
