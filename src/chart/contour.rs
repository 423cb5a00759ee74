//! Where a function over two axes is one half, as closed lines.
//!
//! Marching squares (Lorensen and Cline 1987, in two dimensions) on a lattice with a frame of zeros around it, so that what
//! reaches an end of an axis is closed along it. Saddles are joined by the mean of their corners.

use std::collections::HashMap;

/// A lattice of nodes from the lower ends of two axes to the upper ones, `nodes` along each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
    pub(super) nodes: [usize; 2],
}

/// An edge of a cell by its lower node and its direction: 0 along x, 1 along y.
type Edge = (usize, usize, u8);

/// Closed lines along which the function is one half, by linear interpolation between nodes.
pub(super) fn half(lattice: &Lattice, function: impl Fn(f64, f64) -> f64) -> Vec<Vec<[f64; 2]>> {
    let framed = Framed::new(lattice, function);
    let mut next: HashMap<Edge, Vec<Edge>> = HashMap::new();
    for i in 0..framed.columns - 1 {
        for j in 0..framed.rows - 1 {
            for (a, b) in framed.segments(i, j) {
                next.entry(a).or_default().push(b);
                next.entry(b).or_default().push(a);
            }
        }
    }
    let mut starts: Vec<Edge> = next.keys().copied().collect();
    // The order of a map differs from run to run.
    starts.sort_unstable();
    starts.into_iter().filter_map(|start| framed.line(start, &mut next)).collect()
}

/// The function at the nodes, in a frame of zeros.
struct Framed {
    columns: usize,
    rows: usize,
    values: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Framed {
    fn new(lattice: &Lattice, function: impl Fn(f64, f64) -> f64) -> Self {
        // The frame lies where the outermost nodes lie, so lines along it do not leave the axes.
        let places = |[low, high]: [f64; 2], nodes: usize| -> Vec<f64> {
            let node = |n: usize| low + (high - low) * n as f64 / (nodes - 1) as f64;
            std::iter::once(low).chain((0..nodes).map(node)).chain([high]).collect()
        };
        let (x, y) = (places(lattice.x, lattice.nodes[0]), places(lattice.y, lattice.nodes[1]));
        let (columns, rows) = (x.len(), y.len());
        let mut values = vec![0.0; columns * rows];
        for i in 1..columns - 1 {
            for j in 1..rows - 1 {
                values[i * rows + j] = function(x[i], y[j]);
            }
        }
        Framed { columns, rows, values, x, y }
    }

    fn inside(&self, i: usize, j: usize) -> bool {
        self.values[i * self.rows + j] >= 0.5
    }

    /// The lines through a cell, between its edges.
    fn segments(&self, i: usize, j: usize) -> Vec<(Edge, Edge)> {
        let (below, above, left, right) = ((i, j, 0), (i, j + 1, 0), (i, j, 1), (i + 1, j, 1));
        let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| self.inside(i, j));
        let crossed = [(a != b, below), (b != c, right), (c != d, above), (d != a, left)];
        let edges: Vec<Edge> = crossed.into_iter().filter(|(crossed, _)| *crossed).map(|(_, edge)| edge).collect();
        match edges[..] {
            [from, to] => vec![(from, to)],
            [..] if edges.len() == 4 => {
                let sum: f64 = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    .map(|(i, j)| self.values[i * self.rows + j])
                    .into_iter()
                    .sum();
                // Joined through the middle, lines go around the two corners outside; else around those inside.
                if (sum >= 2.0) == a {
                    vec![(below, right), (above, left)]
                } else {
                    vec![(left, below), (right, above)]
                }
            }
            _ => Vec::new(),
        }
    }

    /// Takes the line through an edge out of the map.
    fn line(&self, start: Edge, next: &mut HashMap<Edge, Vec<Edge>>) -> Option<Vec<[f64; 2]>> {
        let mut points = Vec::new();
        let mut here = start;
        while let Some(to) = next.get_mut(&here).and_then(Vec::pop) {
            let back = next.get_mut(&to)?;
            back.remove(back.iter().position(|edge| *edge == here)?);
            points.push(self.crossing(here));
            here = to;
        }
        (!points.is_empty()).then_some(points)
    }

    fn crossing(&self, (i, j, along): Edge) -> [f64; 2] {
        let (ni, nj) = if along == 0 { (i + 1, j) } else { (i, j + 1) };
        let (a, b) = (self.values[i * self.rows + j], self.values[ni * self.rows + nj]);
        let u = (0.5 - a) / (b - a);
        [self.x[i] + u * (self.x[ni] - self.x[i]), self.y[j] + u * (self.y[nj] - self.y[j])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATTICE: Lattice = Lattice { x: [-2.0, 2.0], y: [0.0, 4.0], nodes: [81, 81] };

    #[test]
    fn a_cone_has_a_circle() {
        let lines = half(&LATTICE, |x, y| 1.0 - 0.5 * (x * x + (y - 2.0) * (y - 2.0)).sqrt());
        let [circle] = &lines[..] else { panic!("one line, found {}", lines.len()) };
        let radii = circle.iter().map(|[x, y]| x.hypot(y - 2.0));
        let worst = radii.map(|r| (r - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < 2e-3 && circle.len() > 100, "{} points, {worst} from the circle", circle.len());
    }

    #[test]
    fn what_reaches_an_end_is_closed_along_it() {
        let lines = half(&LATTICE, |x, _| if x >= 0.0 { 1.0 } else { 0.0 });
        let [line] = &lines[..] else { panic!("one line, found {}", lines.len()) };
        let ends = |a: usize| {
            let along = || line.iter().map(|point| point[a]);
            [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)]
        };
        assert!((ends(0)[0] + 0.025).abs() < 1e-12 && ends(0)[1] == 2.0, "along x: {:?}", ends(0));
        assert_eq!(ends(1), [0.0, 4.0]);
    }

    #[test]
    fn nothing_inside_has_no_line_and_two_hills_have_two() {
        assert_eq!(half(&LATTICE, |_, _| 0.4).len(), 0);
        let hills = |x: f64, y: f64| (-8.0 * ((x.abs() - 1.0).powi(2) + (y - 2.0).powi(2))).exp();
        assert_eq!(half(&LATTICE, hills).len(), 2);
    }

    #[test]
    fn a_saddle_leaves_no_line_open() {
        let lines = half(&LATTICE, |x, y| if (x > 0.0) == (y > 2.0) { 1.0 } else { 0.0 });
        let length: usize = lines.iter().map(Vec::len).sum();
        assert!(length > 300 && lines.iter().all(|line| line.len() > 3), "found {} lines", lines.len());
    }
}
