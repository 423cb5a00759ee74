//! Which widget is whose.

use super::super::drawing::{Anchor, Drawing, INK, Outline, hex};
use super::{CASING, LABEL, PICTURE_WIDTH, TICK};
use crate::plan::LayerWidgets;

/// Width of a swatch with the room after it, and height of a row, pixels.
const SWATCH: [f64; 2] = [28.0, 28.0];
/// A letter is about so wide, as a share of its size.
const LETTER: f64 = 0.62;

/// Layers in rows that fit the picture.
pub(super) struct Legend<'l> {
    rows: Vec<Vec<&'l LayerWidgets>>,
}

fn width(layer: &LayerWidgets) -> f64 {
    SWATCH[0] * layer.widgets.len() as f64 + LETTER * LABEL * layer.name.chars().count() as f64 + 40.0
}

/// As many layers in a row as there is room for.
pub(super) fn rows(layers: &[LayerWidgets]) -> Legend<'_> {
    let room = PICTURE_WIDTH - super::CORNER[0];
    let mut rows: Vec<Vec<&LayerWidgets>> = Vec::new();
    let mut taken = room;
    for layer in layers {
        if taken + width(layer) > room {
            rows.push(Vec::new());
            taken = 0.0;
        }
        taken += width(layer);
        if let Some(row) = rows.last_mut() {
            row.push(layer);
        }
    }
    Legend { rows }
}

impl Legend<'_> {
    /// Pixels that it takes up.
    pub(super) fn height(&self) -> f64 {
        if self.rows.is_empty() { 0.0 } else { SWATCH[1] * (self.rows.len() + 1) as f64 }
    }

    /// Draws it from its upper left corner.
    pub(super) fn draw(&self, drawing: &mut Drawing, [left, top]: [f64; 2]) {
        if self.rows.is_empty() {
            return;
        }
        drawing.text([left, top], TICK, Anchor::Start, "widgets, where they have half of their weight:");
        for (n, row) in self.rows.iter().enumerate() {
            let y = top + SWATCH[1] * (n + 1) as f64;
            let mut x = left;
            for layer in row {
                let end = x + width(layer);
                for widget in &layer.widgets {
                    let mut line = Outline::default();
                    line.line(&[[x, y - 6.0], [x + SWATCH[0] - 8.0, y - 6.0]], false);
                    drawing.stroke(&line, INK, CASING[0] + 1.0);
                    drawing.stroke(&line, &hex(widget.color_srgb), CASING[1] + 1.0);
                    x += SWATCH[0];
                }
                drawing.text([x, y], LABEL, Anchor::Start, &layer.name);
                x = end;
            }
        }
    }
}
