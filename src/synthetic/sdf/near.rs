//! The part of a solid that matters inside a ball, found by interval arithmetic.
//!
//! A scene of some hundred solids is slow to evaluate at ten million voxels, and nearly all of it is far from any one
//! of them. So a solid is first cut down to what can matter in a block of voxels (as Keeter does for code, "Massively
//! parallel rendering of complex closed-form implicit surfaces", 2020); the distances inside the block stay the same.

use glam::Vec3;

use super::{Segment, Solid, into_frame, smooth_max, smooth_min};

/// Lower and upper bound of a distance, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    pub(crate) low: f32,
    pub(crate) high: f32,
}

/// A ball that encloses a block of voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ball {
    pub(crate) center: Vec3,
    pub(crate) radius_mm: f32,
}

impl Ball {
    fn centered_at(self, center: Vec3) -> Ball {
        Ball { center, ..self }
    }
}

impl Range {
    fn around(value: f32, deviation: f32) -> Range {
        Range { low: value - deviation, high: value + deviation }
    }

    fn shifted(self, mm: f32) -> Range {
        Range { low: self.low + mm, high: self.high + mm }
    }

    /// The range of a function that grows with both arguments.
    fn both(self, other: Range, f: impl Fn(f32, f32) -> f32) -> Range {
        Range { low: f(self.low, other.low), high: f(self.high, other.high) }
    }

    fn negated(self) -> Range {
        Range { low: -self.high, high: -self.low }
    }
}

impl Solid {
    /// Bounds of the distance in `ball`.
    pub(crate) fn range(&self, ball: Ball) -> Range {
        match self {
            Solid::Everywhere => Range::around(f32::NEG_INFINITY, 0.0),
            Solid::Ellipsoid { center, radii } => ellipsoid_range(ball.center - *center, *radii, ball.radius_mm),
            // Distances to these have slope 1 at most.
            Solid::Block { .. } | Solid::HalfSpace { .. } => Range::around(self.distance(ball.center), ball.radius_mm),
            Solid::Tube(segments) => {
                let ranges = segments.iter().map(|s| s.range(ball));
                ranges.fold(Range::around(f32::INFINITY, 0.0), |a, b| a.both(b, f32::min))
            }
            Solid::Placed { origin, axes, solid } => {
                solid.range(ball.centered_at(into_frame(ball.center, *origin, axes)))
            }
            Solid::Mirrored(solid) => solid.range(folded(ball)),
            Solid::Rippled { solid, height_mm, .. } => {
                let range = solid.range(ball);
                Range { low: range.low - height_mm, high: range.high + height_mm }
            }
            Solid::Grown { solid, mm } => solid.range(ball).shifted(-mm),
            Solid::Blend { parts, reach_mm } => {
                let ranges = parts.iter().map(|part| part.range(ball));
                ranges.fold(Range::around(f32::INFINITY, 0.0), |a, b| a.both(b, |a, b| smooth_min(a, b, *reach_mm)))
            }
            Solid::Common { parts, reach_mm } => {
                let ranges = parts.iter().map(|part| part.range(ball));
                ranges.fold(Range::around(f32::NEG_INFINITY, 0.0), |a, b| a.both(b, |a, b| smooth_max(a, b, *reach_mm)))
            }
            Solid::Cut { solid, tool, reach_mm } => {
                solid.range(ball).both(tool.range(ball).negated(), |a, b| smooth_max(a, b, *reach_mm))
            }
        }
    }

    /// A solid with the same distances in `ball`, without what cannot matter there.
    pub(crate) fn near(&self, ball: Ball) -> Solid {
        match self {
            Solid::Everywhere | Solid::Ellipsoid { .. } | Solid::Block { .. } | Solid::HalfSpace { .. } => self.clone(),
            Solid::Tube(segments) => {
                let nearest = segments.iter().map(|s| s.range(ball).high).fold(f32::INFINITY, f32::min);
                Solid::Tube(segments.iter().filter(|s| s.range(ball).low <= nearest).copied().collect())
            }
            Solid::Placed { origin, axes, solid } => {
                let solid = solid.near(ball.centered_at(into_frame(ball.center, *origin, axes)));
                Solid::Placed { origin: *origin, axes: *axes, solid: Box::new(solid) }
            }
            Solid::Mirrored(solid) if ball.center.x > ball.radius_mm => solid.near(ball),
            Solid::Mirrored(solid) => Solid::Mirrored(Box::new(solid.near(folded(ball)))),
            Solid::Rippled { solid, height_mm, length_mm } => {
                Solid::Rippled { solid: Box::new(solid.near(ball)), height_mm: *height_mm, length_mm: *length_mm }
            }
            Solid::Grown { solid, mm } => Solid::Grown { solid: Box::new(solid.near(ball)), mm: *mm },
            Solid::Blend { parts, reach_mm } => {
                let ranges: Vec<Range> = parts.iter().map(|part| part.range(ball)).collect();
                let nearest = ranges.iter().map(|r| r.high).fold(f32::INFINITY, f32::min);
                joined(kept(parts, &ranges, ball, |r| r.low < nearest + SAFE_REACHES * reach_mm), |parts| {
                    Solid::Blend { parts, reach_mm: *reach_mm }
                })
            }
            Solid::Common { parts, reach_mm } => {
                let ranges: Vec<Range> = parts.iter().map(|part| part.range(ball)).collect();
                let farthest = ranges.iter().map(|r| r.low).fold(f32::NEG_INFINITY, f32::max);
                joined(kept(parts, &ranges, ball, |r| r.high > farthest - SAFE_REACHES * reach_mm), |parts| {
                    Solid::Common { parts, reach_mm: *reach_mm }
                })
            }
            Solid::Cut { solid, tool, reach_mm } => {
                let kept = solid.near(ball);
                if tool.range(ball).low >= reach_mm - solid.range(ball).low {
                    return kept;
                }
                Solid::Cut { solid: Box::new(kept), tool: Box::new(tool.near(ball)), reach_mm: *reach_mm }
            }
        }
    }
}

/// A part farther than this many reaches from the nearest can touch neither it nor, by a fillet with a third part, the
/// fillets of the nearest: each fillet takes off a sixth of a reach.
const SAFE_REACHES: f32 = 1.5;

fn kept(parts: &[Solid], ranges: &[Range], ball: Ball, matters: impl Fn(&Range) -> bool) -> Vec<Solid> {
    parts.iter().zip(ranges).filter(|(_, range)| matters(range)).map(|(part, _)| part.near(ball)).collect()
}

/// One part is itself.
fn joined(mut parts: Vec<Solid>, join: impl Fn(Vec<Solid>) -> Solid) -> Solid {
    match parts.pop() {
        Some(only) if parts.is_empty() => only,
        Some(last) => {
            parts.push(last);
            join(parts)
        }
        None => join(parts),
    }
}

/// The ball on the patient's left that holds the mirror images of `ball`'s points on the right.
fn folded(ball: Ball) -> Ball {
    ball.centered_at(Vec3::new(ball.center.x.abs(), ball.center.y, ball.center.z))
}

impl Segment {
    fn range(&self, ball: Ball) -> Range {
        Range::around(self.distance(ball.center), ball.radius_mm)
    }
}

/// Bounds of [`super::ellipsoid_distance`] within `radius_mm` of `p`: its slope may be above 1, but it lies between two
/// functions of `k0 = |p / radii|` alone, whose slope is at most 1 / the shortest radius.
fn ellipsoid_range(p: Vec3, radii: Vec3, radius_mm: f32) -> Range {
    let shortest = radii.min_element();
    let k0 = (p / radii).length();
    let (least, most) = ((k0 - radius_mm / shortest).max(0.0), k0 + radius_mm / shortest);
    let low = if least >= 1.0 { shortest * (least - 1.0) } else { -shortest * (1.0 - least * least).max(0.0).sqrt() };
    let high = if most < 1.0 {
        shortest * (most * most - 1.0) / (1.0 + 3.0 * most * most).sqrt()
    } else {
        // The true distance is at most that along the ray to the centre, and it has slope 1.
        (p.length() * (1.0 - 1.0 / k0.max(1e-6))).max(0.0) + radius_mm
    };
    Range { low, high }
}

#[cfg(test)]
mod tests {
    use super::super::{blend, block, common, ellipsoid, half_space, rod, sphere, tube};
    use super::*;
    use crate::synthetic::noise::bell;

    /// One of each kind, some inside others.
    fn samples() -> Vec<Solid> {
        let flat = ellipsoid((3.0, -2.0, 1.0), (2.0, 18.0, 7.0));
        let bent = tube(&[(0.0, 0.0, 0.0, 2.0), (8.0, 3.0, 5.0, 4.0), (20.0, -4.0, 9.0, 1.0)]);
        let brick =
            block((0.0, 0.0, 0.0), (6.0, 2.0, 4.0), 1.0).placed((-9.0, 4.0, 0.0), (1.0, 1.0, 0.0), (0.2, 0.0, 1.0));
        let plane = half_space((0.0, 0.0, 4.0), (0.1, 0.3, 1.0));
        let joined = blend(6.0, [flat.clone(), bent.clone(), brick.clone(), sphere((25.0, 0.0, 0.0), 3.0).mirrored()]);
        vec![
            common(3.0, [joined.clone(), plane.clone(), sphere((0.0, 0.0, 0.0), 30.0)]),
            joined.clone().cut(2.0, rod(&[(5.0, 0.0, -20.0, 3.0), (5.0, 0.0, 20.0, 5.0)])).grown(1.5),
            plane.rippled(1.0, 4.0),
            flat,
            bent.mirrored(),
            brick,
            joined,
        ]
    }

    /// Point `index` of a cloud of 20 mm around the origin.
    fn point(index: u64) -> Vec3 {
        20.0 * Vec3::new(bell(1, index), bell(2, index), bell(3, index))
    }

    #[test]
    fn distances_stay_within_their_range_and_survive_pruning() {
        let radius_mm = 6.0;
        for solid in samples() {
            for index in 0..400 {
                let ball = Ball { center: point(index), radius_mm };
                let (range, near) = (solid.range(ball), solid.near(ball));
                for step in 0..20 {
                    let p =
                        ball.center + point(index * 20 + step).normalize_or_zero() * (radius_mm * step as f32 / 20.0);
                    let (d, pruned) = (solid.distance(p), near.distance(p));
                    let slack = 1e-3;
                    assert!(
                        range.low - slack <= d && d <= range.high + slack,
                        "{solid:?} at {p}: {d} not in {range:?}"
                    );
                    assert!((d - pruned).abs() < slack, "{solid:?} at {p}: found {pruned} when pruned, expected {d}");
                }
            }
        }
    }

    #[test]
    fn far_parts_are_dropped() {
        let ball = Ball { center: Vec3::new(25.0, 0.0, 0.0), radius_mm: 2.0 };
        let pair = blend(1.0, [sphere((25.0, 0.0, 0.0), 3.0), sphere((-25.0, 0.0, 0.0), 3.0)]);
        assert!(matches!(pair.near(ball), Solid::Ellipsoid { .. }), "found {:?}", pair.near(ball));
    }
}
