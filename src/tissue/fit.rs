//! Widgets proposed from a scan whose labels are known.
//!
//! Of all rectangles over value and gradient magnitude, the one with the highest Dice, found exactly: Dice `2P / (C + L)` is a
//! ratio, and its maximum is where `2P − λ (C + L)` has the maximum 0 (Dinkelbach 1967). For a given λ each bin adds
//! `2 of_tissue − λ voxels`, and the rectangle with the largest sum is that of Kadane's algorithm over the value, for each range
//! of gradients (Bentley 1984). A second rectangle is found the same way, outside of the first.

use std::collections::BTreeMap;

use serde::Serialize;

use super::Mask;
use super::histogram::{BIN_GRADIENT_PER_MM, BIN_VALUE, Bin, Histogram};
use crate::error::{Error, Fault, Result};
use crate::volume::Volume;

/// A second rectangle must raise Dice by this much.
const WORTH_A_RECTANGLE: f64 = 0.002;

/// A region over value and gradient magnitude that a tissue takes up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Proposal {
    /// From which value (HU) to which.
    pub value: [f64; 2],
    /// From which gradient magnitude (HU/mm) to which; `None` for no upper end.
    pub gradient_per_mm: (f64, Option<f64>),
    /// Dice of this region and those before it, on this scan.
    pub dice: f64,
}

impl Proposal {
    /// As a trapezoid whose edges are half way up at the ends of the region: `hu` and `gradient_hu_per_mm`.
    pub fn trapezoid(&self) -> ([f64; 4], [f64; 4]) {
        let [low, high] = self.value;
        let (from, to) = self.gradient_per_mm;
        let (v, g) = (BIN_VALUE, BIN_GRADIENT_PER_MM / 2.0);
        let rise = if from > 0.0 { [from - g, from + g] } else { [0.0, 0.0] };
        let fall = to.map_or([NO_CEILING, NO_CEILING], |to| [to - g, to + g]);
        ([low - v, low + v, high - v, high + v], [rise[0], rise[1], fall[0], fall[1]])
    }
}

/// A gradient magnitude above any that the transfer function tells apart.
const NO_CEILING: f64 = 3000.0;

/// One or two regions for a mask: the best rectangle, and one more if it is worth it.
///
/// # Errors
/// `Fault::Geometry` if mask and volume differ in their number of voxels, `Fault::Input` for a mask that is empty.
pub fn fit(volume: &Volume, mask: &Mask) -> Result<Vec<Proposal>> {
    let histogram = Histogram::new(volume, mask)?;
    let mut table = Table::new(&histogram).ok_or_else(|| {
        Error::new(Fault::Input, "there is no voxel of the tissue to learn from").expected("labels that have some")
    })?;
    let mut proposals: Vec<Proposal> = Vec::new();
    for _ in 0..2 {
        let before = proposals.last().map_or(0.0, |proposal| proposal.dice);
        let (rectangle, dice) = table.best(before);
        if dice < before + WORTH_A_RECTANGLE {
            break;
        }
        proposals.push(table.proposal(rectangle, dice));
        table.take(rectangle);
    }
    Ok(proposals)
}

/// First and last bin along value and gradient.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Rectangle {
    value: [usize; 2],
    gradient: [usize; 2],
}

/// The histogram as a table over the values that the tissue has, and what is taken already.
struct Table {
    first_value: i32,
    /// By gradient, then by value.
    rows: Vec<Vec<Bin>>,
    of_tissue: u64,
    taken: Bin,
}

impl Table {
    fn new(histogram: &Histogram) -> Option<Self> {
        let of_tissue = || histogram.bins().filter(|(_, bin)| bin.of_tissue > 0).map(|((value, _), _)| value);
        let (first_value, last_value) = (of_tissue().min()?, of_tissue().max()?);
        // Values far apart would make a table of empty bins; tissues span a few thousand HU.
        let width = usize::try_from(i64::from(last_value) - i64::from(first_value)).ok().filter(|w| *w < 1 << 16)? + 1;
        let mut rows: BTreeMap<u16, Vec<Bin>> = BTreeMap::new();
        for ((value, gradient), bin) in histogram.bins().filter(|((v, _), _)| (first_value..=last_value).contains(v)) {
            let row = rows.entry(gradient).or_insert_with(|| vec![Bin::default(); width]);
            row[(value - first_value) as usize] = bin;
        }
        let last_gradient = *rows.keys().max()?;
        let row = |gradient| rows.get(&gradient).cloned().unwrap_or_else(|| vec![Bin::default(); width]);
        let rows = (0..=last_gradient).map(row).collect();
        Some(Table { first_value, rows, of_tissue: histogram.of_tissue(), taken: Bin::default() })
    }

    /// The best rectangle together with what is taken, and its Dice; begins from a Dice that is reached already.
    fn best(&self, mut dice: f64) -> (Rectangle, f64) {
        loop {
            let rectangle = self.largest_sum(dice);
            let Bin { voxels, of_tissue } = self.within(rectangle);
            let inside = (of_tissue + self.taken.of_tissue) as f64;
            let better = 2.0 * inside / (voxels + self.taken.voxels + self.of_tissue) as f64;
            if better <= dice + 1e-12 {
                return (rectangle, dice);
            }
            dice = better;
        }
    }

    /// The rectangle with the largest sum of `2 of_tissue − λ voxels`.
    fn largest_sum(&self, lambda: f64) -> Rectangle {
        let width = self.rows[0].len();
        let mut best = (f64::NEG_INFINITY, Rectangle { value: [0, 0], gradient: [0, 0] });
        for from in 0..self.rows.len() {
            let mut columns = vec![0.0; width];
            for to in from..self.rows.len() {
                for (column, bin) in columns.iter_mut().zip(&self.rows[to]) {
                    *column += 2.0 * bin.of_tissue as f64 - lambda * bin.voxels as f64;
                }
                let (sum, value) = largest_run(&columns);
                if sum > best.0 {
                    best = (sum, Rectangle { value, gradient: [from, to] });
                }
            }
        }
        best.1
    }

    fn within(&self, Rectangle { value, gradient }: Rectangle) -> Bin {
        let bins = self.rows[gradient[0]..=gradient[1]].iter().flat_map(|row| &row[value[0]..=value[1]]);
        bins.fold(Bin::default(), |sum, bin| Bin {
            voxels: sum.voxels + bin.voxels,
            of_tissue: sum.of_tissue + bin.of_tissue,
        })
    }

    /// Takes a rectangle out of the table.
    fn take(&mut self, rectangle: Rectangle) {
        let Bin { voxels, of_tissue } = self.within(rectangle);
        self.taken.voxels += voxels;
        self.taken.of_tissue += of_tissue;
        let Rectangle { value, gradient } = rectangle;
        self.rows[gradient[0]..=gradient[1]].iter_mut().for_each(|row| row[value[0]..=value[1]].fill(Bin::default()));
    }

    fn proposal(&self, Rectangle { value, gradient }: Rectangle, dice: f64) -> Proposal {
        let at = |bin: usize| (f64::from(self.first_value) + bin as f64) * BIN_VALUE;
        let last = gradient[1] + 1 == self.rows.len();
        Proposal {
            value: [at(value[0]), at(value[1] + 1)],
            gradient_per_mm: (
                gradient[0] as f64 * BIN_GRADIENT_PER_MM,
                (!last).then(|| (gradient[1] + 1) as f64 * BIN_GRADIENT_PER_MM),
            ),
            dice,
        }
    }
}

/// The run of neighbours with the largest sum, first and last (Kadane).
fn largest_run(numbers: &[f64]) -> (f64, [usize; 2]) {
    let mut best = (f64::NEG_INFINITY, [0, 0]);
    let (mut sum, mut first) = (0.0, 0);
    for (n, number) in numbers.iter().enumerate() {
        if sum <= 0.0 {
            (sum, first) = (0.0, n);
        }
        sum += number;
        if sum > best.0 {
            best = (sum, [first, n]);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_rectangle_is_better() {
        let mut state = 3_u64;
        let mut next = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        for case in 0..30 {
            let mut bin = || {
                let voxels = next(9);
                Bin { voxels, of_tissue: next(voxels + 1) }
            };
            let rows: Vec<Vec<Bin>> = (0..5).map(|_| (0..6).map(|_| bin()).collect()).collect();
            let of_tissue = rows.iter().flatten().map(|bin| bin.of_tissue).sum();
            let table = Table { first_value: 0, rows, of_tissue, taken: Bin::default() };
            let mut expected = 0.0_f64;
            for (from, to) in (0..5).flat_map(|from| (from..5).map(move |to| (from, to))) {
                for (low, high) in (0..6).flat_map(|low| (low..6).map(move |high| (low, high))) {
                    let bin = table.within(Rectangle { value: [low, high], gradient: [from, to] });
                    expected = expected.max(2.0 * bin.of_tissue as f64 / (bin.voxels + of_tissue) as f64);
                }
            }
            let (_, found) = table.best(0.0);
            assert!((found - expected).abs() < 1e-12, "case {case}: found {found}, expected {expected}");
        }
    }

    #[test]
    fn edges_are_half_way_up_at_the_ends() {
        let proposal = Proposal { value: [90.0, 200.0], gradient_per_mm: (5.0, None), dice: 1.0 };
        assert_eq!(proposal.trapezoid(), ([80.0, 100.0, 190.0, 210.0], [2.5, 7.5, 3000.0, 3000.0]));
    }
}
