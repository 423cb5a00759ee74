//! VTK's functions of one variable: points with a midpoint and a sharpness.

use crate::error::{Error, Fault, Result};
use crate::transfer::Side;

/// A point of a [`Function`], and how it goes on from there to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node<const N: usize> {
    /// Position.
    pub x: f64,
    /// The function there, each component from 0 to 1.
    pub y: [f64; N],
    /// Where on the way to the next point half of it is done, from 0 to 1; 0.5 is even.
    pub midpoint: f64,
    /// How sharply: 0 is a line, 1 a step at the midpoint.
    pub sharpness: f64,
}

impl<const N: usize> Node<N> {
    /// A point from which a line leads to the next.
    pub fn linear(x: f64, y: [f64; N]) -> Self {
        Node { x, y, midpoint: 0.5, sharpness: 0.0 }
    }
}

/// A function through points, constant before the first and after the last: `vtkPiecewiseFunction` for one component,
/// `vtkColorTransferFunction` in RGB for three. Two points at one position are a jump, as Slicer reads them.
#[derive(Debug, Clone, PartialEq)]
pub struct Function<const N: usize> {
    nodes: Vec<Node<N>>,
}

/// Sharpness from which VTK takes a step, and below which it takes a line.
const STEP: f64 = 0.99;
const LINE: f64 = 0.01;

/// More points than any author sets, and than any program writes.
const MOST_NODES: usize = 65_536;

impl<const N: usize> Function<N> {
    /// The function through these points, ascending.
    ///
    /// # Errors
    /// `Fault::Input`, naming the point, for none, for one out of order, or for a number out of range.
    pub fn new(nodes: Vec<Node<N>>) -> Result<Self> {
        if nodes.is_empty() || nodes.len() > MOST_NODES {
            return Err(Error::new(Fault::Input, "the number of points is not usable")
                .found(nodes.len().to_string())
                .expected(format!("1 to {MOST_NODES}")));
        }
        for (i, node) in nodes.iter().enumerate() {
            let refused = |found: f64, expected: &str| {
                let error = Error::new(Fault::Input, format!("point {} is not usable", i + 1));
                Err(error.found(found.to_string()).expected(expected))
            };
            let unit = |x: &f64| (0.0..=1.0).contains(x);
            if !node.x.is_finite() {
                return refused(node.x, "a finite position");
            }
            if i > 0 && node.x < nodes[i - 1].x {
                return refused(
                    node.x,
                    &format!("a position of at least {}, that of the point before", nodes[i - 1].x),
                );
            }
            if let Some(&y) = node.y.iter().find(|y| !unit(y)) {
                return refused(y, "opacity or colour from 0 to 1");
            }
            if let Some(&shape) = [node.midpoint, node.sharpness].iter().find(|x| !unit(x)) {
                return refused(shape, "midpoint and sharpness from 0 to 1");
            }
        }
        Ok(Function { nodes })
    }

    /// The points, ascending.
    pub fn nodes(&self) -> &[Node<N>] {
        &self.nodes
    }

    /// The level of a function that is the same everywhere.
    pub fn constant(&self) -> Option<[f64; N]> {
        let first = self.nodes[0].y;
        self.nodes.iter().all(|node| node.y == first).then_some(first)
    }

    /// The function at `x`; `side` matters at a jump only.
    pub fn at(&self, x: f64, side: Side) -> [f64; N] {
        let after = match side {
            Side::Left => self.nodes.partition_point(|node| node.x < x),
            Side::Right => self.nodes.partition_point(|node| node.x <= x),
        };
        match after {
            0 => self.nodes[0].y,
            n if n == self.nodes.len() => self.nodes[n - 1].y,
            n => between(&self.nodes[n - 1], &self.nodes[n], x, side),
        }
    }

    /// Positions between which the function is smooth, ascending, without duplicates.
    pub fn breaks(&self) -> Vec<f64> {
        let inner = self.nodes.windows(2).filter(|pair| pair[0].sharpness >= LINE || pair[0].midpoint != 0.5);
        let inner = inner.map(|pair| middle(&pair[0], &pair[1]));
        let mut breaks: Vec<f64> = self.nodes.iter().map(|node| node.x).chain(inner).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}

/// VTK keeps the midpoint away from the ends by this much.
fn share<const N: usize>(node: &Node<N>) -> f64 {
    node.midpoint.clamp(1e-5, 1.0 - 1e-5)
}

fn middle<const N: usize>(a: &Node<N>, b: &Node<N>) -> f64 {
    a.x + share(a) * (b.x - a.x)
}

/// Between two points: the midpoint bends the way, then the sharpness chooses line, step, or a Hermite curve between
/// the two, steeper in its middle and flatter at its ends as it grows.
fn between<const N: usize>(a: &Node<N>, b: &Node<N>, x: f64, side: Side) -> [f64; N] {
    let middle = middle(a, b);
    if a.sharpness > STEP {
        let before = x < middle || (x == middle && side == Side::Left);
        return if before { a.y } else { b.y };
    }
    let way = if x < middle { 0.5 * (x - a.x) / (middle - a.x) } else { 0.5 + 0.5 * (x - middle) / (b.x - middle) };
    if a.sharpness < LINE {
        return std::array::from_fn(|i| (1.0 - way) * a.y[i] + way * b.y[i]);
    }
    let power = 1.0 + 10.0 * a.sharpness;
    let s = if way < 0.5 { 0.5 * (2.0 * way).powf(power) } else { 1.0 - 0.5 * (2.0 * (1.0 - way)).powf(power) };
    let (s2, s3) = (s * s, s * s * s);
    std::array::from_fn(|i| {
        let (from, to) = (a.y[i], b.y[i]);
        let tangent = (1.0 - a.sharpness) * (to - from);
        let ends = (2.0 * s3 - 3.0 * s2 + 1.0) * from + (3.0 * s2 - 2.0 * s3) * to;
        let curve = ends + (s3 - 2.0 * s2 + s) * tangent + (s3 - s2) * tangent;
        curve.clamp(from.min(to), from.max(to))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from(midpoint: f64, sharpness: f64) -> Function<1> {
        Function::new(vec![Node { x: 10.0, y: [0.2], midpoint, sharpness }, Node::linear(20.0, [0.6])]).unwrap()
    }

    #[test]
    fn lines_steps_and_midpoints_are_as_vtk_defines_them() {
        for (midpoint, sharpness, x, expected) in [
            (0.5, 0.0, 5.0, 0.2),
            (0.5, 0.0, 25.0, 0.6),
            (0.5, 0.0, 12.5, 0.3),
            (0.25, 0.0, 12.5, 0.4),
            (0.25, 0.0, 11.25, 0.3),
            (0.25, 1.0, 12.4, 0.2),
            (0.25, 1.0, 12.6, 0.6),
            // Every curve between passes through half of the way at the midpoint.
            (0.25, 0.5, 12.5, 0.4),
        ] {
            let [found] = from(midpoint, sharpness).at(x, Side::Right);
            assert!((found - expected).abs() < 1e-12, "{midpoint}, {sharpness} at {x}: {found}, expected {expected}");
        }
    }

    #[test]
    fn a_jump_has_two_sides() {
        let nodes = [(0.0, 0.0), (1.0, 0.25), (1.0, 0.75), (2.0, 1.0)].map(|(x, y)| Node::linear(x, [y]));
        let jump = Function::new(nodes.to_vec()).unwrap();
        assert_eq!((jump.at(1.0, Side::Left), jump.at(1.0, Side::Right)), ([0.25], [0.75]));
        let step = from(0.5, 1.0);
        assert_eq!((step.at(15.0, Side::Left), step.at(15.0, Side::Right)), ([0.2], [0.6]));
        assert_eq!(step.breaks(), [10.0, 15.0, 20.0]);
    }

    #[test]
    fn points_that_make_no_function_are_refused() {
        let at = |x, y| Node::linear(x, [y]);
        for wrong in [
            vec![],
            vec![at(1.0, 0.0), at(0.0, 0.0)],
            vec![at(f64::NAN, 0.0)],
            vec![at(0.0, 1.5)],
            vec![at(0.0, f64::NAN)],
            vec![Node { x: 0.0, y: [0.0], midpoint: -1.0, sharpness: 0.0 }],
        ] {
            assert!(Function::new(wrong.clone()).is_err(), "{wrong:?}");
        }
    }
}
