//! Counts by the values of the two materials between which a voxel lies.

use glam::DVec3;

use super::joint::count_rows;
use super::sampled::{Sampled, Task, on_values};
use super::{Axis, Counts};
use crate::error::{Error, Fault, Result};
use crate::field::{Position, Spacing, Voxel};
use crate::volume::Volume;

/// Most steps of a path. Values rise along it, so it ends without this; a boundary is much thinner.
const MOST_STEPS: usize = 256;

/// Voxels by the values of the lower (horizontal axis) and the higher (vertical axis) of the two materials between which
/// they lie; both axes are of values. By the definition in the [module](super), with `flat_per_mm` the gradient magnitude
/// below which there is no boundary.
///
/// # Errors
/// `Fault::Spec` for a `flat_per_mm` that is not above 0, and as [`joint`](super::joint).
pub fn low_high(volume: &Volume, value: Axis, flat_per_mm: f64) -> Result<Counts> {
    if !(flat_per_mm.is_finite() && flat_per_mm > 0.0) {
        return Err(Error::new(Fault::Spec, "no voxel would lie inside a material")
            .found(format!("a gradient magnitude of {flat_per_mm} per mm as the least of a boundary"))
            .expected("a number above 0, above the noise of the scan"));
    }
    on_values(volume, &LowHigh { value, flat_per_mm })
}

struct LowHigh {
    value: Axis,
    flat_per_mm: f64,
}

impl Task for LowHigh {
    type Output = Counts;

    fn on<V: Voxel, K: Spacing>(&self, sampled: &Sampled<'_, V, K>) -> Counts {
        let paths = Paths { sampled, flat_per_mm: self.flat_per_mm, step_mm: 0.5 * smallest_edge_mm(sampled) };
        count_rows(
            sampled,
            || Counts::new(self.value, self.value),
            |counts, [j, k], gradients| {
                for (i, gradient) in gradients.iter().enumerate() {
                    let value = sampled.value([i, j, k]);
                    if f64::from(*gradient) < self.flat_per_mm {
                        counts.add(value, value);
                        continue;
                    }
                    let start = DVec3::new(i as f64, j as f64, sampled.slices[k]);
                    counts.add(paths.end(start, value, -1.0), paths.end(start, value, 1.0));
                }
            },
        )
    }
}

/// The shortest distance between neighbouring voxels, mm, along axes of more than one.
fn smallest_edge_mm<V: Voxel, K: Spacing>(sampled: &Sampled<'_, V, K>) -> f64 {
    let step = sampled.slices.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    let DVec3 { x, y, z } = sampled.grid.spacing_mm();
    let edges = [x, y, if step.is_finite() { z * step } else { z }];
    let of_many = std::iter::zip(edges, sampled.grid.dims()).filter(|(_, n)| *n > 1).map(|(edge, _)| edge);
    // A volume of one voxel has no gradient, and so no paths.
    of_many.min_by(f64::total_cmp).unwrap_or(1.0)
}

/// Paths along the gradient.
struct Paths<'s, 'v, V, K> {
    sampled: &'s Sampled<'v, V, K>,
    flat_per_mm: f64,
    step_mm: f64,
}

/// What is known of a point on a path.
#[derive(Clone, Copy)]
struct Point {
    index: DVec3,
    value: f64,
    /// Per mm, in the patient.
    gradient: DVec3,
}

impl<V: Voxel, K: Spacing> Paths<'_, '_, V, K> {
    /// The value at the end of the path from a voxel: upward for a `sign` of 1, downward for -1.
    fn end(&self, start: DVec3, value: f64, sign: f64) -> f64 {
        let mut here = Point { value, ..self.point(start) };
        let mut falling = false;
        for _ in 0..MOST_STEPS {
            let steepness = here.gradient.length();
            if steepness < self.flat_per_mm {
                break;
            }
            let Some(next) = self.next(&here, sign) else { break };
            let extremum = sign * (next.value - here.value) <= 0.0;
            let inflection = falling && next.gradient.length() > steepness;
            if extremum || inflection {
                break;
            }
            falling = next.gradient.length() < steepness;
            here = next;
        }
        here.value
    }

    /// One step on, by the midpoint rule; `None` outside of the domain, or where the gradient has no direction.
    fn next(&self, here: &Point, sign: f64) -> Option<Point> {
        let along = |gradient: DVec3, mm: f64| {
            let step_mm = gradient.try_normalize()? * (sign * mm);
            self.inside(here.index + self.sampled.grid.lps_mm_to_index().transform_vector3(step_mm))
        };
        let middle = self.point(along(here.gradient, 0.5 * self.step_mm)?);
        along(middle.gradient, self.step_mm).map(|index| self.point(index))
    }

    /// The same index, if it is inside the domain. Along an axis of one voxel everything is.
    fn inside(&self, index: DVec3) -> Option<DVec3> {
        let dims = self.sampled.field.dims();
        (0..3).all(|a| dims[a] == 1 || (0.0..=(dims[a] - 1) as f64).contains(&index[a])).then_some(index)
    }

    fn point(&self, index: DVec3) -> Point {
        let Sampled { field, units, rescale, .. } = self.sampled;
        let cell = field.cell(Position::new(index, field.dims()));
        let gradient = units.per_mm(field.gradient_per_index(&cell)).map(f64::from);
        Point { index, value: rescale.value(f64::from(field.value(&cell))), gradient: DVec3::from_array(gradient) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Grid, Quantity, Rescale, Samples};
    use glam::{DAffine3, DMat3};

    fn histogram(grid: Grid, hu: impl Fn(DVec3) -> f64, flat_per_mm: f64) -> Counts {
        let at =
            |index| grid.index_to_lps_mm().transform_point3(DVec3::from_array(grid.unflatten(index).map(|i| i as f64)));
        let samples = (0..grid.voxel_count()).map(|index| hu(at(index)) as i16).collect();
        let volume = Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap();
        low_high(&volume, Axis::new([-50.0, 1050.0], 11).unwrap(), flat_per_mm).unwrap()
    }

    /// The bins that are not empty.
    fn peaks(counts: &Counts) -> Vec<([usize; 2], u64)> {
        let bins = (0..counts.x().bins()).flat_map(|i| (0..counts.y().bins()).map(move |j| [i, j]));
        bins.map(|[i, j]| ([i, j], counts.at(i, j))).filter(|(_, count)| *count > 0).collect()
    }

    /// Bin 0 holds 0 HU and bin 10 holds 1000 HU.
    #[test]
    fn a_step_has_two_materials_on_the_diagonal_and_its_boundary_off_it() {
        let grid = Grid::axis_aligned([8, 5, 4], DVec3::new(0.5, 1.0, 2.0)).unwrap();
        let counts = histogram(grid, |at| if at.x < 2.0 { 0.0 } else { 1000.0 }, 20.0);
        // Voxels 3 and 4 along x are beside the step, and their differences see it.
        assert_eq!(peaks(&counts), [([0, 0], 3 * 20), ([0, 10], 2 * 20), ([10, 10], 3 * 20)]);
    }

    #[test]
    fn a_blurred_step_on_a_turned_lattice_has_no_values_between_its_materials() {
        let turn = DMat3::from_rotation_z(0.6) * DMat3::from_rotation_x(-0.4);
        let affine = DAffine3::from_mat3(turn * DMat3::from_diagonal(DVec3::new(0.7, -0.7, 1.1)));
        let grid = Grid::new([24, 24, 24], affine).unwrap();
        let middle = grid.center_mm();
        // 0 HU below the plane, 1000 above, and a smooth edge of 5 mm between.
        let edge = |d: f64| {
            let u = (0.5 + d / 5.0).clamp(0.0, 1.0);
            1000.0 * u * u * (3.0 - 2.0 * u)
        };
        let counts = histogram(grid, |at| edge((at - middle).dot(DVec3::new(0.6, 0.0, 0.8))), 40.0);
        let share = |bins: &[[usize; 2]]| {
            bins.iter().map(|&[i, j]| counts.at(i, j)).sum::<u64>() as f64 / counts.voxels() as f64
        };
        let (materials, boundary) = (share(&[[0, 0], [10, 10]]), share(&[[0, 10]]));
        assert!(materials > 0.4 && boundary > 0.15, "found {materials} inside and {boundary} between the materials");
        // What is left lies near the border of the volume, where paths leave it before they reach a material.
        assert!(materials + boundary > 0.85, "found {materials} + {boundary}");
        assert!((0..11).all(|i| (0..i).all(|j| counts.at(i, j) == 0)), "the lower is never above the higher");
    }

    #[test]
    fn an_inflection_point_separates_two_boundaries() {
        // Stairs of 0, 500 and 1000 HU along x: the landing is short and not flat, but less steep than the edges.
        let stairs = [0.0, 0.0, 0.0, 200.0, 450.0, 500.0, 550.0, 800.0, 1000.0, 1000.0, 1000.0];
        let grid = Grid::axis_aligned([11, 3, 3], DVec3::ONE).unwrap();
        let counts = histogram(grid, |at| stairs[at.x as usize], 10.0);
        // The middle of the landing is the inflection point itself, and no part of one boundary alone.
        let found = [[0, 5], [5, 10], [0, 10]].map(|[i, j]| counts.at(i, j));
        assert_eq!(found, [27, 27, 9], "two boundaries of three layers, and one between: {:?}", peaks(&counts));
    }

    #[test]
    fn a_threshold_that_is_none_is_refused() {
        let grid = Grid::axis_aligned([1, 1, 1], DVec3::ONE).unwrap();
        let volume = Volume::new(grid, Samples::I16(vec![0]), Rescale::IDENTITY, Quantity::Hu).unwrap();
        for flat in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = low_high(&volume, Axis::new([0.0, 1.0], 1).unwrap(), flat).expect_err("no threshold");
            assert_eq!(error.fault(), Fault::Spec, "{flat}: {error}");
        }
    }
}
