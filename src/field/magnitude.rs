//! The gradient magnitude at the voxels, as a channel of its own.

use rayon::prelude::*;

use super::{BlockRanges, Cell, Cells, Even, GradientUnits, Spacing, Trilinear, Voxel};
use crate::error::Result;
use crate::math::Number;
use crate::simd::Lanes;
use crate::volume::{Samples, Volume};

/// The gradient magnitude at every voxel in 16 bits, as a channel that is interpolated like the values. Only 2D transfer functions
/// read it.
#[derive(Debug, Clone)]
pub struct Magnitudes {
    /// Steps, less 32768.
    stored: Vec<i16>,
    /// HU/mm.
    step: f32,
}

/// Steps from 0 to the largest magnitude.
const STEPS: f32 = u16::MAX as f32;

/// Added to the steps that are stored.
const ZERO: f32 = 32_768.0;

impl Magnitudes {
    /// Those of a field, computed in parallel: once for the largest, and once to store them.
    pub fn new<V: Voxel, K: Spacing>(field: &Trilinear<'_, V, K>, units: &GradientUnits) -> Self {
        let [nx, ny, nz] = field.dims;
        let largest = (0..ny * nz).into_par_iter().map_init(
            || vec![0.0; nx],
            |row, n| {
                fill_row(field, units, n % ny, n / ny, row);
                row.iter().fold(0.0, |largest: f32, &m| largest.max(m))
            },
        );
        let largest = largest.reduce(|| 0.0, f32::max);
        let step = (largest.min(f32::MAX) / STEPS).max(f32::MIN_POSITIVE);
        let mut stored = vec![0; field.voxels.len()];
        stored.par_chunks_mut(nx).enumerate().for_each_init(
            || vec![0.0; nx],
            |row, (n, stored)| {
                fill_row(field, units, n % ny, n / ny, row);
                for (stored, m) in stored.iter_mut().zip(row) {
                    *stored = ((*m / step).round_ties_even() - ZERO) as i16;
                }
            },
        );
        Magnitudes { stored, step }
    }

    /// The channel over a lattice of these voxels.
    ///
    /// # Errors
    /// As [`Trilinear::new`].
    pub fn field(&self, dims: [usize; 3]) -> Result<Magnitude<'_>> {
        Ok(Magnitude { stored: Trilinear::new(&self.stored, dims)?, step: self.step })
    }

    /// How far what is stored may be from the magnitude at a voxel, HU/mm; what is interpolated is no further off.
    pub fn error_per_mm(&self) -> f32 {
        // Half a step, and the roundings of the division and of reading it again.
        self.step * (0.5 + 2.0 * STEPS * f32::EPSILON)
    }
}

/// The gradient magnitude, HU/mm, interpolated between voxels.
#[derive(Debug, Clone, Copy)]
pub struct Magnitude<'a> {
    stored: Trilinear<'a, i16>,
    step: f32,
}

impl Magnitude<'_> {
    /// At a place in a cell.
    #[inline(always)]
    pub fn value(&self, cell: &Cell) -> f32 {
        self.per_mm(self.stored.value(cell))
    }

    /// In lanes.
    #[inline(always)]
    pub(crate) fn values<L: Lanes>(&self, cells: &Cells<L>) -> L {
        self.per_mm(self.stored.values(cells))
    }

    #[inline(always)]
    fn per_mm<R: Number>(&self, stored: R) -> R {
        let step = R::from_f64(f64::from(self.step));
        stored.mul_plus(step, R::from_f64(f64::from(self.step * ZERO)))
    }

    /// The ranges of blocks, HU/mm.
    pub fn ranges<const LOG2: u32>(&self) -> BlockRanges<LOG2> {
        BlockRanges::new(&self.stored).mapped(|stored| self.per_mm(stored))
    }
}

/// The gradient magnitude at every voxel, HU/mm, x fastest: 4 bytes per voxel, computed in parallel.
pub fn gradient_magnitude_per_mm<V: Voxel, K: Spacing>(field: &Trilinear<'_, V, K>, units: &GradientUnits) -> Vec<f32> {
    let [nx, ny, _] = field.dims;
    let mut magnitude = vec![0.0; field.voxels.len()];
    magnitude.par_chunks_mut(nx * ny).enumerate().for_each(|(k, slice)| {
        for (j, row) in slice.chunks_mut(nx).enumerate() {
            fill_row(field, units, j, k, row);
        }
    });
    magnitude
}

/// The gradient magnitude along the row `(j, k)` of voxels, HU/mm: for those who need few rows at a time. Panics if `row` is
/// not as long as a row of the field.
pub fn gradient_magnitude_row<V: Voxel, K: Spacing>(
    field: &Trilinear<'_, V, K>,
    units: &GradientUnits,
    [j, k]: [usize; 2],
    row: &mut [f32],
) {
    assert_eq!(row.len(), field.dims[0], "voxels in a row");
    fill_row(field, units, j, k, row);
}

/// The gradient magnitude at every voxel of a volume with even slices, HU/mm, x fastest; 0 where there are no values.
///
/// # Errors
/// As [`Trilinear::new`].
pub fn gradient_magnitudes(volume: &Volume) -> Result<Vec<f32>> {
    let (grid, units) = (volume.grid(), GradientUnits::new(volume.grid(), volume.rescale()));
    Ok(match volume.samples() {
        Samples::I16(voxels) => gradient_magnitude_per_mm(&Trilinear::new(voxels, grid.dims())?, &units),
        Samples::F32(voxels) => gradient_magnitude_per_mm(&Trilinear::new(voxels, grid.dims())?, &units),
        Samples::Rgba8(_) | Samples::Rgba16(_) => vec![0.0; grid.voxel_count()],
    })
}

/// Smallest and largest of [`gradient_magnitudes`].
///
/// # Errors
/// As [`Trilinear::new`].
pub fn gradient_range_per_mm(volume: &Volume) -> Result<[f64; 2]> {
    let magnitudes = gradient_magnitudes(volume)?;
    let ends = magnitudes.iter().fold([f32::INFINITY, 0.0], |[low, high], &m| [low.min(m), high.max(m)]);
    Ok(ends.map(f64::from))
}

fn fill_row<V: Voxel, K: Spacing>(
    field: &Trilinear<'_, V, K>,
    units: &GradientUnits,
    j: usize,
    k: usize,
    row: &mut [f32],
) {
    let [nx, ny, nz] = field.dims;
    let line = |j: usize, k: usize| &field.voxels[nx * (j + ny * k)..][..nx];
    let ((j0, j1), (k0, k1)) = (neighbours(j, ny), neighbours(k, nz));
    let per_j = Even.per_step(j0, j1);
    let per_k = field.spacing.per_step(k0, k1);
    let (here, front, back, below, above) = (line(j, k), line(j0, k), line(j1, k), line(j, k0), line(j, k1));
    let across = |i: usize| [back[i].minus(front[i]) * per_j, above[i].minus(below[i]) * per_k];
    for end in [0, nx - 1] {
        let (i0, i1) = neighbours(end, nx);
        row[end] = length_per_mm(units, here[i1].minus(here[i0]) * Even.per_step(i0, i1), across(end));
    }
    for i in 1..nx.max(2) - 1 {
        row[i] = length_per_mm(units, 0.5 * here[i + 1].minus(here[i - 1]), across(i));
    }
}

/// The length of a gradient of stored units per index step, HU/mm. Inline, or the loop over a row is not vectorised.
#[inline(always)]
fn length_per_mm(units: &GradientUnits, along_i: f32, [along_j, along_k]: [f32; 2]) -> f32 {
    let [gx, gy, gz] = units.per_mm([along_i, along_j, along_k]);
    (gx * gx + gy * gy + gz * gz).sqrt()
}

/// The neighbours of a voxel along an axis of `n`; on the border the voxel itself is one of them.
fn neighbours(i: usize, n: usize) -> (usize, usize) {
    (i.saturating_sub(1), (i + 1).min(n - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Cell, Position};
    use crate::volume::{Grid, Rescale};
    use glam::DVec3;

    #[test]
    fn at_the_voxels_it_is_the_length_of_the_gradient() {
        for dims in [[7, 6, 5], [2, 3, 2], [1, 4, 4], [4, 1, 1]] {
            let count: usize = dims.iter().product();
            let voxels: Vec<i16> = (0..count).map(|i| ((i * 7919) % 4096) as i16 - 1024).collect();
            let field = Trilinear::new(&voxels, dims).unwrap();
            let grid = Grid::axis_aligned(dims, DVec3::new(0.5, 0.7, 3.0)).unwrap();
            let units = GradientUnits::new(&grid, Rescale { slope: 2.0, intercept: -1000.0 });
            let magnitude = gradient_magnitude_per_mm(&field, &units);
            let stored = Magnitudes::new(&field, &units);
            let interpolated = stored.field(dims).unwrap();
            for (index, found) in magnitude.iter().enumerate() {
                let at = grid.unflatten(index);
                let cell: Cell = Position::new(DVec3::from_array(at.map(|i| i as f64)), dims).even_cell();
                let [x, y, z] = units.per_mm(field.gradient_per_index(&cell));
                let expected = (x * x + y * y + z * z).sqrt();
                assert!((found - expected).abs() < 0.01, "{dims:?} at {at:?}: found {found}, expected {expected}");
                let (kept, most) = (interpolated.value(&cell), stored.error_per_mm());
                assert!((kept - found).abs() <= most, "{dims:?} at {at:?}: {kept} kept of {found}, {most:e} at most");
            }
        }
    }
}
