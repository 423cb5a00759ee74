//! How solids are made.

use glam::{Mat3, Vec3};

use super::{Segment, Solid};

/// A point of a tube's centre line and the radius there: `(x, y, z, radius)`, mm.
pub(crate) type Node = (f32, f32, f32, f32);

/// An ellipsoid along the patient's axes.
pub(crate) fn ellipsoid(center: impl Into<Vec3>, radii: impl Into<Vec3>) -> Solid {
    Solid::Ellipsoid { center: center.into(), radii: radii.into() }
}

/// A ball.
pub(crate) fn sphere(center: impl Into<Vec3>, radius_mm: f32) -> Solid {
    ellipsoid(center, Vec3::splat(radius_mm))
}

/// A box along the patient's axes, from `center` to either side by `half`, with rounded edges.
pub(crate) fn block(center: impl Into<Vec3>, half: impl Into<Vec3>, rounding_mm: f32) -> Solid {
    Solid::Block { center: center.into(), half: half.into(), rounding_mm }
}

/// Everything on the inner side of a plane through `point`.
pub(crate) fn half_space(point: impl Into<Vec3>, outward: impl Into<Vec3>) -> Solid {
    Solid::HalfSpace { point: point.into(), outward: outward.into().normalize() }
}

/// A tube with straight pieces between at least two `nodes`: a capsule or a round cone for two of them.
pub(crate) fn rod(nodes: &[Node]) -> Solid {
    let segment = |pair: &[Node]| {
        let (a, b) = (pair[0], pair[1]);
        let start = Vec3::new(a.0, a.1, a.2);
        let along = Vec3::new(b.0, b.1, b.2) - start;
        let length_mm = along.length().max(1e-3);
        let radius_step_mm = b.3 - a.3;
        // Sine of the cone's half angle; at 1 one ball swallows the other.
        let sine = (radius_step_mm / length_mm).clamp(-0.95, 0.95);
        Segment {
            start,
            along,
            inverse_length_squared: 1.0 / (length_mm * length_mm),
            radius_mm: a.3,
            radius_step_mm,
            lean_per_mm: sine / (1.0 - sine * sine).sqrt() / length_mm,
        }
    };
    Solid::Tube(nodes.windows(2).map(segment).collect())
}

/// A tube along a smooth (Catmull-Rom) curve through at least two `nodes`.
pub(crate) fn tube(nodes: &[Node]) -> Solid {
    /// Straight pieces per span: corners stay within a tenth of a millimetre of the curve.
    const PIECES: usize = 5;
    let at = |i: usize| nodes[i.min(nodes.len() - 1)];
    let mut fine = vec![nodes[0]];
    for span in 0..nodes.len() - 1 {
        let [a, b, c, d] = [at(span.saturating_sub(1)), at(span), at(span + 1), at(span + 2)];
        for piece in 1..=PIECES {
            let t = piece as f32 / PIECES as f32;
            let spline = |a: f32, b: f32, c: f32, d: f32| {
                let cubic = t * (3.0 * (b - c) + d - a);
                0.5 * (2.0 * b + t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + cubic)))
            };
            let radius_mm = b.3 + t * (c.3 - b.3);
            fine.push((spline(a.0, b.0, c.0, d.0), spline(a.1, b.1, c.1, d.1), spline(a.2, b.2, c.2, d.2), radius_mm));
        }
    }
    rod(&fine)
}

/// The union of `parts`, with fillets that reach `reach_mm` into the hollows between them.
pub(crate) fn blend(reach_mm: f32, parts: impl IntoIterator<Item = Solid>) -> Solid {
    Solid::Blend { parts: parts.into_iter().collect(), reach_mm }
}

/// What all of `parts` have in common, with edges rounded over `reach_mm`.
pub(crate) fn common(reach_mm: f32, parts: impl IntoIterator<Item = Solid>) -> Solid {
    Solid::Common { parts: parts.into_iter().collect(), reach_mm }
}

impl Solid {
    /// The solid without `tool`, the edge rounded over `reach_mm`.
    pub(crate) fn cut(self, reach_mm: f32, tool: Solid) -> Solid {
        Solid::Cut { solid: Box::new(self), tool: Box::new(tool), reach_mm }
    }

    /// The surface moved outwards by `mm`, inwards if negative.
    pub(crate) fn grown(self, mm: f32) -> Solid {
        Solid::Grown { solid: Box::new(self), mm }
    }

    /// The solid, drawn on the patient's left, on both sides.
    pub(crate) fn mirrored(self) -> Solid {
        Solid::Mirrored(Box::new(self))
    }

    /// The surface shifted to and fro by up to `height_mm`, in waves of about `length_mm`.
    pub(crate) fn rippled(self, height_mm: f32, length_mm: f32) -> Solid {
        Solid::Rippled { solid: Box::new(self), height_mm, length_mm }
    }

    /// The solid, drawn around the origin with its own x, y and z, put at `origin` so that its z points along `up` and
    /// its x as nearly as possible along `right`.
    pub(crate) fn placed(self, origin: impl Into<Vec3>, right: impl Into<Vec3>, up: impl Into<Vec3>) -> Solid {
        let z = up.into().normalize();
        let y = z.cross(right.into()).normalize();
        Solid::Placed { origin: origin.into(), axes: Mat3::from_cols(y.cross(z), y, z), solid: Box::new(self) }
    }
}
