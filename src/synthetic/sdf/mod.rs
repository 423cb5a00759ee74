//! Solids as signed distances: negative inside, positive outside, in mm.
//!
//! Near its surface every distance has slope 1, which is what turns it into partial volume. Far from the surface it may
//! be shorter than the true distance, never longer outside. Smooth unions use the cubic polynomial of Quilez ("Smooth
//! minimum", 2013): twice differentiable, so that shaded surfaces show no seams, and exact beyond its reach, so that
//! parts out of reach can be left out without a trace ([`Solid::near`]).
//!
//! Only `+ - * /` and square roots are used: results are the same on every machine.

mod near;
mod shapes;

use glam::{Mat3, Vec3};

use super::noise::value_noise;

pub(super) use near::{Ball, Range};
pub(super) use shapes::{Node, blend, block, common, ellipsoid, half_space, rod, sphere, tube};

/// A solid.
#[derive(Debug, Clone)]
pub(super) enum Solid {
    /// All of space.
    Everywhere,
    /// An ellipsoid along the patient's axes.
    Ellipsoid { center: Vec3, radii: Vec3 },
    /// A box along the patient's axes with rounded edges.
    Block { center: Vec3, half: Vec3, rounding_mm: f32 },
    /// The inner side of a plane.
    HalfSpace { point: Vec3, outward: Vec3 },
    /// Cones with round ends, one after the other.
    Tube(Vec<Segment>),
    /// A solid in a frame of its own; the columns of `axes` are the frame's unit vectors.
    Placed { origin: Vec3, axes: Mat3, solid: Box<Solid> },
    /// A solid on the patient's left and its mirror image.
    Mirrored(Box<Solid>),
    /// A solid with its surface shifted to and fro.
    Rippled { solid: Box<Solid>, height_mm: f32, length_mm: f32 },
    /// A solid with its surface moved outwards.
    Grown { solid: Box<Solid>, mm: f32 },
    /// A union with fillets.
    Blend { parts: Vec<Solid>, reach_mm: f32 },
    /// An intersection with rounded edges.
    Common { parts: Vec<Solid>, reach_mm: f32 },
    /// A solid without another, the edge rounded.
    Cut { solid: Box<Solid>, tool: Box<Solid>, reach_mm: f32 },
}

/// One piece of a tube: the hull of two balls.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    start: Vec3,
    along: Vec3,
    /// 1 / length², 1/mm².
    inverse_length_squared: f32,
    radius_mm: f32,
    radius_step_mm: f32,
    /// How much farther along the axis the nearest point of the surface belongs, per mm of distance from the axis.
    lean_per_mm: f32,
}

impl Solid {
    /// Signed distance, mm.
    pub(super) fn distance(&self, p: Vec3) -> f32 {
        match self {
            Solid::Everywhere => f32::NEG_INFINITY,
            Solid::Ellipsoid { center, radii } => ellipsoid_distance(p - *center, *radii),
            Solid::Block { center, half, rounding_mm } => {
                let q = (p - *center).abs() - (*half - *rounding_mm);
                q.max(Vec3::ZERO).length() + q.max_element().min(0.0) - rounding_mm
            }
            Solid::HalfSpace { point, outward } => (p - *point).dot(*outward),
            Solid::Tube(segments) => segments.iter().fold(f32::INFINITY, |d, s| d.min(s.distance(p))),
            Solid::Placed { origin, axes, solid } => solid.distance(into_frame(p, *origin, axes)),
            Solid::Mirrored(solid) => solid.distance(Vec3::new(p.x.abs(), p.y, p.z)),
            Solid::Rippled { solid, height_mm, length_mm } => {
                solid.distance(p) - height_mm * value_noise(7, p / *length_mm)
            }
            Solid::Grown { solid, mm } => solid.distance(p) - mm,
            Solid::Blend { parts, reach_mm } => {
                parts.iter().fold(f32::INFINITY, |d, part| smooth_min(d, part.distance(p), *reach_mm))
            }
            Solid::Common { parts, reach_mm } => {
                parts.iter().fold(f32::NEG_INFINITY, |d, part| smooth_max(d, part.distance(p), *reach_mm))
            }
            Solid::Cut { solid, tool, reach_mm } => smooth_max(solid.distance(p), -tool.distance(p), *reach_mm),
        }
    }
}

impl Segment {
    fn distance(&self, p: Vec3) -> f32 {
        let from_start = p - self.start;
        let projected = from_start.dot(self.along) * self.inverse_length_squared;
        let from_axis = (from_start - projected * self.along).length();
        let t = (projected + self.lean_per_mm * from_axis).clamp(0.0, 1.0);
        (from_start - t * self.along).length() - (self.radius_mm + t * self.radius_step_mm)
    }
}

/// First-order distance to an ellipsoid around the origin, value over slope, kept finite at the centre.
fn ellipsoid_distance(p: Vec3, radii: Vec3) -> f32 {
    let unit = p / radii;
    let scaled = unit / radii;
    let (k0, k1) = (unit.length(), scaled.length());
    if k0 >= 1.0 {
        // A Newton step on the convex k0 - 1: it falls short of the surface, never beyond it.
        return k0 * (k0 - 1.0) / k1;
    }
    let f = k0 * k0 - 1.0;
    let shortest = radii.min_element();
    f / (4.0 * k1 * k1 - f / (shortest * shortest)).sqrt()
}

fn into_frame(p: Vec3, origin: Vec3, axes: &Mat3) -> Vec3 {
    let q = p - origin;
    Vec3::new(q.dot(axes.x_axis), q.dot(axes.y_axis), q.dot(axes.z_axis))
}

/// Minimum with a cubic fillet of width `reach`; exact where the arguments differ by more. Monotone in both.
fn smooth_min(a: f32, b: f32, reach: f32) -> f32 {
    let overlap = reach - (a - b).abs();
    // An infinite argument, of an empty union, has no overlap.
    if overlap > 0.0 {
        let h = overlap / reach;
        a.min(b) - h * h * h * reach / 6.0
    } else {
        a.min(b)
    }
}

fn smooth_max(a: f32, b: f32, reach: f32) -> f32 {
    -smooth_min(-a, -b, reach)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_have_distance_0_and_slope_1() {
        let solids = [
            (ellipsoid((1.0, 2.0, 3.0), (4.0, 30.0, 10.0)), Vec3::new(5.0, 2.0, 3.0), Vec3::X),
            (ellipsoid((1.0, 2.0, 3.0), (4.0, 30.0, 10.0)), Vec3::new(1.0, 32.0, 3.0), Vec3::Y),
            (rod(&[(0.0, 0.0, 0.0, 2.0), (0.0, 0.0, 9.0, 2.0)]), Vec3::new(0.0, 2.0, 4.0), Vec3::Y),
            (block((0.0, 0.0, 0.0), (1.0, 2.0, 3.0), 0.5), Vec3::new(0.2, 0.0, 3.0), Vec3::Z),
            (sphere((5.0, 0.0, 0.0), 2.0).mirrored(), Vec3::new(-7.0, 0.0, 0.0), Vec3::NEG_X),
            (half_space((0.0, 1.0, 0.0), (0.0, 2.0, 0.0)), Vec3::new(9.0, 1.0, 9.0), Vec3::Y),
        ];
        for (solid, surface, outward) in solids {
            let at = |mm: f32| solid.distance(surface + mm * outward);
            assert!(at(0.0).abs() < 1e-5, "{solid:?}: found {} on the surface", at(0.0));
            let slope = (at(0.01) - at(-0.01)) / 0.02;
            assert!((slope - 1.0).abs() < 1e-2, "{solid:?}: found slope {slope}, expected 1");
        }
    }

    #[test]
    fn blends_equal_the_union_out_of_reach() {
        let (a, b) = (sphere((0.0, 0.0, 0.0), 3.0), sphere((20.0, 0.0, 0.0), 3.0));
        let both = blend(4.0, [a.clone(), b]);
        let far = Vec3::new(-5.0, 1.0, 0.0);
        assert_eq!(both.distance(far), a.distance(far), "one part alone is in reach");
        let middle = Vec3::new(10.0, 0.0, 0.0);
        assert!(both.distance(middle) < a.distance(middle), "equal distances are filleted");
    }

    #[test]
    fn ellipsoid_distance_is_finite_at_the_centre() {
        let d = ellipsoid((0.0, 0.0, 0.0), (4.0, 30.0, 10.0)).distance(Vec3::ZERO);
        assert!((d + 4.0).abs() < 1e-5, "found {d}, expected the shortest radius");
    }
}
