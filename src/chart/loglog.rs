//! Points over two logarithmic axes, with a front through some of them and a level across.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::font;
use crate::error::{Error, Fault, Result};
use crate::image::{Image, srgb};

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
    /// Under the x axis, with the unit.
    pub x_label: String,
    /// Beside the y axis, with the unit.
    pub y_label: String,
    /// What is drawn, at most as many as are told apart by colour: 8.
    pub series: Vec<Series>,
    /// A thick line through these points, with its name.
    pub front: Option<Series>,
    /// A dashed line across the chart at this `y`, with its name.
    pub level: Option<(String, f64)>,
}

/// Width and height, pixels.
const SIZE: (u32, u32) = (960, 640);

/// Distinguishable with every kind of colour vision (Okabe and Ito 2008), dark enough for white paper.
const COLORS: [RGBColor; 8] = [
    RGBColor(230, 159, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(213, 94, 0),
    RGBColor(86, 180, 233),
    RGBColor(120, 110, 20),
    RGBColor(40, 40, 40),
];

impl LogLog {
    /// The chart as SVG.
    ///
    /// # Errors
    /// `Fault::Internal` if it cannot be drawn.
    pub fn svg(&self) -> Result<String> {
        font::register()?;
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, SIZE).into_drawing_area()).map_err(failed)?;
        Ok(text)
    }

    /// The chart as a picture.
    ///
    /// # Errors
    /// `Fault::Internal` if it cannot be drawn.
    pub fn image(&self) -> Result<Image> {
        font::register()?;
        let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
        let mut bytes = vec![0; 3 * width * height];
        self.draw(&BitMapBackend::with_buffer(&mut bytes, SIZE).into_drawing_area()).map_err(failed)?;
        let linear = |byte: u8| srgb::decode(f64::from(byte) / 255.0) as f32;
        let pixels = bytes.as_chunks::<3>().0.iter().map(|&[r, g, b]| [linear(r), linear(g), linear(b), 1.0]);
        Ok(Image::from_pixels(width, height, pixels.collect()))
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
    ) -> std::result::Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        area.fill(&WHITE)?;
        let [x, y] = self.ranges();
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, (font::FAMILY, 20))
            .margin(16)
            .x_label_area_size(48)
            .y_label_area_size(72)
            .build_cartesian_2d((x[0]..x[1]).log_scale(), (y[0]..y[1]).log_scale())?;
        chart
            .configure_mesh()
            .label_style((font::FAMILY, 14))
            .axis_desc_style((font::FAMILY, 16))
            .light_line_style(BLACK.mix(0.05))
            .bold_line_style(BLACK.mix(0.15))
            .x_desc(&self.x_label)
            .y_desc(&self.y_label)
            .x_label_formatter(&|v| number(*v))
            .y_label_formatter(&|v| number(*v))
            .draw()?;
        if let Some(front) = &self.front {
            let style = ShapeStyle { color: BLACK.mix(0.25), filled: true, stroke_width: 7 };
            let line = LineSeries::new(drawn(&front.points), style);
            chart
                .draw_series(line)?
                .label(&front.name)
                .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], style));
        }
        if let Some((name, level)) = self.level.as_ref().filter(|(_, level)| is_placed(*level)) {
            let style = ShapeStyle { color: RED.mix(0.8), filled: true, stroke_width: 2 };
            let line = DashedLineSeries::new([(x[0], *level), (x[1], *level)], 8, 6, style);
            chart
                .draw_series(line)?
                .label(name)
                .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], style));
        }
        for (series, color) in self.series.iter().zip(COLORS) {
            chart.draw_series(LineSeries::new(drawn(&series.points), color.stroke_width(1)))?;
            chart
                .draw_series(drawn(&series.points).map(|point| Circle::new(point, 4, color.filled())))?
                .label(&series.name)
                .legend(move |(x, y)| Circle::new((x + 9, y), 4, color.filled()));
        }
        chart
            .configure_series_labels()
            .label_font((font::FAMILY, 14))
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.9))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        area.present()
    }

    /// `[lowest, highest]` of each axis: what is drawn, and a little room around it.
    fn ranges(&self) -> [[f64; 2]; 2] {
        let points = self.series.iter().chain(&self.front).flat_map(|series| drawn(&series.points));
        let mut ranges = [[f64::INFINITY, 0.0_f64]; 2];
        let mut take = |axis: usize, v: f64| ranges[axis] = [ranges[axis][0].min(v), ranges[axis][1].max(v)];
        for (x, y) in points {
            take(0, x);
            take(1, y);
        }
        if let Some((_, level)) = self.level.as_ref().filter(|(_, level)| is_placed(*level)) {
            take(1, *level);
        }
        // Nothing to draw: one decade, so that the axes are there.
        ranges.map(|[low, high]| if low.is_finite() { [low / 1.6, high * 1.6] } else { [1.0, 10.0] })
    }
}

fn is_placed(v: f64) -> bool {
    v.is_finite() && v > 0.0
}

fn drawn(points: &[[f64; 2]]) -> impl Iterator<Item = (f64, f64)> + '_ {
    points.iter().filter(|point| point.iter().all(|&v| is_placed(v))).map(|&[x, y]| (x, y))
}

/// As short as it can be said.
fn number(v: f64) -> String {
    if (1e-2..1e4).contains(&v) { format!("{}", (v * 1e4).round() / 1e4) } else { format!("{v:.0e}") }
}

fn failed<E: std::error::Error + Send + Sync>(cause: DrawingAreaErrorKind<E>) -> Error {
    Error::new(Fault::Internal, "the chart could not be drawn").found(cause.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<[f64; 2]>) -> LogLog {
        LogLog {
            title: "Accuracy against time".to_owned(),
            x_label: "seconds".to_owned(),
            y_label: "error".to_owned(),
            series: vec![Series { name: "march".to_owned(), points: points.clone() }],
            front: Some(Series { name: "front".to_owned(), points }),
            level: Some(("tolerance".to_owned(), 1e-3)),
        }
    }

    #[test]
    fn every_point_and_name_is_in_the_svg() {
        let svg = chart(vec![[0.1, 1e-1], [1.0, 1e-2], [10.0, 1e-4]]).svg().expect("drawn");
        let circles = svg.matches("<circle").count();
        assert_eq!(circles, 4, "three points and one in the legend, found {circles}");
        for name in ["Accuracy against time", "march", "front", "tolerance", "seconds"] {
            assert!(svg.contains(name), "{name:?} is not in the chart");
        }
    }

    #[test]
    fn what_has_no_place_on_logarithmic_axes_is_left_out() {
        let wrong = chart(vec![[0.1, 0.0], [f64::NAN, 1.0], [1.0, f64::INFINITY], [-1.0, 1.0]]);
        let circles = wrong.svg().expect("drawn").matches("<circle").count();
        assert_eq!(circles, 1, "the one of the legend, found {circles}");
        assert_eq!(wrong.ranges()[0], [1.0, 10.0], "there is no time to scale by");
    }

    #[test]
    fn letters_are_drawn_with_the_font_that_comes_along() {
        let dark = |chart: &LogLog| {
            let image = chart.image().expect("drawn");
            image.pixels()[..40 * image.width()].iter().filter(|pixel| pixel[0] < 0.2).count()
        };
        let titled = chart(vec![[1.0, 1.0]]);
        let untitled = LogLog { title: String::new(), ..titled.clone() };
        let (with, without) = (dark(&titled), dark(&untitled));
        assert!(with > without + 200, "{with} dark pixels at the top with a title, {without} without");
    }
}
