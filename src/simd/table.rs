//! Small tables that lanes look up, each its own entry.

use super::{BATCH, Lanes};
use crate::math::each;

/// A table of numbers for [`Lanes::pick`], padded so that whole registers of it can be read.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    entries: Vec<f32>,
}

impl Table {
    /// Entries of the widest register: tables of so many, or twice as many, are looked up without touching memory.
    pub(super) const REGISTER: usize = BATCH;

    /// A table of these entries, at least one. What lies beyond them is the last one.
    pub(crate) fn new(entries: &[f32]) -> Self {
        let last = *entries.last().expect("a table has entries");
        let mut padded = entries.to_vec();
        padded.resize(entries.len().next_multiple_of(Table::REGISTER), last);
        Table { entries: padded }
    }

    /// The entries, and what they are padded with; a multiple of [`Table::REGISTER`].
    #[inline(always)]
    pub(super) fn entries(&self) -> &[f32] {
        &self.entries
    }
}

/// Tables of as many entries each, looked up together.
#[derive(Debug, Clone)]
pub(crate) struct Tables<const N: usize> {
    /// The first entries of each, in a register.
    few: [[f32; BATCH]; N],
    are_few: bool,
    all: [Table; N],
}

impl<const N: usize> Tables<N> {
    /// Tables of the numbers of these entries, at least one.
    pub(crate) fn new(entries: &[[f32; N]]) -> Self {
        let last = entries.last().expect("a table has entries");
        Tables {
            few: each(|n| each(|k| entries.get(k).unwrap_or(last)[n])),
            are_few: entries.len() <= BATCH,
            all: std::array::from_fn(|n| Table::new(&entries.iter().map(|entry| entry[n]).collect::<Vec<f32>>())),
        }
    }

    /// The numbers of these entries; indices beyond the end give the last ones.
    #[inline(always)]
    pub(crate) fn pick<L: Lanes>(&self, at: L::Ints) -> [L; N] {
        if self.are_few {
            // Asked for once, not once a table.
            each(
                #[inline(always)]
                |n| L::pick16(&self.few[n], at),
            )
        } else {
            each(
                #[inline(always)]
                |n| L::pick(&self.all[n], at),
            )
        }
    }
}
