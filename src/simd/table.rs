//! Small tables that lanes look up, each its own entry.

/// A table of numbers for [`Lanes::pick`](super::Lanes::pick), padded so that whole registers of it can be read.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    entries: Vec<f32>,
}

impl Table {
    /// Entries of the widest register: tables of so many, or twice as many, are looked up without touching memory.
    pub(super) const REGISTER: usize = super::BATCH;

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
