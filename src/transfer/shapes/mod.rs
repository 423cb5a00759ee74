//! Shapes over value and gradient magnitude, and the terms that are rendered for them.
//!
//! A [`Shape`] is a factor between 0 and 1 that multiplies the optics of a widget. Rectangles and trapezoids are products
//! of piecewise linear functions and become one [`Term`] exactly. The others get knots until the terms are nowhere further
//! from the shape than a stated share of its height; what is rendered is then *defined* to be the terms, so that the
//! deviation is one of the look and never one of the integration.
//!
//! | shape | terms | bound |
//! |---|---|---|
//! | rectangle, trapezoid | 1 | exact |
//! | triangle, contour | one per row of gradient magnitudes in a geometric series of ratio ρ | (ρ − 1) / 4 edge |
//! | ellipse | one per row, rows `h` of a radius apart | 2 h² |
//! | Gaussian | 1 | h²/8 + the tail that is cut off, per axis |

mod ellipse;
mod gaussian;
mod triangle;

pub use ellipse::Ellipse;
pub use gaussian::Gaussian;
pub use triangle::Triangle;

use super::{Curve, Knot, Optics, Term, Weight};
use crate::error::{Error, Fault, Result};
pub use crate::math::extinction_per_mm;

/// A factor between 0 and 1 over value (HU) and gradient magnitude (HU/mm).
///
/// At a jump it is continuous from the right, as transfer functions are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// 1 inside, 0 outside.
    Rectangle {
        /// Lowest and highest value.
        value: [f64; 2],
        /// Lowest and highest gradient magnitude; `None` for all.
        gradient_per_mm: Option<[f64; 2]>,
    },
    /// Linear rise, plateau, linear fall along each axis.
    Trapezoid {
        /// Where it leaves 0, reaches 1, leaves 1 and reaches 0, ascending.
        value: [f64; 4],
        /// The same along the gradient magnitude; `None` for 1 everywhere.
        gradient_per_mm: Option<[f64; 4]>,
    },
    /// A wedge that opens with the gradient magnitude: Kniss's triangle and Levoy's isovalue contour.
    Triangle(Triangle),
    /// A smooth hill over an ellipse.
    Ellipse(Ellipse),
    /// A Gaussian along each axis.
    Gaussian(Gaussian),
}

/// The terms rendered for a shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// The terms.
    pub terms: Vec<Term>,
    /// How far they are from the shape at most, as a share of its height; 0 where they are exact.
    pub max_deviation: f64,
}

/// Most rows of gradient magnitudes that one shape may take.
const MOST_ROWS: usize = 256;

impl Shape {
    /// The shape itself at a value and gradient magnitude, in [0, 1].
    pub fn ideal(&self, value: f64, gradient_per_mm: f64) -> f64 {
        match self {
            Shape::Rectangle { value: v, gradient_per_mm: g } => {
                let within = |x: f64, [low, high]: [f64; 2]| if low <= x && x < high { 1.0 } else { 0.0 };
                within(value, *v) * g.map_or(1.0, |g| within(gradient_per_mm, g))
            }
            Shape::Trapezoid { value: v, gradient_per_mm: g } => {
                trapezoid_at(value, *v) * g.map_or(1.0, |g| trapezoid_at(gradient_per_mm, g))
            }
            Shape::Triangle(triangle) => triangle.ideal(value, gradient_per_mm),
            Shape::Ellipse(ellipse) => ellipse.ideal(value, gradient_per_mm),
            Shape::Gaussian(gaussian) => gaussian.ideal(value, gradient_per_mm),
        }
    }

    /// The terms for this shape with `optics` where it is 1, no further from it than `max_deviation` of its height.
    ///
    /// # Errors
    /// `Fault::Spec` for a degenerate shape, or one that would take more than 256 rows.
    pub fn expand(&self, optics: Optics, max_deviation: f64) -> Result<Expansion> {
        match self {
            Shape::Rectangle { value: [a, b], gradient_per_mm } => {
                let gradient = gradient_per_mm.map(|[a, b]| [a, a, b, b]);
                trapezoid([*a, *a, *b, *b], gradient, optics)
            }
            Shape::Trapezoid { value, gradient_per_mm } => trapezoid(*value, *gradient_per_mm, optics),
            Shape::Triangle(triangle) => triangle.expand(optics, max_deviation),
            Shape::Ellipse(ellipse) => ellipse.expand(optics, max_deviation),
            Shape::Gaussian(gaussian) => gaussian.expand(optics, max_deviation),
        }
    }
}

fn trapezoid_at(x: f64, [a, b, c, d]: [f64; 4]) -> f64 {
    if x < a || x >= d {
        0.0
    } else if x < b {
        (x - a) / (b - a)
    } else if x < c {
        1.0
    } else {
        (d - x) / (d - c)
    }
}

fn trapezoid(value: [f64; 4], gradient_per_mm: Option<[f64; 4]>, optics: Optics) -> Result<Expansion> {
    let weight = gradient_per_mm.map(|g| Weight::new(std::iter::zip(g, PLATEAU).map(|(x, w)| [x, w]).collect()));
    let curve = curve_of(std::iter::zip(value, PLATEAU), optics)?;
    Ok(Expansion { terms: vec![Term { curve, weight: weight.transpose()? }], max_deviation: 0.0 })
}

const PLATEAU: [f64; 4] = [0.0, 1.0, 1.0, 0.0];

/// `optics` times a factor that is linear between `(value, factor)` knots.
fn curve_of(knots: impl IntoIterator<Item = (f64, f64)>, optics: Optics) -> Result<Curve> {
    let knot = |(value, factor)| Knot { value, optics: Optics::NOTHING.plus(factor, optics) };
    Curve::new(knots.into_iter().map(knot).collect())
}

/// Refuses a shape that takes more rows than anyone could want.
fn limit_rows(rows: f64) -> Result<usize> {
    if rows <= MOST_ROWS as f64 {
        return Ok(rows as usize);
    }
    Err(Error::new(Fault::Spec, "a widget's shape takes too many rows of gradient magnitudes")
        .found(format!("{rows:.0} rows"))
        .expected(format!("at most {MOST_ROWS}"))
        .remedy("raise max_deviation or edge, or narrow gradient_hu_per_mm"))
}
