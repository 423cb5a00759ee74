//! Where shading along a passage is not smooth.

use glam::DVec3;

use super::bernstein::{Bernstein, Cubic};
use super::roots::{critical_points, zeros};
use super::splits::Splits;
use crate::scene::Shading;

/// Shading on rays of one direction.
#[derive(Debug, Clone)]
pub(super) struct ShadedRay {
    /// Cosine of the angle by which the normal may turn within a step of the quadrature.
    smallest_cosine: f64,
    /// The vectors whose product with the normal is bent at zero: towards each light, and halfway from it to the eye.
    bends: Vec<DVec3>,
}

impl ShadedRay {
    /// Shading on rays of this direction.
    pub(super) fn new(shading: &Shading, direction: DVec3) -> Self {
        let mut bends = Vec::new();
        for (towards, half, _) in shading.directions(direction) {
            bends.push(towards);
            if half != towards {
                bends.push(half);
            }
        }
        // A highlight falls to a seventh of its top at 2/√shininess, too wide to lie unseen between five nodes.
        let widest_turn = (2.0 / shading.shininess.sqrt()).min(1.0);
        ShadedRay { smallest_cosine: widest_turn.cos(), bends }
    }

    /// Adds the cuts where shading is bent, and those where the gradient is small and its direction turns quickly.
    pub(super) fn add_bends(&self, gradient: &[Cubic; 3], splits: &mut Splits) {
        for bend in &self.bends {
            let product: Cubic = Bernstein(std::array::from_fn(|i| {
                bend.x * gradient[0].0[i] + bend.y * gradient[1].0[i] + bend.z * gradient[2].0[i]
            }));
            splits.add(zeros(&product.0).as_slice());
            splits.add(critical_points(&product.0).as_slice());
        }
        let squares = gradient.map(|g| g.times(&g));
        let square: [f64; 7] = std::array::from_fn(|i| squares[0].0[i] + squares[1].0[i] + squares[2].0[i]);
        splits.add(critical_points(&square).as_slice());
    }

    /// True if shading changes gently between two points that are not separated by a cut. Where the gradient nearly
    /// vanishes its direction turns, and the fade changes, within a length proportional to its magnitude, however short
    /// that is; between cuts the magnitude is monotone, so its values at the ends tell.
    pub(super) fn is_gentle_between(&self, a: DVec3, b: DVec3) -> bool {
        let (aa, bb) = (a.length_squared(), b.length_squared());
        aa.max(bb) <= 4.0 * aa.min(bb) && a.dot(b) >= self.smallest_cosine * (aa * bb).sqrt()
    }
}
