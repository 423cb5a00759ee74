//! The picture of a histogram: counts by colour, marginals, a colour bar, and the widgets that classify them.

mod legend;
mod marginal;

use super::contour::{self, Lattice};
use super::drawing::{Anchor, Drawing, INK, Outline, hex};
use super::ink;
use super::scale::{Linear, Logarithmic, grouped, label};
use crate::histogram::{Axis, Counts};
use crate::plan::LayerWidgets;

/// What is written around a histogram.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Caption {
    /// Above it.
    pub title: String,
    /// Below the title.
    pub subtitle: String,
    /// Along the horizontal axis, with its unit.
    pub x: String,
    /// Along the vertical axis, with its unit.
    pub y: String,
}

/// Upper left corner and size of the counts, pixels.
const CORNER: [f64; 2] = [110.0, 200.0];
const SIZE: [f64; 2] = [768.0, 512.0];
const PICTURE_WIDTH: f64 = 1160.0;
/// Sizes of letters, pixels.
const TITLE: f64 = 24.0;
const LABEL: f64 = 18.0;
const TICK: f64 = 15.0;
/// Colours that counts are told apart by.
const LEVELS: usize = 96;
const GRID: &str = "#e4e7eb";
/// Lines of widgets: a dark one below the coloured one, since they lie on white paper and on dark bins.
const CASING: [f64; 2] = [5.0, 2.6];

/// A histogram as SVG, with the contours along which each widget has half of its weight, in its colour. Widgets are over
/// value and gradient magnitude; over other axes there must be none.
pub fn histogram(counts: &Counts, caption: &Caption, layers: &[LayerWidgets]) -> String {
    let frame = Frame::new(counts);
    let legend = legend::rows(layers);
    let mut drawing = Drawing::new(PICTURE_WIDTH, CORNER[1] + SIZE[1] + 92.0 + legend.height());
    drawing.text([CORNER[0], 38.0], TITLE, Anchor::Start, &caption.title);
    drawing.text([CORNER[0], 64.0], TICK, Anchor::Start, &caption.subtitle);
    frame.grid(&mut drawing);
    frame.counts(&mut drawing, counts);
    if counts.x() == counts.y() {
        let mut diagonal = Outline::default();
        diagonal.line(&[[CORNER[0], CORNER[1] + SIZE[1]], [CORNER[0] + SIZE[0], CORNER[1]]], false);
        drawing.stroke(&diagonal, "#9aa1ab", 1.0);
    }
    for widget in layers.iter().flat_map(|layer| &layer.widgets) {
        let mut outline = Outline::default();
        for line in contour::half(&frame.lattice(), |value, gradient| widget.at(value, gradient)) {
            let points: Vec<[f64; 2]> = line.iter().map(|[x, y]| [frame.x.pixel(*x), frame.y.pixel(*y)]).collect();
            outline.line(&points, true);
        }
        drawing.stroke(&outline, INK, CASING[0]);
        drawing.stroke(&outline, &hex(widget.color_srgb), CASING[1]);
    }
    frame.axes(&mut drawing, caption);
    marginal::above(&mut drawing, &frame.x, counts);
    marginal::beside(&mut drawing, &frame.y, counts);
    color_bar(&mut drawing, counts.highest());
    legend.draw(&mut drawing, [CORNER[0], CORNER[1] + SIZE[1] + 92.0]);
    drawing.finish()
}

/// The axes in pixels.
struct Frame {
    x: Linear,
    y: Linear,
}

impl Frame {
    fn new(counts: &Counts) -> Self {
        let linear = |axis: Axis, at, end| Linear { from: axis.low(), to: axis.high(), at, end };
        Frame {
            x: linear(counts.x(), CORNER[0], CORNER[0] + SIZE[0]),
            y: linear(counts.y(), CORNER[1] + SIZE[1], CORNER[1]),
        }
    }

    /// A node for every other pixel.
    fn lattice(&self) -> Lattice {
        let nodes = SIZE.map(|pixels| pixels as usize / 2 + 1);
        Lattice { x: [self.x.from, self.x.to], y: [self.y.from, self.y.to], nodes }
    }

    fn ticks(&self) -> [Vec<f64>; 2] {
        [self.x.ticks(9), self.y.ticks(7)]
    }

    fn grid(&self, drawing: &mut Drawing) {
        let [along_x, along_y] = self.ticks();
        let mut lines = Outline::default();
        for x in along_x.into_iter().map(|x| self.x.pixel(x)) {
            lines.line(&[[x, CORNER[1]], [x, CORNER[1] + SIZE[1]]], false);
        }
        for y in along_y.into_iter().map(|y| self.y.pixel(y)) {
            lines.line(&[[CORNER[0], y], [CORNER[0] + SIZE[0], y]], false);
        }
        drawing.stroke(&lines, GRID, 1.0);
    }

    /// Bins in which there is a voxel, level by level, neighbours of one level in one piece.
    fn counts(&self, drawing: &mut Drawing, counts: &Counts) {
        let scale = Logarithmic { highest: counts.highest() };
        let level = |i: usize, j: usize| match counts.at(i, j) {
            0 => None,
            count => Some((scale.share(count) * (LEVELS - 1) as f64).round() as usize),
        };
        // On whole pixels, so that nothing white shows between neighbours.
        let column = |i: usize| self.x.pixel(counts.x().edge(i)).round();
        let row = |j: usize| self.y.pixel(counts.y().edge(j)).round();
        let mut levels: Vec<Outline> = (0..LEVELS).map(|_| Outline::default()).collect();
        for j in 0..counts.y().bins() {
            let (top, foot) = (row(j + 1), row(j));
            let mut begun = 0;
            for i in 1..=counts.x().bins() {
                let here = level(begun, j);
                if i < counts.x().bins() && level(i, j) == here {
                    continue;
                }
                if let Some(here) = here {
                    let (left, right) = (column(begun), column(i));
                    levels[here].rect([left, top], [right - left, foot - top]);
                }
                begun = i;
            }
        }
        for (n, outline) in levels.iter().enumerate() {
            drawing.crisp(outline, &hex(ink::color(n as f64 / (LEVELS - 1) as f64)));
        }
    }

    fn axes(&self, drawing: &mut Drawing, caption: &Caption) {
        let ([left, top], [width, height]) = (CORNER, SIZE);
        let [along_x, along_y] = self.ticks();
        let mut lines = Outline::default();
        lines.rect(CORNER, SIZE);
        let step = |ticks: &[f64]| ticks.windows(2).map(|pair| pair[1] - pair[0]).next().unwrap_or(1.0);
        for x in &along_x {
            let at = self.x.pixel(*x);
            lines.line(&[[at, top + height], [at, top + height + 6.0]], false);
            drawing.text([at, top + height + 24.0], TICK, Anchor::Middle, &label(*x, step(&along_x)));
        }
        for y in &along_y {
            let at = self.y.pixel(*y);
            lines.line(&[[left, at], [left - 6.0, at]], false);
            drawing.text([left - 11.0, at + 5.0], TICK, Anchor::End, &label(*y, step(&along_y)));
        }
        drawing.stroke(&lines, INK, 1.2);
        drawing.text([left + width / 2.0, top + height + 54.0], LABEL, Anchor::Middle, &caption.x);
        drawing.text_upward([36.0, top + height / 2.0], LABEL, Anchor::Middle, &caption.y);
    }
}

/// Which colour is how many voxels.
fn color_bar(drawing: &mut Drawing, highest: u64) {
    let ([_, top], [_, height]) = (CORNER, SIZE);
    let (left, width) = (CORNER[0] + SIZE[0] + 136.0, 20.0);
    let scale = Logarithmic { highest };
    let band = height / LEVELS as f64;
    for n in 0..LEVELS {
        let mut piece = Outline::default();
        piece.rect([left, top + height - (n + 1) as f64 * band], [width, band]);
        drawing.crisp(&piece, &hex(ink::color(n as f64 / (LEVELS - 1) as f64)));
    }
    let mut lines = Outline::default();
    lines.rect([left, top], [width, height]);
    for count in scale.ticks() {
        let at = top + height * (1.0 - scale.share(count));
        lines.line(&[[left + width, at], [left + width + 6.0, at]], false);
        drawing.text([left + width + 10.0, at + 5.0], TICK, Anchor::Start, &grouped(count));
    }
    drawing.stroke(&lines, INK, 1.2);
    drawing.text([left, top - 12.0], TICK, Anchor::Start, "voxels per bin");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::histogram::joint;
    use crate::plan::{VolumeInfo, widgets};
    use crate::spec::Spec;
    use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};
    use glam::DVec3;

    #[test]
    fn it_says_what_it_shows() {
        let grid = Grid::axis_aligned([40, 4, 4], DVec3::ONE).unwrap();
        let samples = (0..grid.voxel_count()).map(|n| (n % 40 * 20) as i16).collect();
        let volume = Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap();
        let axes = [Axis::new([0.0, 800.0], 40).unwrap(), Axis::new([0.0, 400.0], 20).unwrap()];
        let counts = joint(&volume, axes[0], axes[1]).unwrap();
        let spec = Spec::of_presets(std::path::Path::new("scan.nrrd"), &["bone".to_owned()], &[]).unwrap();
        let layers = widgets(&spec, &VolumeInfo::from(&volume)).unwrap();
        let text = |text: &str| text.to_owned();
        let caption = Caption { title: text("T"), subtitle: text("S"), x: text("value, HU"), y: text("|∇|, HU/mm") };
        let svg = histogram(&counts, &caption, &layers);
        for part in
            [">T<", ">S<", ">value, HU<", ">|∇|, HU/mm<", ">800<", ">400<", ">voxels per bin<", ">bone<", "#f3e6cc"]
        {
            assert!(svg.contains(part), "{part} should be in\n{svg}");
        }
        // All 640 voxels lie in one row of bins, each of 16 voxels: one run of one colour.
        let darkest = hex(ink::color(1.0));
        let runs = svg.lines().filter(|l| l.contains("crispEdges") && l.contains(&darkest)).count();
        assert_eq!(runs, 2, "the row and the end of the colour bar");
        assert_eq!(svg, histogram(&counts, &caption, &layers), "the same again");
        assert!(!histogram(&counts, &caption, &[]).contains(">bone<"));
    }
}
