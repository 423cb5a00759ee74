//! Points over two logarithmic axes, with a front through some of them and a level across.

mod label;
mod marker;

use super::drawing::{Anchor, Drawing, INK, Outline};
use super::scale::Decades;
use label::Labels;

/// Points of one name, joined in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What the legend calls it.
    pub name: String,
    /// `[x, y]`, each above 0.
    pub points: Vec<[f64; 2]>,
}

/// A chart over two logarithmic axes. Points that are not finite or not above 0 have no place on them and are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct LogLog {
    /// Above the chart.
    pub title: String,
    /// Below the title.
    pub subtitle: String,
    /// Under the x axis, with the unit.
    pub x_label: String,
    /// Beside the y axis, with the unit.
    pub y_label: String,
    /// What is drawn, at most as many as are told apart by colour and shape: 8.
    pub series: Vec<Series>,
    /// A thick line through these points, with its name.
    pub front: Option<Series>,
    /// A dashed line across the chart at this `y`, with its name.
    pub level: Option<(String, f64)>,
    /// Texts beside points; those that would lie over others are left out, the last first.
    pub notes: Vec<([f64; 2], String)>,
}

/// Upper left corner and size of the plane, and size of the picture, pixels.
const CORNER: [f64; 2] = [96.0, 92.0];
const SIZE: [f64; 2] = [760.0, 520.0];
const PICTURE: [f64; 2] = [1120.0, 690.0];
/// Sizes of letters, pixels.
const TITLE: f64 = 24.0;
const LABEL: f64 = 18.0;
const TICK: f64 = 15.0;
const NOTE: f64 = 12.5;
/// Half the size of a marker, pixels.
const MARKER: f64 = 5.0;

const GRID: [&str; 2] = ["#f0f2f4", "#d9dde2"];
const FRONT: &str = "#c9ced6";
const LEVEL: &str = "#b3261e";

/// Distinguishable with every kind of colour vision (Okabe and Ito 2008), dark enough for white paper.
const COLORS: [&str; 8] = ["#e69f00", "#0072b2", "#009e73", "#cc79a7", "#d55e00", "#4a4f57", "#786e14", "#56b4e9"];

impl LogLog {
    /// The chart as SVG.
    pub fn svg(&self) -> String {
        let plane = Plane::around(self);
        let mut drawing = Drawing::new(PICTURE[0], PICTURE[1]);
        drawing.text([CORNER[0], 38.0], TITLE, Anchor::Start, &self.title);
        drawing.text([CORNER[0], 66.0], TICK, Anchor::Start, &self.subtitle);
        plane.axes(&mut drawing, [&self.x_label, &self.y_label]);
        let mut labels = Labels::within(CORNER, SIZE);
        if let Some(front) = &self.front {
            drawing.stroke(&plane.line(&front.points), FRONT, 8.0);
        }
        if let Some((name, level)) = self.level.as_ref().filter(|(_, level)| is_placed(*level)) {
            let y = plane.y.pixel(*level);
            drawing.dashes([CORNER[0], y], [CORNER[0] + SIZE[0], y], LEVEL, 2.0);
            labels.avoid([CORNER[0] + 0.5 * SIZE[0], y], [0.5 * SIZE[0], 1.0]);
            // Beside the chart, where nothing else is.
            drawing.text([CORNER[0] + SIZE[0] + 8.0, y + 5.0], TICK, Anchor::Start, name);
        }
        for (place, (series, color)) in self.series.iter().zip(COLORS).enumerate() {
            drawing.stroke(&plane.line(&series.points), color, 1.4);
            for point in drawn(&series.points).map(|point| plane.place(point)) {
                drawing.fill(&marker::outline(place, point, MARKER), color, "point");
                labels.avoid(point, [MARKER, MARKER]);
            }
        }
        for (point, text) in self.notes.iter().filter(|(point, _)| is_drawn(point)) {
            if let Some(place) = labels.room_for(plane.place(*point), text, NOTE) {
                drawing.text(place, NOTE, Anchor::Start, text);
            }
        }
        self.legend(&mut drawing, &plane);
        drawing.finish()
    }

    /// To the right of the plane, below or above the name of the level.
    fn legend(&self, drawing: &mut Drawing, plane: &Plane) {
        const ROW: f64 = 26.0;
        let rows = self.series.len() + usize::from(self.front.is_some());
        let x = CORNER[0] + SIZE[0] + 20.0;
        let level = self.level.as_ref().map_or(f64::INFINITY, |(_, level)| plane.y.pixel(*level));
        let over = CORNER[1] + 10.0..CORNER[1] + 20.0 + ROW * rows as f64;
        let top = if over.contains(&level) { level + 30.0 } else { over.start };
        let mut y = top.min(CORNER[1] + SIZE[1] - ROW * rows as f64);
        for (place, (series, color)) in self.series.iter().zip(COLORS).enumerate() {
            let mut line = Outline::default();
            line.line(&[[x - 10.0, y], [x + 10.0, y]], false);
            drawing.stroke(&line, color, 1.4);
            drawing.fill(&marker::outline(place, [x, y], MARKER), color, "key");
            drawing.text([x + 20.0, y + 5.0], TICK, Anchor::Start, &series.name);
            y += ROW;
        }
        if let Some(front) = &self.front {
            let mut line = Outline::default();
            line.line(&[[x - 10.0, y], [x + 10.0, y]], false);
            drawing.stroke(&line, FRONT, 8.0);
            drawing.text([x + 20.0, y + 5.0], TICK, Anchor::Start, &front.name);
        }
    }
}

/// Both axes.
struct Plane {
    x: Decades,
    y: Decades,
}

impl Plane {
    /// What is drawn, and a little room around it; one decade where there is nothing, so that the axes are there.
    fn around(chart: &LogLog) -> Self {
        let points = || chart.series.iter().chain(&chart.front).flat_map(|series| drawn(&series.points));
        let level = chart.level.iter().map(|(_, level)| *level).filter(|level| is_placed(*level));
        Plane {
            x: Decades::around(points().map(|[x, _]| x), [CORNER[0], CORNER[0] + SIZE[0]]),
            y: Decades::around(points().map(|[_, y]| y).chain(level), [CORNER[1] + SIZE[1], CORNER[1]]),
        }
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.x.pixel(x), self.y.pixel(y)]
    }

    fn line(&self, points: &[[f64; 2]]) -> Outline {
        let places: Vec<[f64; 2]> = drawn(points).map(|point| self.place(point)).collect();
        let mut line = Outline::default();
        line.line(&places, false);
        line
    }

    fn axes(&self, drawing: &mut Drawing, [x_label, y_label]: [&str; 2]) {
        let [left, top] = CORNER;
        let [right, bottom] = [left + SIZE[0], top + SIZE[1]];
        let vertical = |x: f64| [[x, top], [x, bottom]];
        let horizontal = |y: f64| [[left, y], [right, y]];
        for (ticks, color) in [(Decades::between as fn(&Decades) -> Vec<f64>, GRID[0]), (Decades::powers, GRID[1])] {
            let mut lines = Outline::default();
            ticks(&self.x).into_iter().for_each(|x| lines.line(&vertical(self.x.pixel(x)), false));
            ticks(&self.y).into_iter().for_each(|y| lines.line(&horizontal(self.y.pixel(y)), false));
            drawing.stroke(&lines, color, 1.0);
        }
        for (x, text) in self.x.labels() {
            drawing.text([self.x.pixel(x), bottom + 24.0], TICK, Anchor::Middle, &text);
        }
        for (y, text) in self.y.labels() {
            drawing.text([left - 10.0, self.y.pixel(y) + 5.0], TICK, Anchor::End, &text);
        }
        let mut frame = Outline::default();
        frame.line(&[[left, top], [right, top], [right, bottom], [left, bottom]], true);
        drawing.stroke(&frame, INK, 1.0);
        drawing.text([left + 0.5 * SIZE[0], bottom + 58.0], LABEL, Anchor::Middle, x_label);
        drawing.text_upward([30.0, top + 0.5 * SIZE[1]], LABEL, Anchor::Middle, y_label);
    }
}

fn is_placed(v: f64) -> bool {
    v.is_finite() && v > 0.0
}

fn is_drawn(point: &[f64; 2]) -> bool {
    point.iter().all(|&v| is_placed(v))
}

fn drawn(points: &[[f64; 2]]) -> impl Iterator<Item = [f64; 2]> + '_ {
    points.iter().filter(|point| is_drawn(point)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<[f64; 2]>) -> LogLog {
        LogLog {
            title: "Accuracy against time".to_owned(),
            subtitle: "a head".to_owned(),
            x_label: "seconds".to_owned(),
            y_label: "error".to_owned(),
            notes: points.iter().map(|&point| (point, "1/2".to_owned())).collect(),
            series: vec![Series { name: "march".to_owned(), points: points.clone() }],
            front: Some(Series { name: "front".to_owned(), points }),
            level: Some(("tolerance".to_owned(), 1e-3)),
        }
    }

    fn points_in(svg: &str) -> usize {
        svg.matches("class=\"point\"").count()
    }

    #[test]
    fn every_point_and_name_is_in_the_svg() {
        let svg = chart(vec![[0.1, 1e-1], [1.0, 1e-2], [10.0, 1e-4]]).svg();
        assert_eq!(points_in(&svg), 3, "points of the series");
        for name in ["Accuracy against time", "a head", "march", "front", "tolerance", "seconds", "10⁻⁴", "1/2"] {
            assert!(svg.contains(name), "{name:?} is not in the chart");
        }
    }

    #[test]
    fn what_has_no_place_on_logarithmic_axes_is_left_out() {
        let wrong = chart(vec![[0.1, 0.0], [f64::NAN, 1.0], [1.0, f64::INFINITY], [-1.0, 1.0]]);
        let svg = wrong.svg();
        assert_eq!(points_in(&svg), 0, "no point has a place");
        assert!(!svg.contains("NaN") && !svg.contains("inf") && !svg.contains("1/2"), "found {svg}");
    }

    #[test]
    fn a_text_that_would_lie_over_another_is_left_out() {
        let found = chart(vec![[1.0, 1e-2]; 20]).svg().matches(">1/2<").count();
        assert_eq!(found, 4, "there is room above and below, right and left of the place of 20 points");
    }
}
