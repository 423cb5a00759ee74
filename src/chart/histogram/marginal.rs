//! Counts along each axis, logarithmic, above and beside the histogram.

use super::super::drawing::{Anchor, Drawing, INK, Outline};
use super::super::scale::{Linear, Logarithmic, grouped};
use super::{CORNER, SIZE};
use crate::histogram::{Axis, Counts};

/// Height of a marginal, and its distance from the histogram, pixels.
const HEIGHT: f64 = 88.0;
const GAP: f64 = 16.0;
const FILL: &str = "#7f93ab";
const LETTERS: f64 = 12.0;

/// Counts along the horizontal axis.
pub(super) fn above(drawing: &mut Drawing, axis: &Linear, counts: &Counts) {
    let foot = CORNER[1] - GAP;
    let place = |along: f64, up: f64| [along, foot - up];
    let scale = bars(drawing, axis, counts.x(), &counts.along_x(), place);
    for (count, up) in labelled(scale) {
        drawing.text([CORNER[0] - 9.0, foot - up + 4.0], LETTERS, Anchor::End, &grouped(count));
    }
}

/// Counts along the vertical axis.
pub(super) fn beside(drawing: &mut Drawing, axis: &Linear, counts: &Counts) {
    let foot = CORNER[0] + SIZE[0] + GAP;
    let place = |along: f64, up: f64| [foot + up, along];
    let scale = bars(drawing, axis, counts.y(), &counts.along_y(), place);
    for (count, up) in labelled(scale) {
        let at = [foot + up + 4.0, CORNER[1] + SIZE[1] + 9.0];
        drawing.text_upward(at, LETTERS, Anchor::End, &grouped(count));
    }
}

/// Bars that grow away from the histogram, with a line at each power of ten; one voxel is a bar of a pixel.
fn bars(
    drawing: &mut Drawing,
    along: &Linear,
    axis: Axis,
    counts: &[u64],
    place: impl Fn(f64, f64) -> [f64; 2],
) -> Logarithmic {
    let scale = Logarithmic { highest: counts.iter().copied().max().unwrap_or(0) };
    let up = |count: u64| if count == 0 { 0.0 } else { 1.0 + scale.share(count) * (HEIGHT - 1.0) };
    let mut lines = Outline::default();
    for (_, up) in powers(scale) {
        lines.line(&[place(along.at, up), place(along.end, up)], false);
    }
    drawing.stroke(&lines, super::GRID, 1.0);
    let mut points = vec![place(along.at, 0.0)];
    for (n, count) in counts.iter().enumerate() {
        points.extend([axis.edge(n), axis.edge(n + 1)].map(|x| place(along.pixel(x).round(), up(*count))));
    }
    points.push(place(along.end, 0.0));
    let mut outline = Outline::default();
    outline.line(&points, true);
    drawing.crisp(&outline, FILL);
    let mut foot = Outline::default();
    foot.line(&[place(along.at, 0.0), place(along.end, 0.0)], false);
    drawing.stroke(&foot, INK, 1.0);
    scale
}

/// Powers of ten on the scale, and how high they are.
fn powers(scale: Logarithmic) -> impl Iterator<Item = (u64, f64)> {
    scale.ticks().into_iter().map(move |count| (count, 1.0 + scale.share(count) * (HEIGHT - 1.0)))
}

/// Those that are written: few enough to be read.
fn labelled(scale: Logarithmic) -> impl Iterator<Item = (u64, f64)> {
    let every = scale.ticks().len().div_ceil(4).max(1);
    powers(scale).step_by(every)
}
