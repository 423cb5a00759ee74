//! Chords of many rays, side by side.

use glam::DVec3;

use super::Chord;
use crate::scene::{Clip, Rays};
use crate::volume::Grid;

/// The chords of rays, each of their numbers in a row of its own, so that compilers fill registers with rays.
#[derive(Debug, Clone, Default)]
pub struct Chords {
    entry_mm: Vec<f64>,
    length_mm: Vec<f64>,
    entry_index: [Vec<f64>; 3],
    index_per_mm: [Vec<f64>; 3],
}

impl Chords {
    /// Takes the chords of rays in place of those that were here: to the bit as [`Chord::new`] gives them.
    #[inline(always)]
    pub fn of(&mut self, grid: &Grid, clip: &Clip, rays: &Rays) {
        let count = rays.len();
        let Chords { entry_mm, length_mm, entry_index, index_per_mm } = self;
        for row in [&mut *entry_mm, &mut *length_mm].into_iter().chain(entry_index.iter_mut()).chain(&mut *index_per_mm)
        {
            row.resize(count, 0.0);
        }
        // Until the end, lengths are exits.
        let (entry_mm, exit_mm) = (&mut entry_mm[..count], &mut length_mm[..count]);
        entry_mm.fill(0.0);
        exit_mm.fill(f64::INFINITY);
        if !clip.half_spaces.is_empty() {
            for n in 0..count {
                [entry_mm[n], exit_mm[n]] = clip.interval_mm(&rays.get(n)).unwrap_or([f64::INFINITY, 0.0]);
            }
        }
        let (to_index, (low, high)) = (grid.lps_mm_to_index(), grid.index_bounds());
        let [ox, oy, oz] = rays.origins_mm().each_ref().map(|axis| &axis[..count]);
        let [dx, dy, dz] = rays.directions().each_ref().map(|axis| &axis[..count]);
        for a in 0..3 {
            let [mx, my, mz] = [to_index.matrix3.x_axis[a], to_index.matrix3.y_axis[a], to_index.matrix3.z_axis[a]];
            let (moved, low, high) = (to_index.translation[a], low[a], high[a]);
            let (origins, directions) = (&mut entry_index[a][..count], &mut index_per_mm[a][..count]);
            for n in 0..count {
                let origin = mx * ox[n] + my * oy[n] + mz * oz[n] + moved;
                let direction = mx * dx[n] + my * dy[n] + mz * dz[n];
                let (s, t) = ((low - origin) / direction, (high - origin) / direction);
                let (near, far) = if s < t { (s, t) } else { (t, s) };
                // An axis that the ray does not move on lets it pass or not.
                let beside = if origin < low || origin > high { f64::INFINITY } else { f64::NEG_INFINITY };
                let is_still = direction == 0.0;
                let near = if is_still { beside } else { near };
                let far = if is_still { f64::INFINITY } else { far };
                entry_mm[n] = if entry_mm[n] < near { near } else { entry_mm[n] };
                exit_mm[n] = if far < exit_mm[n] { far } else { exit_mm[n] };
                (origins[n], directions[n]) = (origin, direction);
            }
        }
        for a in 0..3 {
            let (indices, directions) = (&mut entry_index[a][..count], &index_per_mm[a][..count]);
            for n in 0..count {
                indices[n] += entry_mm[n] * directions[n];
            }
        }
        for n in 0..count {
            exit_mm[n] -= entry_mm[n];
        }
    }

    /// The chord of ray `n`; `None` if it has none.
    #[inline(always)]
    pub fn get(&self, n: usize) -> Option<Chord> {
        let length_mm = self.length_mm[n];
        // Not a closure: it would stay a call.
        if length_mm > 0.0 && length_mm.is_finite() {
            let [x, y, z] = &self.entry_index;
            let entry_index = DVec3::new(x[n], y[n], z[n]);
            let [x, y, z] = &self.index_per_mm;
            let index_per_mm = DVec3::new(x[n], y[n], z[n]);
            Some(Chord { entry_mm: self.entry_mm[n], length_mm, entry_index, index_per_mm })
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{HalfSpace, Ray};

    #[test]
    fn chords_side_by_side_are_those_one_by_one_to_the_bit() {
        let grid = Grid::axis_aligned([11, 21, 1], DVec3::new(1.0, 0.5, 2.0)).unwrap();
        let clip = |half_spaces: &[(DVec3, f64)]| Clip {
            half_spaces: half_spaces.iter().map(|&(normal, offset_mm)| HalfSpace { normal, offset_mm }).collect(),
        };
        let mut rays = Vec::new();
        for n in 0..2000 {
            let u = |k: f64| (f64::from(n) * k + 0.21).fract() - 0.5;
            let to = DVec3::new(5.0 + 12.0 * u(0.618), 5.0 + 12.0 * u(0.414), 0.5 * u(0.732));
            let origin_mm = DVec3::new(50.0 * u(0.271), 50.0 * u(0.828), 40.0 * u(0.577));
            let mut direction = (to - origin_mm).normalize();
            // Along an axis or a face.
            match n % 10 {
                0 => direction = DVec3::Z,
                1 => direction = -DVec3::X,
                2 => direction = DVec3::new(0.6, -0.8, 0.0),
                _ => {}
            }
            rays.push(Ray { origin_mm, direction });
        }
        rays.push(Ray { origin_mm: DVec3::new(10.0, 5.0, -1.0), direction: DVec3::Z });
        let all = rays.iter().copied().collect::<Rays>();
        let mut chords = Chords::default();
        for clip in [clip(&[]), clip(&[(DVec3::new(0.6, 0.0, 0.8), 3.0), (-DVec3::Y, -7.0)])] {
            chords.of(&grid, &clip, &all);
            let (mut met, mut missed) = (0, 0);
            for (n, &ray) in rays.iter().enumerate() {
                let expected = Chord::new(&grid, &clip, ray);
                assert_eq!(chords.get(n), expected, "{ray:?}");
                if expected.is_some() { met += 1 } else { missed += 1 }
            }
            assert!(met > 500 && missed > 100, "{met} met, {missed} missed");
        }
    }
}
