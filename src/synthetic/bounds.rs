//! Axis-aligned boxes around solids, so that far solids cost one comparison.

use glam::Vec3;

/// A box from `low` to `high`, mm; may reach to infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    pub(super) const EVERYWHERE: Bounds = Bounds { low: Vec3::NEG_INFINITY, high: Vec3::INFINITY };
    const NOWHERE: Bounds = Bounds { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    pub(super) fn around(center: Vec3, half: Vec3) -> Self {
        Bounds { low: center - half, high: center + half }
    }

    /// The smallest box around all of `boxes`.
    pub(super) fn hull(boxes: impl IntoIterator<Item = Bounds>) -> Self {
        boxes.into_iter().fold(Bounds::NOWHERE, |a, b| Bounds { low: a.low.min(b.low), high: a.high.max(b.high) })
    }

    pub(super) fn overlap(self, other: Bounds) -> Self {
        Bounds { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    pub(super) fn grown(self, mm: f32) -> Self {
        Bounds { low: self.low - mm, high: self.high + mm }
    }

    /// The box together with its mirror image in the plane x = 0.
    pub(super) fn with_mirror_image(self) -> Self {
        let image = Bounds {
            low: Vec3::new(-self.high.x, self.low.y, self.low.z),
            high: Vec3::new(-self.low.x, self.high.y, self.high.z),
        };
        Bounds::hull([self, image])
    }

    /// Distance from the origin to the farthest corner, mm.
    pub(super) fn farthest_corner(&self) -> f32 {
        self.low.abs().max(self.high.abs()).length()
    }

    /// A lower bound of the signed distance to anything inside the box, mm: negative inside, and outside the largest
    /// of the distances along the axes.
    pub(super) fn distance(&self, p: Vec3) -> f32 {
        (self.low - p).max(p - self.high).max_element()
    }
}
