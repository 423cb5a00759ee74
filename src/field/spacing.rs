//! How slices follow each other along k: evenly, or by a table. Kernels are generic over it, so that an even lattice pays
//! nothing for those that are not.

use super::Cell;
use super::position::Position;
use crate::volume::Slices;

/// How slices follow each other along k.
pub trait Spacing: Copy + Send + Sync {
    /// True if cell `k` is the whole part of the position.
    const EVEN: bool;

    /// The cell of a position, and where in it.
    fn cell(&self, position: Position) -> Cell;

    /// One over the distance between two slices, per step of the grid's affine; 1 for the same.
    fn per_step(&self, before: usize, after: usize) -> f32;

    /// Twice [`Spacing::per_step`] between the neighbours of an inner slice: what half a difference is multiplied by.
    fn central(&self, slice: usize) -> f32;
}

/// Slices one step apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Even;

impl Spacing for Even {
    const EVEN: bool = true;

    #[inline(always)]
    fn cell(&self, position: Position) -> Cell {
        position.even_cell()
    }

    #[inline(always)]
    fn per_step(&self, before: usize, after: usize) -> f32 {
        // Two steps, one, or none, where the difference is 0.
        if after - before == 2 { 0.5 } else { 1.0 }
    }

    #[inline(always)]
    fn central(&self, _: usize) -> f32 {
        1.0
    }
}

/// Slices at the places of a table.
#[derive(Debug, Clone, Copy)]
pub struct Uneven<'s> {
    table: &'s SliceTable,
}

/// [`Slices`] as kernels read them: positions in fixed point, so that a sample is on one side of a slice, never on both.
#[derive(Debug, Clone, PartialEq)]
pub struct SliceTable {
    /// Position of each slice, as [`Position`]s hold it.
    fixed: Vec<i64>,
    /// One over the height of each cell, in the same unit.
    per_height: Vec<f32>,
    /// The cell that holds each whole position: a search begins there and ends at the next one's.
    cell_at_step: Vec<usize>,
    positions: Vec<f64>,
}

impl SliceTable {
    /// The table of these slices.
    pub fn new(slices: &Slices) -> Self {
        let positions = slices.positions().to_vec();
        let fixed: Vec<i64> = positions.iter().map(|&p| Position::fixed(p)).collect();
        let per_height = fixed.windows(2).map(|pair| (1.0 / (pair[1] - pair[0]) as f64) as f32).collect();
        let last_cell = fixed.len() - 2;
        let holding = |step: usize| fixed[1..=last_cell].partition_point(|&face| face <= Position::fixed(step as f64));
        let cell_at_step = (0..fixed.len()).map(holding).collect();
        SliceTable { fixed, per_height, cell_at_step, positions }
    }

    /// The spacing that reads this table.
    pub fn spacing(&self) -> Uneven<'_> {
        Uneven { table: self }
    }
}

/// The largest f32 below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

impl Spacing for Uneven<'_> {
    const EVEN: bool = false;

    #[inline(always)]
    fn cell(&self, position: Position) -> Cell {
        let SliceTable { fixed, per_height, cell_at_step, .. } = self.table;
        let mut cell = position.even_cell();
        let (step, at) = (cell.corner[2], position.along_k());
        let (first, last) = (cell_at_step[step], cell_at_step[step + 1]);
        let k = first + fixed[first + 1..=last].partition_point(|&face| face <= at);
        cell.corner[2] = k;
        cell.fraction[2] = ((at - fixed[k]) as f32 * per_height[k]).min(BELOW_ONE);
        cell
    }

    #[inline(always)]
    fn per_step(&self, before: usize, after: usize) -> f32 {
        let positions = &self.table.positions;
        if before == after { 1.0 } else { (1.0 / (positions[after] - positions[before])) as f32 }
    }

    #[inline(always)]
    fn central(&self, slice: usize) -> f32 {
        2.0 * self.per_step(slice - 1, slice + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn the_table_finds_the_cell_of_any_position() {
        for places in [
            &[0.0, 0.1, 0.15, 2.9, 3.0, 3.01, 6.0][..],
            &[0.0, 5.0],
            &[0.0, 1.0, 2.0, 3.0],
            &[0.0, 9.0, 9.5, 9.9, 10.0],
        ] {
            let slices = Slices::new(places).unwrap();
            let table = SliceTable::new(&slices);
            let p = slices.positions();
            let n = p.len();
            for i in 0..=3000 {
                let at = f64::from(i) / 3000.0 * (n - 1) as f64;
                let cell = table.spacing().cell(Position::new(DVec3::new(0.0, 0.0, at), [1, 1, n]));
                let k = cell.corner[2];
                assert!(p[k] - 1e-9 <= at && at <= p[k + 1] + 1e-9, "{places:?}: {at} in cell {k}");
                let found = p[k] + f64::from(cell.fraction[2]) * (p[k + 1] - p[k]);
                assert!((found - at).abs() < 2e-7 * (1.0 + p[k + 1] - p[k]), "{places:?}: found {found} for {at}");
                assert!((0.0..1.0).contains(&cell.fraction[2]), "{places:?}: fraction {}", cell.fraction[2]);
            }
        }
    }

    #[test]
    fn an_even_table_is_the_even_spacing() {
        let slices = Slices::new(&[0.0, 2.0, 4.0, 6.0, 8.0]).unwrap();
        let table = SliceTable::new(&slices);
        for i in 0..1000 {
            let position = Position::new(DVec3::new(0.3, 0.7, 0.004 * f64::from(i)), [3, 3, 5]);
            let (found, expected) = (table.spacing().cell(position), Even.cell(position));
            assert_eq!(found.corner, expected.corner, "{position:?}");
            assert!((found.fraction[2] - expected.fraction[2]).abs() < 2e-7, "{position:?}: {found:?}");
        }
        for k in 1..4 {
            assert_eq!(table.spacing().central(k), Even.central(k));
            assert_eq!(table.spacing().per_step(k - 1, k), Even.per_step(k - 1, k));
        }
    }
}
