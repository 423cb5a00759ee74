//! Which cells may show something, a bit for each: rays pass most cells for nothing, and a bit is read sooner than eight corners.

use rayon::prelude::*;

use super::function::Function;
use super::voxels::{Ranges, Voxels};
use crate::field::Voxel;
use crate::integrate::occupancy::{LOG2_BLOCK, Occupancy};
use crate::simd::{BATCH, Ints, Kernel, Lanes, Level, Mask, Pairs};

/// Planes whose bits begin with a byte, whatever the lattice.
const PLANES: usize = u8::BITS as usize;

/// A bit for each cell, by the place in memory of its lower corner: whether the values at its corners leave room for something to show.
#[derive(Debug, Clone)]
pub(in crate::integrate::exact) struct LitCells {
    /// Three bytes more than there are, so that four can be read at any of them.
    bits: Vec<u8>,
}

impl LitCells {
    /// Those of the blocks in which something may show, found in parallel.
    pub(in crate::integrate::exact) fn new<V: Voxel + Pairs, const F: usize>(
        voxels: &Voxels<'_, V>,
        occupancy: &Occupancy,
        function: &(impl Function<F> + Sync),
        level: Level,
    ) -> Self {
        let [nx, ny, nz] = voxels.dims();
        let mut bits = vec![0; (nx * ny * nz).div_ceil(PLANES) + 3];
        bits.par_chunks_mut(nx * ny).enumerate().for_each(|(n, bits)| {
            level.run(Slab { voxels, occupancy, function, first: n * PLANES, bits });
        });
        LitCells { bits }
    }

    /// The lit ones of some cells, by the places of their lower corners.
    #[inline(always)]
    pub(super) fn among<L: Lanes>(&self, cells: L::Mask, base: L::Ints) -> L::Mask {
        let none = L::Ints::splat(0);
        // Where no ray passes a cell, memory is left alone.
        let base = L::Ints::select(cells, base, none);
        let byte = L::Ints::bytes(&self.bits, base.shifted_right(PLANES.ilog2()));
        let bit = base.and(L::Ints::splat(PLANES as i32 - 1)).power_of_two();
        cells.and_not(byte.and(bit).eq(none))
    }
}

/// Some planes of cells, whose bits are to be set.
struct Slab<'s, 'a, V, T, const F: usize> {
    voxels: &'s Voxels<'a, V>,
    occupancy: &'s Occupancy,
    function: &'s T,
    /// The first plane.
    first: usize,
    bits: &'s mut [u8],
}

impl<V: Voxel + Pairs, T: Function<F>, const F: usize> Kernel for Slab<'_, '_, V, T, F> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Slab { voxels, occupancy, function, first, bits } = self;
        let [nx, ny, nz] = voxels.dims();
        let cells = |block: usize, n: usize| block << LOG2_BLOCK..((block + 1) << LOG2_BLOCK).min(n - 1);
        let mut ranges = Ranges::new();
        for block_k in first >> LOG2_BLOCK..(first + PLANES).min(nz - 1).div_ceil(1 << LOG2_BLOCK) {
            for block_j in 0..(ny - 1).div_ceil(1 << LOG2_BLOCK) {
                for span in occupancy.spans([block_j, block_k], BATCH >> LOG2_BLOCK) {
                    let span = span.start..span.end.min(nx - 1);
                    for (k, j) in cells(block_k, nz).flat_map(|k| cells(block_j, ny).map(move |j| (k, j))) {
                        voxels.ranges_of_cells([j, k], span.clone(), &mut ranges);
                        let at = span.start + nx * (j + ny * (k - first));
                        for cell in (0..span.len()).step_by(L::LANES) {
                            let dark = function.is_dark(L::load(&ranges.low[cell..]), L::load(&ranges.high[cell..]));
                            let lanes = L::LANES.min(span.len() - cell);
                            set(bits, at + cell, !dark.bits() & ((1 << lanes) - 1));
                        }
                    }
                }
            }
        }
    }
}

/// Sets those of the bits from number `at` on that are set in a mask of as many as a register has lanes.
#[inline(always)]
fn set(bits: &mut [u8], at: usize, mask: u32) {
    let mask = mask << (at % PLANES);
    for (byte, of_mask) in bits[at / PLANES..].iter_mut().zip(mask.to_le_bytes()).take(1 + BATCH / PLANES) {
        *byte |= of_mask;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::{Baked, Classifier, OneD, bake};
    use crate::integrate::exact::stream::OfValue;
    use crate::transfer::{Curve, Knot, Optics, Term, TransferFunction};
    use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};
    use glam::DVec3;

    /// Two shapes with a gap between them, the second with a jump.
    fn function() -> OneD<f32> {
        let knot = |value, extinction| Knot { value, optics: Optics::colored(extinction, [1.0; 3]) };
        let curve = |knots| Term { curve: Curve::new(knots).unwrap(), weight: None };
        let tent = curve(vec![knot(100.0, 0.0), knot(200.0, 1.0), knot(300.0, 0.0)]);
        let step = curve(vec![knot(700.0, 0.0), knot(700.0, 2.0), knot(800.0, 0.0)]);
        let function = TransferFunction::new([-200.0, 1200.0], 1.0, vec![tent, step]).unwrap();
        let Baked::OneD(baked) = bake::<f32>(&function, Rescale::IDENTITY) else { unreachable!("of the value alone") };
        baked
    }

    /// A wave that passes through all values, the longer the flatter.
    fn volume(dims: [usize; 3], length: f64) -> Volume {
        let grid = Grid::axis_aligned(dims, DVec3::ONE).unwrap();
        let sample = |n: usize| {
            let at = DVec3::from_array(grid.unflatten(n).map(|i| i as f64)) / length;
            (500.0 + 490.0 * (at.x + (at.y * 1.3).sin() + at.z * 0.7).sin()) as i16
        };
        let samples = (0..grid.voxel_count()).map(sample).collect();
        Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap()
    }

    /// The lit ones among all cells of some lanes' width.
    struct Among<'a>(&'a LitCells, usize);

    impl Kernel for Among<'_> {
        type Output = Vec<bool>;

        #[inline(always)]
        fn run<L: Lanes>(self) -> Vec<bool> {
            let of = |first: usize| {
                let base = L::Ints::count() + L::Ints::splat(first as i32);
                let bits = self.0.among::<L>(base.lt(L::Ints::splat(self.1 as i32)), base).bits();
                (0..L::LANES.min(self.1 - first)).map(move |k| bits >> k & 1 == 1)
            };
            (0..self.1).step_by(L::LANES).flat_map(of).collect()
        }
    }

    #[test]
    fn a_cell_is_lit_if_its_corners_leave_room_for_something_to_show() {
        let classifier = function();
        let function = OfValue::new(&classifier);
        for (dims, length) in [([37, 22, 19], 9.0), ([64, 9, 17], 40.0), ([2, 2, 2], 1.0), ([130, 3, 2], 3.0)] {
            let volume = volume(dims, length);
            let Samples::I16(samples) = volume.samples() else { unreachable!("as it was made") };
            let voxels = Voxels::new(&volume, samples).unwrap();
            let [nx, ny, nz] = dims;
            let is_lit = |base: usize| {
                let cell = [base % nx, base / nx % ny, base / (nx * ny)];
                let is_cell = (0..3).all(|a| cell[a] + 1 < dims[a]);
                let corner = |c: usize| f32::from(samples[base + (c & 1) + nx * (c >> 1 & 1) + nx * ny * (c >> 2)]);
                let ends = || (0..8).map(corner).fold([f32::MAX, f32::MIN], |[l, h], s| [l.min(s), h.max(s)]);
                is_cell && !classifier.is_empty(ends(), [0.0, 0.0])
            };
            let expected: Vec<bool> = (0..nx * ny * nz).map(is_lit).collect();
            let lit = expected.iter().filter(|&&lit| lit).count();
            assert!(dims[0] == 2 || (lit > 100 && lit < expected.len() * 9 / 10), "{dims:?}: {lit} lit cells");
            let shows = |range| !classifier.is_empty(range, [0.0, 0.0]);
            for occupancy in [voxels.occupancy(shows), Occupancy::full(dims)] {
                for level in Level::ALL {
                    let cells = LitCells::new(&voxels, &occupancy, &function, level);
                    let found = level.run(Among(&cells, expected.len()));
                    let other = found.iter().zip(&expected).position(|(found, expected)| found != expected);
                    assert_eq!(other, None, "{dims:?}, {level}");
                }
            }
        }
    }
}
