//! Numbers written into pictures, in a font of 3 x 5 pixels, magnified twice.

use crate::image::Image;

/// Height of a line of text, pixels.
pub(super) const HEIGHT: usize = 5 * MAGNIFIED;
const MAGNIFIED: usize = 2;
/// Columns of a glyph with the gap after it.
const ADVANCE: usize = 4 * MAGNIFIED;
const INK: [f32; 4] = [0.8, 0.8, 0.8, 1.0];

/// The rows of a glyph from the top, three bits each; nothing for what the font lacks.
fn rows(glyph: char) -> [u8; 5] {
    match glyph {
        '0' => [0b111, 0b101, 0b101, 0b101, 0b111],
        '1' => [0b010, 0b110, 0b010, 0b010, 0b111],
        '2' => [0b111, 0b001, 0b111, 0b100, 0b111],
        '3' => [0b111, 0b001, 0b111, 0b001, 0b111],
        '4' => [0b101, 0b101, 0b111, 0b001, 0b001],
        '5' => [0b111, 0b100, 0b111, 0b001, 0b111],
        '6' => [0b111, 0b100, 0b111, 0b101, 0b111],
        '7' => [0b111, 0b001, 0b001, 0b010, 0b010],
        '8' => [0b111, 0b101, 0b111, 0b101, 0b111],
        '9' => [0b111, 0b101, 0b111, 0b001, 0b111],
        'e' => [0b000, 0b111, 0b111, 0b100, 0b111],
        '-' => [0b000, 0b000, 0b111, 0b000, 0b000],
        '.' => [0b000, 0b000, 0b000, 0b000, 0b010],
        _ => [0; 5],
    }
}

/// Width of a text, pixels.
pub(super) fn width(text: &str) -> usize {
    ADVANCE * text.chars().count()
}

/// Writes a text with its top left corner at `(left, top)`; what would lie outside the picture is left out.
pub(super) fn write(image: &mut Image, left: usize, top: usize, text: &str) {
    let (columns, lines) = (image.width(), image.height());
    for (place, glyph) in text.chars().enumerate() {
        let rows = rows(glyph);
        for y in 0..HEIGHT {
            for x in 0..3 * MAGNIFIED {
                let inked = rows[y / MAGNIFIED] >> (2 - x / MAGNIFIED) & 1 == 1;
                let (column, line) = (left + place * ADVANCE + x, top + y);
                if inked && column < columns && line < lines {
                    image.pixels_mut()[line * columns + column] = INK;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_one_is_written_where_it_was_wanted() {
        let mut image = Image::transparent(16, 14);
        write(&mut image, 4, 2, "1");
        let inked = image.pixels().iter().filter(|p| **p == INK).count();
        assert_eq!(inked, 8 * MAGNIFIED * MAGNIFIED, "a one has eight dots");
        assert_eq!(image.pixel(6, 2), INK, "its tip");
        assert_eq!(image.pixel(4, 2), [0.0; 4]);
        write(&mut image, 14, 12, "88");
        assert_eq!(image.pixel(15, 13), INK, "cut off at the border");
    }
}
