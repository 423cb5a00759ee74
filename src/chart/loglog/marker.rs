//! Shapes that tell series apart where colours do not: in print, and to some eyes.

use crate::chart::drawing::Outline;

/// The shape of the series of this index around a point, of about this half size, pixels.
pub(super) fn outline(series: usize, [x, y]: [f64; 2], half: f64) -> Outline {
    let corners = |corners: &[[f64; 2]]| {
        let mut outline = Outline::default();
        let placed: Vec<[f64; 2]> = corners.iter().map(|[u, v]| [x + half * u, y + half * v]).collect();
        outline.line(&placed, true);
        outline
    };
    match series % 8 {
        0 => corners(&regular(24, 1.0)),
        1 => corners(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]),
        2 => corners(&[[0.0, -1.25], [1.1, 0.75], [-1.1, 0.75]]),
        3 => corners(&[[0.0, -1.3], [1.3, 0.0], [0.0, 1.3], [-1.3, 0.0]]),
        4 => corners(&star()),
        5 => corners(&[[0.0, 1.25], [1.1, -0.75], [-1.1, -0.75]]),
        6 => corners(&regular(5, 1.2)),
        _ => corners(&regular(6, 1.2)),
    }
}

/// A regular polygon, the first corner at the top.
fn regular(corners: usize, radius: f64) -> Vec<[f64; 2]> {
    let corner = |n: usize| {
        let (sin, cos) = (std::f64::consts::TAU * n as f64 / corners as f64).sin_cos();
        [radius * sin, -radius * cos]
    };
    (0..corners).map(corner).collect()
}

/// A star of five rays.
fn star() -> Vec<[f64; 2]> {
    let outer = regular(10, 1.7);
    outer.into_iter().enumerate().map(|(n, [u, v])| if n % 2 == 0 { [u, v] } else { [0.45 * u, 0.45 * v] }).collect()
}
