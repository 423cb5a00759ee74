//! Which tissues of labels and reference are compared.

use crate::error::{Error, Fault, Result};
use crate::spec::{LabelRange, ReferenceTissues};
use crate::tissue::Pair;
use crate::volume::LabelMap;

/// Pairs of tissues: by a table; without one, by equal names, or, where no name is the same, by equal labels. Tissues of a
/// table that `labels` does not have are left out.
///
/// # Errors
/// `Fault::Spec` for a table without a tissue of the labels, `Fault::Input` where nothing is the same without a table.
pub fn pairs(labels: &LabelMap, reference: &LabelMap, table: Option<&ReferenceTissues>) -> Result<Vec<Pair>> {
    let names = || labels.segments().iter().map(|segment| segment.name.as_str()).collect::<Vec<_>>().join(", ");
    if let Some(table) = table {
        let pairs: Vec<Pair> = by_table(labels, reference, table);
        return match (pairs.is_empty(), table.tissues().next()) {
            (false, _) => Ok(pairs),
            (true, first) => Err(table
                .error(first.map_or("", |(name, _)| name), "no tissue of the table is in the labels")
                .expected(format!("some of {}", names()))),
        };
    }
    let by = |same: &dyn Fn(usize, usize) -> bool| -> Vec<Pair> {
        let of = |n: usize| {
            let other = (0..reference.segments().len()).find(|m| same(n, *m))?;
            Some(Pair {
                tissue: labels.segments()[n].name.clone(),
                label: position(n),
                reference: vec![position(other)],
            })
        };
        (0..labels.segments().len()).filter_map(of).collect()
    };
    let pairs = by(&|n, m| labels.segments()[n].name == reference.segments()[m].name);
    let pairs =
        if pairs.is_empty() { by(&|n, m| labels.segments()[n].label == reference.segments()[m].label) } else { pairs };
    if pairs.is_empty() {
        return Err(Error::new(Fault::Input, "labels and reference have neither a name nor a label in common")
            .found(names())
            .remedy("say with --map which labels of the reference make up which tissue"));
    }
    Ok(pairs)
}

/// Positions in `reference` of the labels that make up a tissue of a table.
///
/// # Errors
/// `Fault::Spec` for a tissue that the table does not have.
pub fn positions(reference: &LabelMap, table: &ReferenceTissues, tissue: &str) -> Result<Vec<u8>> {
    match table.tissues().find(|(name, _)| *name == tissue) {
        Some((_, ranges)) => Ok(within(reference, ranges)),
        None => {
            let names: Vec<&str> = table.tissues().map(|(name, _)| name).collect();
            let error = table.error("", "the table does not have this tissue").found(tissue);
            Err(error.expected(format!("one of {}", names.join(", "))))
        }
    }
}

fn within(reference: &LabelMap, ranges: &[LabelRange]) -> Vec<u8> {
    let wanted = |label: u16| ranges.iter().any(|range| (range.first..=range.last).contains(&label));
    let segments = reference.segments().iter().enumerate();
    segments.filter(|(_, segment)| wanted(segment.label)).map(|(m, _)| position(m)).collect()
}

fn by_table(labels: &LabelMap, reference: &LabelMap, table: &ReferenceTissues) -> Vec<Pair> {
    let pair = |(tissue, ranges): (&str, &[LabelRange])| {
        let label = labels.position_of(tissue)?;
        Some(Pair { tissue: tissue.to_owned(), label, reference: within(reference, ranges) })
    };
    table.tissues().filter_map(pair).collect()
}

/// Position counted from 1; a label map has at most 255 segments.
fn position(n: usize) -> u8 {
    (n + 1) as u8
}
