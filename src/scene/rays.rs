//! Rays side by side: loops over them have no branches, so that compilers fill registers with rays.

use glam::DVec3;

use super::{Camera, Projection, Ray};

/// Rays, each of their numbers in a row of its own.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rays {
    origin_mm: [Vec<f64>; 3],
    direction: [Vec<f64>; 3],
}

impl Rays {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.origin_mm[0].len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Ray `n`.
    #[inline(always)]
    pub fn get(&self, n: usize) -> Ray {
        let at = |[x, y, z]: &[Vec<f64>; 3]| DVec3::new(x[n], y[n], z[n]);
        Ray { origin_mm: at(&self.origin_mm), direction: at(&self.direction) }
    }

    /// Start of each ray by axis, LPS mm.
    #[inline(always)]
    pub fn origins_mm(&self) -> &[Vec<f64>; 3] {
        &self.origin_mm
    }

    /// Unit vector of each ray by axis, LPS.
    #[inline(always)]
    pub fn directions(&self) -> &[Vec<f64>; 3] {
        &self.direction
    }

    /// Takes the rays through the centres of pixels in place of those that were here: to the bit as [`Camera::pixel_ray`] gives
    /// them.
    #[inline(always)]
    pub fn through(&mut self, camera: &Camera, pixels: impl Iterator<Item = [usize; 2]>) {
        let [width, height] = camera.size().map(|n| n as f64);
        let [across, upwards, _] = &mut self.direction;
        across.clear();
        upwards.clear();
        // From inside: nested iterators take long to be asked one by one.
        pixels.for_each(|[column, row]| {
            across.push(column as f64 + 0.5);
            upwards.push(row as f64 + 0.5);
        });
        let count = across.len();
        for axis in self.origin_mm.iter_mut().chain(&mut self.direction) {
            axis.resize(count, 0.0);
        }
        let [right, up, forward] = [camera.right(), camera.up(), camera.forward()];
        let [ox, oy, oz] = self.origin_mm.each_mut().map(|axis| &mut axis[..count]);
        let [dx, dy, dz] = self.direction.each_mut().map(|axis| &mut axis[..count]);
        let eye = camera.position_mm();
        match camera.projection() {
            Projection::Perspective { .. } => {
                let slope = camera.slope();
                for n in 0..count {
                    let a = (2.0 * dx[n] - width) / height * slope;
                    let b = (height - 2.0 * dy[n]) / height * slope;
                    let x = right.x * a + up.x * b + forward.x;
                    let y = right.y * a + up.y * b + forward.y;
                    let z = right.z * a + up.z * b + forward.z;
                    let per_length = 1.0 / (x * x + y * y + z * z).sqrt();
                    (dx[n], dy[n], dz[n]) = (x * per_length, y * per_length, z * per_length);
                    (ox[n], oy[n], oz[n]) = (eye.x, eye.y, eye.z);
                }
            }
            Projection::Parallel { height_mm } => {
                let half_mm = 0.5 * height_mm;
                for n in 0..count {
                    let a = (2.0 * dx[n] - width) / height * half_mm;
                    let b = (height - 2.0 * dy[n]) / height * half_mm;
                    ox[n] = eye.x + (right.x * a + up.x * b + forward.x * 0.0);
                    oy[n] = eye.y + (right.y * a + up.y * b + forward.y * 0.0);
                    oz[n] = eye.z + (right.z * a + up.z * b + forward.z * 0.0);
                    (dx[n], dy[n], dz[n]) = (forward.x, forward.y, forward.z);
                }
            }
        }
    }
}

impl FromIterator<Ray> for Rays {
    fn from_iter<I: IntoIterator<Item = Ray>>(rays: I) -> Self {
        let mut all = Rays::default();
        for Ray { origin_mm, direction } in rays {
            for a in 0..3 {
                all.origin_mm[a].push(origin_mm[a]);
                all.direction[a].push(direction[a]);
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_side_by_side_are_those_one_by_one_to_the_bit() {
        let size = [37, 23];
        let pixels = || (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| [column, row]));
        for projection in [Projection::Perspective { fov_degrees: 41.0 }, Projection::Parallel { height_mm: 170.0 }] {
            let (eye, target) = (DVec3::new(-310.0, -520.7, 99.0), DVec3::new(3.1, 0.7, -11.0));
            let camera = Camera::look_at(eye, target, DVec3::new(0.1, 0.2, 1.0), projection, size).unwrap();
            let mut rays = Rays::default();
            rays.through(&camera, pixels().take(5));
            rays.through(&camera, pixels());
            assert_eq!(rays.len(), size[0] * size[1], "those of before are gone");
            for (n, [column, row]) in pixels().enumerate() {
                assert_eq!(rays.get(n), camera.pixel_ray(column, row), "{projection:?}, pixel {column} {row}");
            }
            assert_eq!(rays, pixels().map(|[column, row]| camera.pixel_ray(column, row)).collect());
        }
    }
}
