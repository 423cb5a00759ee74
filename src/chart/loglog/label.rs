//! Texts beside points, none over another or over a point.

/// An upright box, `[left, top, right, bottom]`, pixels.
type Box4 = [f64; 4];

/// Where texts may lie, and what is taken.
pub(super) struct Labels {
    within: Box4,
    taken: Vec<Box4>,
}

/// Width of an average letter by its size, in DejaVu Sans.
const LETTER: f64 = 0.6;
/// Between two texts, half of it on either side, pixels.
const APART: f64 = 2.5;
/// Between a point and its text, pixels.
const GAP: f64 = 8.0;

impl Labels {
    /// Room from a corner on.
    pub(super) fn within([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Self {
        Labels { within: [x, y, x + width, y + height], taken: Vec::new() }
    }

    /// Takes the place of something else by its middle and half its size.
    pub(super) fn avoid(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        self.taken.push([x - width, y - height, x + width, y + height]);
    }

    /// The start of the baseline of a text beside a point: to the right, above, below or to the left of it, where there is
    /// room; takes that room.
    pub(super) fn room_for(&mut self, [x, y]: [f64; 2], text: &str, size: f64) -> Option<[f64; 2]> {
        let width = LETTER * size * text.chars().count() as f64;
        let right = x + GAP;
        let left = x - GAP - width;
        let (above, level, below) = (y - GAP, y + 0.35 * size, y + GAP + 0.75 * size);
        let places = [[right, above], [right, level], [right, below], [left, below], [left, level], [left, above]];
        let place = places.into_iter().find(|place| self.is_free(around(*place, width, size)))?;
        self.taken.push(around(place, width, size));
        Some(place)
    }

    fn is_free(&self, [left, top, right, bottom]: Box4) -> bool {
        let [x0, y0, x1, y1] = self.within;
        let apart = |other: &Box4| right <= other[0] || left >= other[2] || bottom <= other[1] || top >= other[3];
        left >= x0 && top >= y0 && right <= x1 && bottom <= y1 && self.taken.iter().all(apart)
    }
}

/// The box of a text by the start of its baseline, with what sets it apart from another on its line.
fn around([x, y]: [f64; 2], width: f64, size: f64) -> Box4 {
    [x - APART, y - 0.8 * size, x + width + APART, y + 0.2 * size]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_go_around_each_other_and_give_up_where_there_is_no_room() {
        let mut labels = Labels::within([0.0, 0.0], [100.0, 100.0]);
        let point = [50.0, 50.0];
        let places: Vec<[f64; 2]> = (0..7).map_while(|_| labels.room_for(point, "1e-3", 12.0)).collect();
        assert_eq!(places.len(), 6, "one at each side, found {places:?}");
        assert!(places[0][0] > 50.0 && places[5][0] < 50.0, "right first, then left: {places:?}");
        assert_eq!(labels.room_for([99.0, 1.0], "wide text", 12.0).map(|[x, _]| x < 50.0), Some(true), "inside");
    }
}
