//! Solids as signed distances: negative inside, positive outside, in mm.
//!
//! Near its surface every distance has slope 1, which is what turns it into partial volume; far from the surface it
//! may be shorter than the true distance, never longer outside. Smooth unions are the cubic polynomial of Quilez ("Smooth
//! minimum", 2013): twice differentiable, so that shaded surfaces show no seams, and exact beyond its reach, so that
//! parts outside it can be skipped without a trace.
//!
//! Only `+ - * /` and square roots are used: results are the same on every machine.

use glam::{Mat3, Vec3};

use super::bounds::Bounds;
use super::noise::value_noise;

/// A solid with the box around it.
#[derive(Debug, Clone)]
pub(super) struct Solid {
    form: Form,
    bounds: Bounds,
}

#[derive(Debug, Clone)]
enum Form {
    Ellipsoid {
        center: Vec3,
        radii: Vec3,
    },
    Block {
        center: Vec3,
        half: Vec3,
        rounding_mm: f32,
    },
    Tube(Vec<Segment>),
    HalfSpace {
        point: Vec3,
        outward: Vec3,
    },
    /// A solid in a frame of its own; columns of `axes` are the frame's unit vectors.
    Placed {
        origin: Vec3,
        axes: Mat3,
        solid: Box<Solid>,
    },
    Mirrored(Box<Solid>),
    Rippled {
        solid: Box<Solid>,
        height_mm: f32,
        length_mm: f32,
    },
    Grown {
        solid: Box<Solid>,
        mm: f32,
    },
    Blend {
        parts: Vec<Solid>,
        reach_mm: f32,
    },
    Common {
        parts: Vec<Solid>,
        reach_mm: f32,
    },
    Cut {
        solid: Box<Solid>,
        tool: Box<Solid>,
        reach_mm: f32,
    },
}

/// One piece of a tube: a cone with round ends, whose radius is linear along the axis.
#[derive(Debug, Clone)]
struct Segment {
    start: Vec3,
    along: Vec3,
    inverse_length_squared: f32,
    radius_mm: f32,
    radius_step_mm: f32,
}

/// A point of a tube's centre line and the radius there: `(x, y, z, radius)`, mm.
pub(super) type Node = (f32, f32, f32, f32);

/// An ellipsoid along the patient's axes.
pub(super) fn ellipsoid(center: impl Into<Vec3>, radii: impl Into<Vec3>) -> Solid {
    let (center, radii) = (center.into(), radii.into());
    Solid { form: Form::Ellipsoid { center, radii }, bounds: Bounds::around(center, radii) }
}

/// A ball.
pub(super) fn sphere(center: impl Into<Vec3>, radius_mm: f32) -> Solid {
    ellipsoid(center, Vec3::splat(radius_mm))
}

/// A box along the patient's axes with rounded edges.
pub(super) fn block(center: impl Into<Vec3>, half: impl Into<Vec3>, rounding_mm: f32) -> Solid {
    let (center, half) = (center.into(), half.into());
    Solid { form: Form::Block { center, half, rounding_mm }, bounds: Bounds::around(center, half) }
}

/// A tube with straight pieces between `nodes`: a capsule or a round cone for two of them.
pub(super) fn rod(nodes: &[Node]) -> Solid {
    let segments: Vec<Segment> = nodes.windows(2).map(|pair| Segment::new(pair[0], pair[1])).collect();
    let bounds = Bounds::hull(nodes.iter().map(|&(x, y, z, r)| Bounds::around(Vec3::new(x, y, z), Vec3::splat(r))));
    Solid { form: Form::Tube(segments), bounds }
}

/// A tube along a smooth (Catmull-Rom) curve through `nodes`.
pub(super) fn tube(nodes: &[Node]) -> Solid {
    /// Pieces per span: their corners deviate from the curve by less than a tenth of the tubes' radii.
    const PIECES: usize = 5;
    let at = |i: usize| nodes[i.min(nodes.len() - 1)];
    let mut fine = vec![nodes[0]];
    for span in 0..nodes.len() - 1 {
        let [a, b, c, d] = [at(span.saturating_sub(1)), at(span), at(span + 1), at(span + 2)];
        for piece in 1..=PIECES {
            let t = piece as f32 / PIECES as f32;
            let spline = |a: f32, b: f32, c: f32, d: f32| {
                0.5 * (2.0 * b + t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a))))
            };
            let radius = b.3 + t * (c.3 - b.3);
            fine.push((spline(a.0, b.0, c.0, d.0), spline(a.1, b.1, c.1, d.1), spline(a.2, b.2, c.2, d.2), radius));
        }
    }
    rod(&fine)
}

/// Everything on the inner side of a plane through `point`.
pub(super) fn half_space(point: impl Into<Vec3>, outward: impl Into<Vec3>) -> Solid {
    let form = Form::HalfSpace { point: point.into(), outward: outward.into().normalize() };
    Solid { form, bounds: Bounds::EVERYWHERE }
}

/// The union of `parts`, with fillets that reach `reach_mm` into the hollows between them.
pub(super) fn blend(reach_mm: f32, parts: impl IntoIterator<Item = Solid>) -> Solid {
    let parts: Vec<Solid> = parts.into_iter().collect();
    // Two equal distances blend to a sixth of the reach less.
    let bounds = Bounds::hull(parts.iter().map(|p| p.bounds)).grown(reach_mm / 6.0);
    Solid { form: Form::Blend { parts, reach_mm }, bounds }
}

/// What all of `parts` have in common, with edges rounded over `reach_mm`.
pub(super) fn common(reach_mm: f32, parts: impl IntoIterator<Item = Solid>) -> Solid {
    let parts: Vec<Solid> = parts.into_iter().collect();
    let bounds = parts.iter().fold(Bounds::EVERYWHERE, |b, p| b.overlap(p.bounds));
    Solid { form: Form::Common { parts, reach_mm }, bounds }
}

impl Solid {
    /// The solid without `tool`, the edge rounded over `reach_mm`.
    pub(super) fn cut(self, reach_mm: f32, tool: Solid) -> Solid {
        let bounds = self.bounds;
        Solid { form: Form::Cut { solid: Box::new(self), tool: Box::new(tool), reach_mm }, bounds }
    }

    /// The surface moved outwards by `mm`, inwards if negative.
    pub(super) fn grown(self, mm: f32) -> Solid {
        let bounds = self.bounds.grown(mm);
        Solid { form: Form::Grown { solid: Box::new(self), mm }, bounds }
    }

    /// The solid, drawn on the patient's left, on both sides.
    pub(super) fn mirrored(self) -> Solid {
        let bounds = self.bounds.with_mirror_image();
        Solid { form: Form::Mirrored(Box::new(self)), bounds }
    }

    /// The surface shifted to and fro by up to `height_mm`, in waves of about `length_mm`.
    pub(super) fn rippled(self, height_mm: f32, length_mm: f32) -> Solid {
        let bounds = self.bounds.grown(height_mm);
        Solid { form: Form::Rippled { solid: Box::new(self), height_mm, length_mm }, bounds }
    }

    /// The solid, drawn around the origin with its own x, y and z, put at `origin` so that its z points along `up` and
    /// its x as nearly as possible along `right`.
    pub(super) fn placed(self, origin: impl Into<Vec3>, right: impl Into<Vec3>, up: impl Into<Vec3>) -> Solid {
        let (origin, z) = (origin.into(), up.into().normalize());
        let y = z.cross(right.into()).normalize();
        let axes = Mat3::from_cols(y.cross(z), y, z);
        let reach = self.bounds.farthest_corner();
        let bounds = Bounds::around(origin, Vec3::splat(reach));
        Solid { form: Form::Placed { origin, axes, solid: Box::new(self) }, bounds }
    }

    /// The box around the solid.
    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Signed distance, mm.
    pub(super) fn distance(&self, p: Vec3) -> f32 {
        match &self.form {
            Form::Ellipsoid { center, radii } => ellipsoid_distance(p - *center, *radii),
            Form::Block { center, half, rounding_mm } => {
                let q = (p - *center).abs() - (*half - *rounding_mm);
                q.max(Vec3::ZERO).length() + q.max_element().min(0.0) - rounding_mm
            }
            Form::Tube(segments) => segments.iter().fold(f32::INFINITY, |d, s| d.min(s.distance(p))),
            Form::HalfSpace { point, outward } => (p - *point).dot(*outward),
            Form::Placed { origin, axes, solid } => {
                let q = p - *origin;
                solid.distance(Vec3::new(q.dot(axes.x_axis), q.dot(axes.y_axis), q.dot(axes.z_axis)))
            }
            Form::Mirrored(solid) => solid.distance(Vec3::new(p.x.abs(), p.y, p.z)),
            Form::Rippled { solid, height_mm, length_mm } => {
                let d = solid.distance(p);
                // Waves matter near the surface alone.
                if d.abs() > 4.0 * height_mm { d } else { d - height_mm * value_noise(7, p / *length_mm) }
            }
            Form::Grown { solid, mm } => solid.distance(p) - mm,
            Form::Blend { parts, reach_mm } => parts.iter().fold(f32::INFINITY, |d, part| {
                let out_of_reach = part.bounds.distance(p) >= d + reach_mm;
                if out_of_reach { d } else { smooth_min(d, part.distance(p), *reach_mm) }
            }),
            Form::Common { parts, reach_mm } => {
                parts.iter().fold(f32::NEG_INFINITY, |d, part| -smooth_min(-d, -part.distance(p), *reach_mm))
            }
            Form::Cut { solid, tool, reach_mm } => {
                let d = solid.distance(p);
                let out_of_reach = tool.bounds.distance(p) >= reach_mm - d;
                if out_of_reach { d } else { -smooth_min(-d, tool.distance(p), *reach_mm) }
            }
        }
    }
}

impl Segment {
    fn new(a: Node, b: Node) -> Self {
        let start = Vec3::new(a.0, a.1, a.2);
        let along = Vec3::new(b.0, b.1, b.2) - start;
        // A piece of no length is a ball.
        let inverse_length_squared = 1.0 / along.length_squared().max(1e-6);
        Segment { start, along, inverse_length_squared, radius_mm: a.3, radius_step_mm: b.3 - a.3 }
    }

    fn distance(&self, p: Vec3) -> f32 {
        let from_start = p - self.start;
        let t = (from_start.dot(self.along) * self.inverse_length_squared).clamp(0.0, 1.0);
        (from_start - t * self.along).length() - (self.radius_mm + t * self.radius_step_mm)
    }
}

/// First-order distance to an ellipsoid around the origin: `f / |grad f|`, kept finite at the centre.
fn ellipsoid_distance(p: Vec3, radii: Vec3) -> f32 {
    let unit = p / radii;
    let scaled = unit / radii;
    let (k0, k1) = (unit.length(), scaled.length());
    if k0 >= 1.0 {
        // Convexity makes this Newton step fall short of the surface, never beyond it.
        return k0 * (k0 - 1.0) / k1;
    }
    let f = k0 * k0 - 1.0;
    let shortest = radii.min_element();
    f / (4.0 * k1 * k1 - f / (shortest * shortest)).sqrt()
}

/// Minimum with a cubic fillet of width `reach`; exact where the arguments differ by more.
fn smooth_min(a: f32, b: f32, reach: f32) -> f32 {
    let overlap = reach - (a - b).abs();
    if overlap <= 0.0 {
        return a.min(b);
    }
    let h = overlap / reach;
    a.min(b) - h * h * h * reach / 6.0
}
