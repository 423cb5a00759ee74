//! The gradient magnitude at the voxels, as a channel of its own.

use rayon::prelude::*;

use super::bricks::{Bricks, Row};
use super::macrocell::Planes;
use super::{BlockRanges, Cell, Cells, Even, GradientUnits, Spacing, Trilinear, Voxel};
use crate::error::Result;
use crate::math::Number;
use crate::simd::{Kernel, Lanes, Level};
use crate::volume::{Samples, Volume};

/// The gradient magnitude at the voxels in 16 bits, as a channel that is interpolated like the values: of the blocks in which
/// somebody reads it, or of all. Only 2D transfer functions read it.
#[derive(Debug, Clone)]
pub struct Magnitudes {
    kept: Kept,
    steps: Steps,
}

/// Equal steps from 0 to the largest magnitude, in which magnitudes are kept.
#[derive(Debug, Clone, Copy)]
pub struct Steps {
    /// HU/mm.
    step_per_mm: f32,
}

/// Numbers of steps, less 32768.
#[derive(Debug, Clone)]
enum Kept {
    /// Of all voxels.
    Everywhere(Vec<i16>),
    /// Of some blocks.
    InBricks(Bricks),
}

/// Steps from 0 to the largest magnitude.
const STEPS: f32 = u16::MAX as f32;

/// Added to the steps that are stored.
const ZERO: f32 = 32_768.0;

impl Magnitudes {
    /// Those of a field, none of which is beyond the steps, computed in parallel: where it takes less memory, only those of blocks of 8³
    /// cells of which `is_read` holds, by their place among the blocks. Elsewhere the magnitude is 0.
    pub fn new<V: Voxel, K: Spacing>(
        field: &Trilinear<'_, V, K>,
        units: &GradientUnits,
        steps: Steps,
        is_read: impl Fn([usize; 3]) -> bool + Sync,
    ) -> Self {
        let level = Level::widest();
        let lines = || Lines { field, units, steps, magnitudes: Vec::new() };
        let bricks = Bricks::new(field.dims, steps.stored(0.0), is_read, |row| level.run((lines(), row)));
        let kept = bricks.map_or_else(
            || {
                let [nx, ny, _] = field.dims;
                let mut all = vec![0; field.voxels.len()];
                let planes = all.par_chunks_mut(nx * ny).enumerate();
                planes.for_each(|(k, plane)| level.run((lines(), k, plane)));
                Kept::Everywhere(all)
            },
            Kept::InBricks,
        );
        let magnitudes = Magnitudes { kept, steps };
        tracing::debug!(bytes = magnitudes.bytes(), of = 2 * field.voxels.len(), "gradient magnitudes kept");
        magnitudes
    }

    /// The channel over a lattice of these voxels.
    ///
    /// # Errors
    /// As [`Trilinear::new`].
    pub fn field(&self, dims: [usize; 3]) -> Result<Magnitude<'_>> {
        Ok(Magnitude {
            stored: match &self.kept {
                Kept::Everywhere(all) => Stored::Everywhere(Trilinear::new(all, dims)?),
                Kept::InBricks(bricks) => Stored::InBricks(bricks),
            },
            steps: self.steps,
        })
    }

    /// Bytes of what is kept.
    pub fn bytes(&self) -> usize {
        match &self.kept {
            Kept::Everywhere(all) => size_of_val(&**all),
            Kept::InBricks(bricks) => bricks.bytes(),
        }
    }
}

impl Steps {
    /// How far what is kept may be from a magnitude, by the largest: half a step, and the roundings of the division and of reading it
    /// again.
    pub const RELATIVE_ERROR: f32 = (0.5 + 2.0 * STEPS * f32::EPSILON) / STEPS;

    /// Those up to the largest magnitude, HU/mm.
    pub fn up_to(largest_per_mm: f32) -> Self {
        Steps { step_per_mm: (largest_per_mm.min(f32::MAX) / STEPS).max(f32::MIN_POSITIVE) }
    }

    /// What a magnitude becomes when it is kept, HU/mm.
    pub fn rounded(self, magnitude_per_mm: f32) -> f32 {
        self.per_mm(f32::from(self.stored(magnitude_per_mm)))
    }

    #[inline(always)]
    fn stored(self, magnitude_per_mm: f32) -> i16 {
        ((magnitude_per_mm / self.step_per_mm).round_ties_even() - ZERO) as i16
    }

    #[inline(always)]
    fn per_mm<R: Number>(self, stored: R) -> R {
        let step = f64::from(self.step_per_mm);
        stored.mul_plus(R::from_f64(step), R::from_f64(step * f64::from(ZERO)))
    }
}

/// The gradient magnitude, HU/mm, interpolated between voxels.
#[derive(Debug, Clone, Copy)]
pub struct Magnitude<'a> {
    stored: Stored<'a>,
    steps: Steps,
}

#[derive(Debug, Clone, Copy)]
enum Stored<'a> {
    Everywhere(Trilinear<'a, i16>),
    InBricks(&'a Bricks),
}

impl Magnitude<'_> {
    /// At a place in a cell.
    #[inline(always)]
    pub fn value(&self, cell: &Cell) -> f32 {
        let stored = match &self.stored {
            Stored::Everywhere(all) => all.value(cell),
            Stored::InBricks(bricks) => bricks.value(cell),
        };
        self.steps.per_mm(stored)
    }

    /// In lanes.
    #[inline(always)]
    pub(crate) fn values<L: Lanes>(&self, cells: &Cells<L>) -> L {
        let stored = match &self.stored {
            Stored::Everywhere(all) => all.values(cells),
            Stored::InBricks(bricks) => bricks.values(cells),
        };
        self.steps.per_mm(stored)
    }
}

/// Lines of magnitudes, as they are asked for: compiled for the processor's registers.
struct Lines<'f, 'v, V, K> {
    field: &'f Trilinear<'v, V, K>,
    units: &'f GradientUnits,
    steps: Steps,
    magnitudes: Vec<f32>,
}

impl<V: Voxel, K: Spacing> Lines<'_, '_, V, K> {
    /// As they are stored, from voxel `first` of line `(j, k)` on.
    #[inline(always)]
    fn store(&mut self, first: usize, [j, k]: [usize; 2], line: &mut [i16]) {
        self.magnitudes.resize(line.len(), 0.0);
        fill(self.field, self.units, first, [j, k], &mut self.magnitudes);
        for (to, &magnitude) in line.iter_mut().zip(&self.magnitudes) {
            *to = self.steps.stored(magnitude);
        }
    }
}

impl<V: Voxel, K: Spacing> Kernel for (Lines<'_, '_, V, K>, Row<'_>) {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let (mut lines, row) = self;
        row.fill(
            lines.field.dims,
            #[inline(always)]
            |first, at, line| lines.store(first, at, line),
        );
    }
}

/// A plane.
impl<V: Voxel, K: Spacing> Kernel for (Lines<'_, '_, V, K>, usize, &mut [i16]) {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let (mut lines, k, plane) = self;
        for (j, line) in plane.chunks_exact_mut(lines.field.dims[0]).enumerate() {
            lines.store(0, [j, k], line);
        }
    }
}

/// Planes of magnitudes, HU/mm, as they are asked for.
struct Computed<'f, 'v, V, K> {
    field: &'f Trilinear<'v, V, K>,
    units: &'f GradientUnits,
    plane: Vec<f32>,
}

impl<V: Voxel, K: Spacing> Planes for Computed<'_, '_, V, K> {
    type Sample = f32;

    #[inline(always)]
    fn plane(&mut self, k: usize) -> &[f32] {
        for (j, line) in self.plane.chunks_exact_mut(self.field.dims[0]).enumerate() {
            fill(self.field, self.units, 0, [j, k], line);
        }
        &self.plane
    }
}

impl<const LOG2: u32> BlockRanges<LOG2> {
    /// The ranges of the gradient magnitude, HU/mm, computed in parallel.
    pub fn of_magnitudes<V: Voxel, K: Spacing>(field: &Trilinear<'_, V, K>, units: &GradientUnits) -> Self {
        let voxels = field.dims[0] * field.dims[1];
        Self::of_planes(field.dims, || Computed { field, units, plane: vec![0.0; voxels] })
    }
}

/// The gradient magnitude at every voxel, HU/mm, x fastest: 4 bytes per voxel, computed in parallel.
pub fn gradient_magnitude_per_mm<V: Voxel, K: Spacing>(field: &Trilinear<'_, V, K>, units: &GradientUnits) -> Vec<f32> {
    let [nx, ny, _] = field.dims;
    let mut magnitude = vec![0.0; field.voxels.len()];
    magnitude.par_chunks_mut(nx * ny).enumerate().for_each(|(k, slice)| {
        for (j, row) in slice.chunks_mut(nx).enumerate() {
            fill(field, units, 0, [j, k], row);
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
    fill(field, units, 0, [j, k], row);
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

/// Fills a part of line `(j, k)`, from voxel `first` on.
#[inline(always)]
fn fill<V: Voxel, K: Spacing>(
    field: &Trilinear<'_, V, K>,
    units: &GradientUnits,
    first: usize,
    [j, k]: [usize; 2],
    part: &mut [f32],
) {
    let [nx, ny, nz] = field.dims;
    let line = |j: usize, k: usize| &field.voxels[nx * (j + ny * k)..][..nx];
    let ((j0, j1), (k0, k1)) = (neighbours(j, ny), neighbours(k, nz));
    let per_j = Even.per_step(j0, j1);
    let per_k = field.spacing.per_step(k0, k1);
    let (here, front, back, below, above) = (line(j, k), line(j0, k), line(j1, k), line(j, k0), line(j, k1));
    let behind = first + part.len();
    for end in [0, nx - 1].into_iter().filter(|end| (first..behind).contains(end)) {
        let across = [back[end].minus(front[end]) * per_j, above[end].minus(below[end]) * per_k];
        let (i0, i1) = neighbours(end, nx);
        part[end - first] = length_per_mm(units, here[i1].minus(here[i0]) * Even.per_step(i0, i1), across);
    }
    // Of lines as long as the part, so that nothing is checked voxel by voxel.
    let (start, end) = (first.max(1), behind.min(nx - 1));
    let count = end.saturating_sub(start);
    if count == 0 {
        return;
    }
    let (left, right) = (&here[start - 1..][..count], &here[start + 1..][..count]);
    let (front, back) = (&front[start..][..count], &back[start..][..count]);
    let (below, above) = (&below[start..][..count], &above[start..][..count]);
    let part = &mut part[start - first..][..count];
    for i in 0..count {
        let across = [back[i].minus(front[i]) * per_j, above[i].minus(below[i]) * per_k];
        part[i] = length_per_mm(units, 0.5 * right[i].minus(left[i]), across);
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

    fn with_units(dims: [usize; 3]) -> (Grid, GradientUnits) {
        let grid = Grid::axis_aligned(dims, DVec3::new(0.5, 0.7, 3.0)).unwrap();
        let units = GradientUnits::new(&grid, Rescale { slope: 2.0, intercept: -1000.0 });
        (grid, units)
    }

    fn voxels(dims: [usize; 3]) -> Vec<i16> {
        (0..dims.iter().product()).map(|i: usize| ((i * 7919) % 4096) as i16 - 1024).collect()
    }

    #[test]
    fn at_the_voxels_it_is_the_length_of_the_gradient() {
        for dims in [[7, 6, 5], [2, 3, 2], [1, 4, 4], [4, 1, 1]] {
            let voxels = voxels(dims);
            let field = Trilinear::new(&voxels, dims).unwrap();
            let (grid, units) = with_units(dims);
            let magnitude = gradient_magnitude_per_mm(&field, &units);
            let largest = magnitude.iter().fold(0.0, |largest: f32, &m| largest.max(m));
            let stored = Magnitudes::new(&field, &units, Steps::up_to(largest), |_| true);
            let interpolated = stored.field(dims).unwrap();
            for (index, found) in magnitude.iter().enumerate() {
                let at = grid.unflatten(index);
                let cell: Cell = Position::new(DVec3::from_array(at.map(|i| i as f64)), dims).even_cell();
                let [x, y, z] = units.per_mm(field.gradient_per_index(&cell));
                let expected = (x * x + y * y + z * z).sqrt();
                assert!((found - expected).abs() < 0.01, "{dims:?} at {at:?}: found {found}, expected {expected}");
                let (kept, most) = (interpolated.value(&cell), Steps::RELATIVE_ERROR * largest);
                assert!((kept - found).abs() <= most, "{dims:?} at {at:?}: {kept} kept of {found}, {most:e} at most");
            }
        }
    }

    #[test]
    fn bricks_have_what_the_whole_channel_has_where_they_are_kept_and_elsewhere_nothing() {
        for dims in [[70, 33, 40], [64, 65, 9], [200, 8, 90]] {
            let voxels = voxels(dims);
            let field = Trilinear::new(&voxels, dims).unwrap();
            let (_, units) = with_units(dims);
            let ranges = BlockRanges::<3>::of_magnitudes(&field, &units);
            let largest = ranges.ranges().iter().fold(0.0, |largest: f32, &[_, high]| largest.max(high));
            // One block in five or so, those at the ends among them.
            let is_read = |[i, j, k]: [usize; 3]| (i * 3 + j + 2 * k) % 5 == 0;
            let (some, all) = (
                Magnitudes::new(&field, &units, Steps::up_to(largest), is_read),
                Magnitudes::new(&field, &units, Steps::up_to(largest), |_| true),
            );
            assert!(some.bytes() < all.bytes() / 2, "{dims:?}: {} bytes of {}", some.bytes(), all.bytes());
            let (some, all) = (some.field(dims).unwrap(), all.field(dims).unwrap());
            let (mut kept, blocks) = (0, ranges.blocks());
            for n in 0..20_000 {
                let u = |k: f64| (f64::from(n) * k).fract();
                let at = DVec3::from_array(dims.map(|n| (n - 1) as f64)) * DVec3::new(u(0.618), u(0.414), u(0.732));
                let position = Position::new(at, dims);
                let (cell, block) = (position.even_cell(), position.block(3));
                let (found, whole) = (some.value(&cell), all.value(&cell));
                let [low, high] = ranges.ranges()[block[0] + blocks[0] * (block[1] + blocks[1] * block[2])];
                let off = Steps::RELATIVE_ERROR * largest;
                assert!((low - off..=high + off).contains(&whole), "{dims:?} at {at}: {whole} not in [{low}, {high}]");
                let expected = if is_read(block) { whole } else { 0.0 };
                assert_eq!(found, expected, "{dims:?} at {at}, block {block:?}");
                kept += usize::from(is_read(block));
            }
            assert!(kept > 2000, "{dims:?}: {kept} places in bricks");
        }
    }
}
