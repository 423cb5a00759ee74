//! Cameras: a pixel position to a ray in LPS millimetres.

use glam::{DMat3, DVec3};

use crate::error::{Error, Fault, Result};

/// How rays spread from the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Rays through one point; the vertical field of view in degrees.
    Perspective {
        /// Full vertical angle, above 0 and below 180.
        fov_degrees: f64,
    },
    /// Parallel rays; the height of the picture in mm.
    Parallel {
        /// Height of the picture in the patient, mm.
        height_mm: f64,
    },
}

/// A ray: `origin_mm + s · direction`, `s ≥ 0` in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Start, LPS mm.
    pub origin_mm: DVec3,
    /// Unit vector, LPS.
    pub direction: DVec3,
}

/// A camera with its picture size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    position_mm: DVec3,
    /// Columns: right, up, forward; orthonormal.
    frame: DMat3,
    projection: Projection,
    /// Tangent of half the field of view; 0 of parallel rays.
    slope: f64,
    size: [usize; 2],
}

impl Camera {
    /// A camera at `position_mm` that looks at `target_mm`, with `up` as nearly upwards as it can be, for a picture of
    /// `[width, height]` square pixels.
    ///
    /// # Errors
    /// `Fault::Spec` if the numbers are not finite, the directions are degenerate or the size is 0.
    pub fn look_at(
        position_mm: DVec3,
        target_mm: DVec3,
        up: DVec3,
        projection: Projection,
        size: [usize; 2],
    ) -> Result<Self> {
        let opening = match projection {
            Projection::Perspective { fov_degrees } => fov_degrees > 0.0 && fov_degrees < 180.0,
            Projection::Parallel { height_mm } => height_mm > 0.0 && height_mm.is_finite(),
        };
        if !opening || size.contains(&0) {
            return Err(Error::new(Fault::Spec, "the camera sees nothing")
                .element("camera")
                .found(format!("{projection:?}, {} x {} pixels", size[0], size[1]))
                .expected(
                    "a field of view between 0 and 180 degrees, or a height above 0 mm, and at least one pixel",
                ));
        }
        let forward = (target_mm - position_mm).normalize_or_zero();
        let right = forward.cross(up).normalize_or_zero();
        if forward == DVec3::ZERO || right == DVec3::ZERO || !position_mm.is_finite() {
            return Err(Error::new(Fault::Spec, "the camera has no direction")
                .element("camera")
                .found(format!("position {position_mm}, target {target_mm}, up {up}"))
                .expected("a target away from the position, and an up vector that is not along the line of sight"));
        }
        let frame = DMat3::from_cols(right, right.cross(forward), forward);
        let slope = match projection {
            Projection::Perspective { fov_degrees } => (0.5 * fov_degrees.to_radians()).tan(),
            Projection::Parallel { .. } => 0.0,
        };
        Ok(Camera { position_mm, frame, projection, slope, size })
    }

    /// The same view in a picture of another size, at least 1 x 1; of another shape, it shows more or less at the sides.
    #[must_use]
    pub fn with_size(self, size: [usize; 2]) -> Self {
        Camera { size: size.map(|n| n.max(1)), ..self }
    }

    /// Width and height of the picture in pixels.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Position, LPS mm.
    pub fn position_mm(&self) -> DVec3 {
        self.position_mm
    }

    /// Unit vector into the picture, LPS.
    pub fn forward(&self) -> DVec3 {
        self.frame.z_axis
    }

    /// Unit vector to the right of the picture, LPS.
    pub fn right(&self) -> DVec3 {
        self.frame.x_axis
    }

    /// Unit vector upwards in the picture, LPS.
    pub fn up(&self) -> DVec3 {
        self.frame.y_axis
    }

    /// How rays spread.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// Tangent of half the field of view; 0 of parallel rays.
    pub(super) fn slope(&self) -> f64 {
        self.slope
    }

    /// The ray through a point of the picture: `x` in `[0, width]` to the right, `y` in `[0, height]` downwards; a pixel's
    /// centre has fractions of one half.
    #[inline(always)]
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let [width, height] = self.size.map(|n| n as f64);
        // In units of half the picture's height, so that pixels are square.
        let across = (2.0 * x - width) / height;
        let upwards = (height - 2.0 * y) / height;
        match self.projection {
            Projection::Perspective { .. } => {
                let direction = self.frame * DVec3::new(across * self.slope, upwards * self.slope, 1.0);
                Ray { origin_mm: self.position_mm, direction: direction.normalize() }
            }
            Projection::Parallel { height_mm } => {
                let offset = DVec3::new(across, upwards, 0.0) * (0.5 * height_mm);
                Ray { origin_mm: self.position_mm + self.frame * offset, direction: self.frame.z_axis }
            }
        }
    }

    /// Direction of the ray that passes a point, LPS; at the eye itself, which every ray passes, straight ahead.
    pub fn direction_to(&self, point_mm: DVec3) -> DVec3 {
        match self.projection {
            Projection::Perspective { .. } => (point_mm - self.position_mm).try_normalize().unwrap_or(self.forward()),
            Projection::Parallel { .. } => self.forward(),
        }
    }

    /// The ray through the centre of pixel `(column, row)`, counted from the top left.
    #[inline(always)]
    pub fn pixel_ray(&self, column: usize, row: usize) -> Ray {
        self.ray(column as f64 + 0.5, row as f64 + 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_the_front_the_patients_left_is_on_the_right_and_the_head_is_up() {
        // LPS: +x is the patient's left, -y the front, +z the head.
        let camera = Camera::look_at(
            DVec3::new(0.0, -500.0, 0.0),
            DVec3::ZERO,
            DVec3::Z,
            Projection::Parallel { height_mm: 100.0 },
            [100, 100],
        )
        .unwrap();
        assert!((camera.right() - DVec3::X).length() < 1e-12, "patient's left on the viewer's right");
        let top = camera.pixel_ray(50, 0).origin_mm;
        assert!(top.z > 49.0, "the first row is the highest: found z = {}", top.z);
    }

    #[test]
    fn degenerate_cameras_are_refused() {
        let p = Projection::Perspective { fov_degrees: 30.0 };
        assert!(Camera::look_at(DVec3::ZERO, DVec3::ZERO, DVec3::Z, p, [1, 1]).is_err(), "no direction");
        assert!(Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::Z, p, [1, 1]).is_err(), "up along the view");
        assert!(Camera::look_at(DVec3::ZERO, DVec3::X, DVec3::Z, p, [0, 1]).is_err(), "no pixels");
        let flat = Projection::Perspective { fov_degrees: 180.0 };
        assert!(Camera::look_at(DVec3::ZERO, DVec3::X, DVec3::Z, flat, [1, 1]).is_err(), "half of space");
    }
}
