//! A drawing in SVG, element by element. Lengths are in pixels from the upper left corner.

use std::fmt::Write as _;

/// What pictures carry along, then what other machines have in its place.
const FONTS: &str = "DejaVu Sans, Verdana, sans-serif";
/// Colour of text and axes.
pub(super) const INK: &str = "#1c1f24";

/// An SVG document that grows.
pub(super) struct Drawing {
    body: String,
    width: f64,
    height: f64,
}

/// Where a text is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Drawing {
    /// White paper.
    pub(super) fn new(width: f64, height: f64) -> Self {
        let mut drawing = Drawing { body: String::new(), width, height };
        drawing.rect([0.0, 0.0], [width, height], "#ffffff");
        drawing
    }

    /// A filled rectangle from its upper left corner.
    pub(super) fn rect(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], fill: &str) {
        self.element(&format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{fill}\"/>",
            short(x),
            short(y),
            short(width),
            short(height)
        ));
    }

    /// A filled outline without soft edges, so that neighbours leave no seam.
    pub(super) fn crisp(&mut self, outline: &Outline, fill: &str) {
        if !outline.0.is_empty() {
            self.element(&format!("<path d=\"{}\" fill=\"{fill}\" shape-rendering=\"crispEdges\"/>", outline.0));
        }
    }

    /// A line along an outline.
    pub(super) fn stroke(&mut self, outline: &Outline, color: &str, width: f64) {
        if !outline.0.is_empty() {
            self.element(&format!(
                "<path d=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{}\" stroke-linejoin=\"round\"/>",
                outline.0,
                short(width)
            ));
        }
    }

    /// A filled outline of a class, by which style sheets and tests find it.
    pub(super) fn fill(&mut self, outline: &Outline, color: &str, class: &str) {
        if !outline.0.is_empty() {
            self.element(&format!("<path class=\"{class}\" d=\"{}\" fill=\"{color}\"/>", outline.0));
        }
    }

    /// A dashed line from point to point.
    pub(super) fn dashes(&mut self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], color: &str, width: f64) {
        self.element(&format!(
            "<path d=\"M{} {}L{} {}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{}\" stroke-dasharray=\"9 6\"/>",
            short(x0),
            short(y0),
            short(x1),
            short(y1),
            short(width)
        ));
    }

    /// A text with its baseline at a point.
    pub(super) fn text(&mut self, [x, y]: [f64; 2], size: f64, anchor: Anchor, text: &str) {
        let place = format!("x=\"{}\" y=\"{}\"", short(x), short(y));
        self.letters(&place, size, anchor, text);
    }

    /// A text that reads from below to above, its baseline to the right of it.
    pub(super) fn text_upward(&mut self, [x, y]: [f64; 2], size: f64, anchor: Anchor, text: &str) {
        self.letters(&format!("transform=\"translate({} {}) rotate(-90)\"", short(x), short(y)), size, anchor, text);
    }

    fn letters(&mut self, place: &str, size: f64, anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escaped(text);
        self.element(&format!(
            "<text {place} font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{INK}\">{text}</text>",
            short(size)
        ));
    }

    fn element(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// The document.
    pub(super) fn finish(self) -> String {
        let (width, height) = (short(self.width), short(self.height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\">\n{}</svg>\n",
            self.body
        )
    }
}

/// The `d` of a path.
#[derive(Debug, Default)]
pub(super) struct Outline(String);

impl Outline {
    /// A line through points, closed if the last leads back to the first.
    pub(super) fn line(&mut self, points: &[[f64; 2]], closed: bool) {
        for (n, [x, y]) in points.iter().enumerate() {
            let to = if n == 0 { 'M' } else { 'L' };
            // Writing to a string cannot fail.
            let _ = write!(self.0, "{to}{} {}", short(*x), short(*y));
        }
        if closed && !points.is_empty() {
            self.0.push('z');
        }
    }

    /// A rectangle.
    pub(super) fn rect(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        let (w, h) = (short(width), short(height));
        let _ = write!(self.0, "M{} {}h{w}v{h}h-{w}z", short(x), short(y));
    }
}

/// A length to a hundredth of a pixel.
fn short(length: f64) -> String {
    let text = format!("{length:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// `#rrggbb` of a colour in sRGB, channels in [0, 1].
pub(super) fn hex(srgb: [f64; 3]) -> String {
    let [r, g, b] = srgb.map(|channel| (255.0 * channel.clamp(0.0, 1.0)).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn escaped(text: &str) -> String {
    // Control characters cannot stand in XML at all.
    let plain: String = text.chars().filter(|c| !c.is_control()).collect();
    plain.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_break_the_document() {
        let mut drawing = Drawing::new(10.0, 10.0);
        drawing.text([1.0, 2.5], 12.0, Anchor::Start, "a<b>&\u{0}\"c\"");
        let svg = drawing.finish();
        assert!(svg.contains("y=\"2.5\"") && svg.contains(">a&lt;b&gt;&amp;\"c\"</text>"), "found {svg}");
    }

    #[test]
    fn lengths_are_short() {
        assert_eq!([3.0, 2.5, 0.126, 100.0, -0.25].map(short), ["3", "2.5", "0.13", "100", "-0.25"]);
        assert_eq!(hex([0.0, 0.5, 1.2]), "#0080ff");
    }
}
