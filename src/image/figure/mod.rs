//! Pictures of how two pictures differ, for people to look at.

mod colors;
mod digits;

use super::Image;
use super::metrics::largest_per_pixel;
use colors::color_of;

/// Pixels between the parts of a figure.
const GAP: usize = 8;
/// Width of the colour bar.
const BAR: usize = 16;
/// Straight linear grey of what belongs to no part.
const PAPER: [f32; 4] = [0.02, 0.02, 0.02, 1.0];

/// The largest difference of the channels of each pixel in colour, with a bar that says which colour is how much: from 0 at
/// its foot to `full_scale` at its top. What is above is shown as `full_scale`. The pictures must have one size.
pub fn difference_map(a: &Image, b: &Image, full_scale: f64) -> Image {
    let map = Image::from_pixels(
        a.width(),
        a.height(),
        largest_per_pixel(a, b).map(|difference| color_of(difference / full_scale)).collect(),
    );
    beside(&[&map, &color_bar(a.height(), full_scale)])
}

/// Both pictures in front of black, and their [`difference_map`], next to one another.
pub fn side_by_side(a: &Image, b: &Image, full_scale: f64) -> Image {
    beside(&[&on_black(a), &on_black(b), &difference_map(a, b, full_scale)])
}

fn on_black(image: &Image) -> Image {
    let shown = |v: f32| if v > 0.0 { v.min(1.0) } else { 0.0 };
    let pixels = image.pixels().iter().map(|&[r, g, b, _]| [shown(r), shown(g), shown(b), 1.0]).collect();
    Image::from_pixels(image.width(), image.height(), pixels)
}

/// A bar as high as the pictures, with numbers at its ends and in its middle.
fn color_bar(height: usize, full_scale: f64) -> Image {
    let labels = [full_scale, 0.5 * full_scale, 0.0].map(|value| format!("{value:.1e}"));
    let width = BAR + 2 + labels.iter().map(|text| digits::width(text)).max().unwrap_or(0);
    let mut bar = paper(width, height);
    for y in 0..height {
        let share = 1.0 - (y as f64 + 0.5) / height as f64;
        for x in 0..BAR {
            bar.pixels_mut()[y * width + x] = color_of(share);
        }
    }
    for (label, share) in labels.iter().zip([0.0, 0.5, 1.0]) {
        let top = (share * height.saturating_sub(digits::HEIGHT) as f64) as usize;
        digits::write(&mut bar, BAR + 2, top, label);
    }
    bar
}

fn paper(width: usize, height: usize) -> Image {
    Image::from_pixels(width, height, vec![PAPER; width * height])
}

/// Parts of one height from left to right, with gaps between them.
fn beside(parts: &[&Image]) -> Image {
    let height = parts.iter().map(|part| part.height()).max().unwrap_or(0);
    let width = parts.iter().map(|part| part.width()).sum::<usize>() + GAP * parts.len().saturating_sub(1);
    let mut figure = paper(width, height);
    let mut left = 0;
    for part in parts {
        for (y, row) in part.pixels().chunks(part.width()).enumerate() {
            figure.pixels_mut()[y * width + left..][..row.len()].copy_from_slice(row);
        }
        left += part.width() + GAP;
    }
    figure
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_stand_next_to_one_another_and_the_map_shows_where() {
        let a = Image::from_pixels(20, 32, vec![[0.5, 0.25, 0.0, 0.5]; 640]);
        let mut b = a.clone();
        b.pixels_mut()[7 * 20 + 3][3] += 0.125;
        let figure = side_by_side(&a, &b, 0.125);
        assert_eq!(figure.height(), 32);
        assert_eq!(figure.pixel(3, 7), [0.5, 0.25, 0.0, 1.0], "the first picture, in front of black");
        assert_eq!(figure.pixel(20, 0), PAPER, "a gap");
        let map = 2 * (20 + GAP);
        assert_eq!(figure.pixel(map + 3, 7), color_of(1.0), "a difference of alpha alone is seen");
        assert_eq!(figure.pixel(map + 4, 7), color_of(0.0), "and nothing beside it");
        let bar = map + 20 + GAP;
        assert_eq!(figure.pixel(bar, 0), color_of(1.0 - 0.5 / 32.0), "the bar's top is full scale");
        assert_eq!(figure.pixel(bar, 31), color_of(0.5 / 32.0), "and its foot 0");
    }

    #[test]
    fn what_is_no_number_has_the_colour_of_full_scale() {
        let a = Image::from_pixels(1, 1, vec![[f32::NAN; 4]]);
        assert_eq!(difference_map(&a, &a, 1.0).pixel(0, 0), color_of(1.0));
    }
}
