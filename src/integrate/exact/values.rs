//! What the values along a ray say without a transfer function: extremes, integral, and where they cross a level. All from the
//! exact cubics, in f64, so there is nothing to bound but rounding.

use super::cells::Segment;
use super::lattice::{Lattice, along};
use super::shown::Passed;
use crate::field::Voxel;
use crate::math::bernstein::{Cubic, critical_points, crossing, range, sum, value};

/// Which extreme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Extreme {
    Largest,
    Smallest,
}

/// The extreme stored value along the segments of a ray, or `None` if there are none. A cubic takes its extremes at its ends and
/// critical points, and lies between its Bernstein coefficients and between its cell's corners, so most cells cost one
/// comparison of their corners.
pub(super) fn extreme<V: Voxel>(
    lattice: &Lattice<'_, V>,
    segments: impl Iterator<Item = Segment>,
    which: Extreme,
) -> Option<f64> {
    // The smallest value is minus the largest of the negated field.
    let sign = match which {
        Extreme::Largest => 1.0,
        Extreme::Smallest => -1.0,
    };
    let mut best = f64::NEG_INFINITY;
    for segment in segments {
        let corners = lattice.corners::<f64>(segment.cell).map(|v| sign * v);
        if range(&corners)[1] <= best {
            continue;
        }
        let cubic = along(&corners, &segment);
        if range(&cubic)[1] <= best {
            continue;
        }
        let (critical, count) = critical_points(&cubic);
        let inner = critical.into_iter().take(count).map(|u| value(&cubic, u));
        best = inner.chain([cubic[0], cubic[3]]).fold(best, f64::max);
    }
    best.is_finite().then_some(sign * best)
}

/// The integral of the stored value over the segments of a ray, stored units times mm. The mean of a polynomial is the mean
/// of its Bernstein coefficients.
pub(super) fn integral<V: Voxel>(lattice: &Lattice<'_, V>, segments: impl Iterator<Item = Segment>) -> f64 {
    let mut total = 0.0;
    for segment in segments {
        total += 0.25 * sum(&along(&lattice.corners::<f64>(segment.cell), &segment)) * segment.length_mm;
    }
    total
}

/// A place where the value along a ray crosses a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crossing {
    /// Which level.
    pub(super) level: usize,
    /// Distance from the ray's origin, mm.
    pub(super) at_mm: f64,
    /// Gradient there, HU/mm.
    pub(super) gradient_per_mm: [f64; 3],
}

/// Calls `visit` for every crossing of one of the stored `levels` along what a ray passes, front to back, until it returns
/// false.
///
/// A point is inside a level where the value is at least the level; a crossing is a change from outside to inside or back.
/// The state is carried along the ray, so that a crossing on the face between two cells counts once. A ray that begins or
/// ends inside a level, at the border of the volume or where it is clipped, has no crossing there, nor has one that enters
/// or leaves what is hidden. `sign` is -1 where values fall as stored numbers rise.
pub(super) fn crossings<V: Voxel, P: Into<Passed>>(
    lattice: &Lattice<'_, V>,
    passed: impl Iterator<Item = P>,
    sign: f64,
    levels: &[f64],
    mut visit: impl FnMut(Crossing) -> bool,
) {
    let levels: Vec<f64> = levels.iter().map(|level| sign * level).collect();
    let mut inside: Vec<Option<bool>> = vec![None; levels.len()];
    let mut found: Vec<(f64, usize)> = Vec::new();
    // From the highest level that a ray is inside to below the lowest that it is outside, nothing changes.
    const UNKNOWN: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];
    let mut quiet = UNKNOWN;
    for passed in passed {
        let Passed::Shown(segment) = passed.into() else {
            inside.fill(None);
            quiet = UNKNOWN;
            continue;
        };
        let corners = lattice.corners::<f64>(segment.cell).map(|v| sign * v);
        let [low, high] = range(&corners);
        if low >= quiet[0] && high < quiet[1] {
            continue;
        }
        let cubic = along(&corners, &segment);
        found.clear();
        quiet = [f64::NEG_INFINITY, f64::INFINITY];
        for (n, &level) in levels.iter().enumerate() {
            flips(&cubic, level, &mut inside[n], |u| found.push((u, n)));
            if inside[n] == Some(true) {
                quiet[0] = quiet[0].max(level);
            } else {
                quiet[1] = quiet[1].min(level);
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        if found.is_empty() {
            continue;
        }
        let gradient: [Cubic<f64>; 3] = lattice.gradients(segment.cell).map(|c| along(&c, &segment));
        for &(u, level) in &found {
            let gradient_per_mm = std::array::from_fn(|a| value(&gradient[a], u));
            let Segment { exit_mm, length_mm, .. } = segment;
            if !visit(Crossing { level, at_mm: exit_mm - (1.0 - u) * length_mm, gradient_per_mm }) {
                return;
            }
        }
    }
}

/// Calls `at` for every place where a cubic changes between outside and inside a level, given the state before it.
fn flips(cubic: &Cubic<f64>, level: f64, inside: &mut Option<bool>, mut at: impl FnMut(f64)) {
    let mut state = inside.unwrap_or(cubic[0] >= level);
    let (critical, count) = critical_points(cubic);
    let mut from = 0.0;
    for to in critical.into_iter().take(count).chain([1.0]) {
        let (a, b) = (value(cubic, from), value(cubic, to));
        if (b >= level) != state {
            state = !state;
            // The change lies at the piece's start if rounding put it there.
            at(if (a - level) * (b - level) < 0.0 {
                crossing(cubic, level, from, to)
            } else if a == level {
                from
            } else {
                to
            });
        }
        from = to;
    }
    *inside = Some(state);
}

#[cfg(test)]
mod tests {
    use super::super::cells::Domain;
    use super::*;
    use crate::scene::{Clip, Ray};
    use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};
    use glam::DVec3;

    fn volume() -> Volume {
        let samples: Vec<i16> = (0..6 * 5 * 4).map(|i| ((i * 7919) % 211) as i16 - 100).collect();
        let grid = Grid::axis_aligned([6, 5, 4], DVec3::new(1.0, 1.3, 2.0)).unwrap();
        Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap()
    }

    fn lattice(volume: &Volume) -> Lattice<'_, i16> {
        let Samples::I16(samples) = volume.samples() else { unreachable!("made of 16-bit samples") };
        Lattice::new(volume, samples)
    }

    fn rays() -> impl Iterator<Item = Ray> {
        (0..60).map(|i| {
            let t = f64::from(i);
            let origin_mm = DVec3::new(-9.0, (0.7 * t).sin() * 4.0, (0.3 * t).cos() * 4.0);
            let aim = DVec3::new(3.0, 2.5 + (1.1 * t).sin(), 3.0 + 2.0 * (0.9 * t).cos());
            Ray { origin_mm, direction: (aim - origin_mm).normalize() }
        })
    }

    static ALL: Clip = Clip { half_spaces: Vec::new() };

    fn segments<'a>(volume: &'a Volume, ray: &Ray) -> impl Iterator<Item = Segment> + 'a {
        let domain = Domain::of(volume, &ALL);
        domain.inside(ray).into_iter().flat_map(move |inside| domain.segments(inside))
    }

    /// Values at many points of a ray.
    fn sampled(volume: &Volume, ray: &Ray) -> Vec<f64> {
        let lattice = lattice(volume);
        let mut all = Vec::new();
        for segment in segments(volume, ray) {
            let cubic = along(&lattice.corners::<f64>(segment.cell), &segment);
            all.extend((0..=400).map(|i| value(&cubic, f64::from(i) / 400.0)));
        }
        all
    }

    #[test]
    fn extremes_are_those_of_fine_sampling() {
        let volume = volume();
        for ray in rays() {
            let samples = sampled(&volume, &ray);
            let (low, high) = samples.iter().fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(v), h.max(v)));
            let largest = extreme(&lattice(&volume), segments(&volume, &ray), Extreme::Largest).unwrap();
            let smallest = extreme(&lattice(&volume), segments(&volume, &ray), Extreme::Smallest).unwrap();
            assert!((0.0..1e-2).contains(&(largest - high)), "largest {largest}, sampled {high}");
            assert!((0.0..1e-2).contains(&(low - smallest)), "smallest {smallest}, sampled {low}");
        }
    }

    #[test]
    fn the_mean_of_a_linear_field_is_its_value_in_the_middle() {
        let samples: Vec<i16> =
            (0..6 * 5 * 4).map(|i| (10 * (i % 6) + 7 * (i / 6 % 5) - 30 * (i / 30)) as i16).collect();
        let grid = Grid::axis_aligned([6, 5, 4], DVec3::ONE).unwrap();
        let volume = Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap();
        for ray in rays() {
            let Some(inside) = Domain::of(&volume, &ALL).inside(&ray) else { continue };
            let middle = ray.origin_mm + 0.5 * (inside.enter_mm() + inside.exit_mm()) * ray.direction;
            let found = integral(&lattice(&volume), segments(&volume, &ray)) / inside.length_mm();
            let expected = 10.0 * middle.x + 7.0 * middle.y - 30.0 * middle.z;
            assert!((found - expected).abs() < 1e-10, "found {found}, expected {expected}");
        }
    }

    #[test]
    fn crossings_alternate_and_agree_with_sampling() {
        let volume = volume();
        let levels = [0.0, 50.0];
        for ray in rays() {
            let mut found = [0_usize; 2];
            let mut last = f64::MIN;
            crossings(&lattice(&volume), segments(&volume, &ray).map(Passed::Shown), 1.0, &levels, |c| {
                assert!(c.at_mm >= last, "front to back");
                last = c.at_mm;
                found[c.level] += 1;
                true
            });
            let samples = sampled(&volume, &ray);
            for (n, level) in levels.into_iter().enumerate() {
                let expected = samples.windows(2).filter(|p| (p[0] >= level) != (p[1] >= level)).count();
                // Sampling misses pairs that are closer than it is fine, never the parity.
                assert!(
                    found[n] >= expected && (found[n] - expected).is_multiple_of(2),
                    "found {}, sampled {expected}",
                    found[n]
                );
            }
        }
    }

    #[test]
    fn a_crossing_on_a_face_counts_once() {
        // Lattice values are exactly the level along a plane of voxels, and the ray passes lattice points.
        let samples: Vec<i16> = (0..5 * 3 * 3).map(|i| (i % 5) as i16 - 2).collect();
        let grid = Grid::axis_aligned([5, 3, 3], DVec3::ONE).unwrap();
        let volume = Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap();
        for direction in [DVec3::X, DVec3::new(1.0, 1e-9, 0.0)] {
            for sign in [1.0, -1.0] {
                let ray = Ray {
                    origin_mm: DVec3::new(2.0 - 9.0 * sign, 1.0, 1.0),
                    direction: (sign * direction).normalize(),
                };
                let mut places = Vec::new();
                crossings(&lattice(&volume), segments(&volume, &ray).map(Passed::Shown), 1.0, &[0.0], |c| {
                    places.push(c.at_mm);
                    true
                });
                assert!(
                    places.len() == 1 && (places[0] - 9.0).abs() < 1e-6,
                    "{direction} {sign}: crossings at {places:?}"
                );
            }
        }
    }
}
