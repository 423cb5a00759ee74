//! A transfer function sampled into a table, as renderers on graphics hardware hold it.

use rayon::prelude::*;

use crate::error::{Error, Fault, Result};
use crate::transfer::TransferFunction;

/// A transfer function at equally spaced values and gradient magnitudes: straight colour and extinction.
///
/// Entry `(i, j)` is at the value `low + i · (high − low)/(values − 1)` and likewise along the gradient, so that the first
/// and the last entry are at the ends of the ranges. A *look-up* is another matter: graphics hardware takes entry `i` for
/// the middle of the `i`-th of as many equal parts of the range, so that what is looked up at a share `u` of the range is
/// at `u · values − 1/2` of the table, up to half an entry off.
///
/// Where nothing absorbs, the straight colour is that of the nearest value at which something does, lest interpolation
/// mixes black into the foot of a ramp.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    /// Entries along the value axis and along the gradient axis, which is 1 for a function of the value alone.
    pub size: [usize; 2],
    /// Value of the first and of the last entry.
    pub values: [f64; 2],
    /// Gradient magnitude of the first and of the last entry, HU/mm; `[0, 0]` for a function of the value alone.
    pub gradients_per_mm: [f64; 2],
    /// `[r, g, b, σ]`, value fastest: straight linear colour, and extinction per mm.
    pub entries: Vec<[f64; 4]>,
}

impl Tabulated {
    /// Samples a transfer function over these ranges; the gradient's is `None` for functions of the value alone.
    ///
    /// # Errors
    /// `Fault::Unsupported` for what emits light without absorbing any: it has no straight colour.
    pub fn new(
        transfer_function: &TransferFunction,
        value_entries: usize,
        values: [f64; 2],
        gradient: Option<(usize, [f64; 2])>,
    ) -> Result<Self> {
        let (gradient_entries, gradients_per_mm) = gradient.unwrap_or((1, [0.0; 2]));
        let place = |[low, high]: [f64; 2], i: usize, n: usize| low + (high - low) * (i as f64 / (n - 1).max(1) as f64);
        let mut rows: Vec<Vec<[f64; 4]>> = (0..gradient_entries)
            .into_par_iter()
            .map(|j| {
                let g = place(gradients_per_mm, j, gradient_entries);
                (0..value_entries).map(|i| straight(transfer_function, place(values, i, value_entries), g)).collect()
            })
            .collect::<Result<_>>()?;
        rows.par_iter_mut().for_each(|row| spread_colors(row));
        spread_rows(&mut rows);
        let entries = rows.into_iter().flatten().collect();
        Ok(Tabulated { size: [value_entries, gradient_entries], values, gradients_per_mm, entries })
    }
}

fn straight(transfer_function: &TransferFunction, value: f64, gradient_per_mm: f64) -> Result<[f64; 4]> {
    let optics = transfer_function.evaluate(value, gradient_per_mm);
    let extinction = optics.extinction_per_mm;
    if extinction > 0.0 {
        let [r, g, b] = optics.emission_per_mm.map(|q| q / extinction);
        return Ok([r, g, b, extinction]);
    }
    if optics.emission_per_mm == [0.0; 3] {
        return Ok([0.0; 4]);
    }
    Err(Error::new(Fault::Unsupported, "a table of straight colours cannot hold light from what does not absorb")
        .element("transfer_function")
        .found(format!("emission {:?} per mm without extinction at {value}", optics.emission_per_mm))
        .remedy("give the layer an opacity, or render without a table"))
}

/// Gives entries without extinction the colour of the nearest one with some.
fn spread_colors(row: &mut [[f64; 4]]) {
    let lit: Vec<usize> = (0..row.len()).filter(|&i| row[i][3] > 0.0).collect();
    for i in 0..row.len() {
        let after = lit.partition_point(|&l| l < i);
        let near = lit[after.saturating_sub(1)..].iter().take(2).min_by_key(|&&l| l.abs_diff(i));
        if let (Some(&near), true) = (near, row[i][3] == 0.0) {
            let [r, g, b, _] = row[near];
            row[i] = [r, g, b, 0.0];
        }
    }
}

/// Gives rows without any extinction the colours of the nearest row with some.
fn spread_rows(rows: &mut [Vec<[f64; 4]>]) {
    let lit: Vec<usize> = (0..rows.len()).filter(|&j| rows[j].iter().any(|e| e[3] > 0.0)).collect();
    for j in 0..rows.len() {
        let after = lit.partition_point(|&l| l < j);
        let near = lit[after.saturating_sub(1)..].iter().take(2).min_by_key(|&&l| l.abs_diff(j)).copied();
        if let Some(near) = near.filter(|&near| near != j) {
            rows[j] = rows[near].iter().map(|&[r, g, b, _]| [r, g, b, 0.0]).collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::{Curve, Knot, Optics, Term, Weight};

    fn function(weight: Option<Weight>) -> TransferFunction {
        let knot = |value, s, color| Knot { value, optics: Optics::colored(s, color) };
        let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
        let knots = vec![knot(20.0, 0.0, red), knot(40.0, 2.0, red), knot(60.0, 2.0, blue), knot(80.0, 0.0, blue)];
        let term = Term { curve: Curve::new(knots).unwrap(), weight };
        TransferFunction::new([0.0, 100.0], 50.0, vec![term]).unwrap()
    }

    #[test]
    fn entries_are_the_function_and_colours_go_on_where_nothing_absorbs() {
        let table = Tabulated::new(&function(None), 11, [0.0, 100.0], None).unwrap();
        let extinction: Vec<f64> = table.entries.iter().map(|e| e[3]).collect();
        assert_eq!(extinction, [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0]);
        assert_eq!(table.entries[0][..3], [1.0, 0.0, 0.0], "red below what is red");
        assert_eq!(table.entries[5][..3], [0.5, 0.0, 0.5], "half way between the colours");
        assert_eq!(table.entries[10][..3], [0.0, 0.0, 1.0], "blue above what is blue");
    }

    #[test]
    fn rows_without_extinction_have_the_colours_of_the_next() {
        let weight = Weight::new(vec![[10.0, 0.0], [20.0, 1.0]]).unwrap();
        let table = Tabulated::new(&function(Some(weight)), 6, [0.0, 100.0], Some((6, [0.0, 50.0]))).unwrap();
        assert_eq!(table.size, [6, 6]);
        assert_eq!(table.entries[2], [1.0, 0.0, 0.0, 0.0], "nothing absorbs at (40, 0)");
        assert_eq!(table.entries[2 + 2 * 6], [1.0, 0.0, 0.0, 2.0], "at (40, 20)");
    }

    #[test]
    fn light_from_nothing_has_no_straight_colour() {
        let glow = Optics { extinction_per_mm: 0.0, emission_per_mm: [0.1; 3] };
        let curve = Curve::new(vec![Knot { value: 0.0, optics: glow }]).unwrap();
        let glowing = TransferFunction::new([0.0, 1.0], 1.0, vec![Term { curve, weight: None }]).unwrap();
        assert!(Tabulated::new(&glowing, 4, [0.0, 1.0], None).is_err());
    }
}
