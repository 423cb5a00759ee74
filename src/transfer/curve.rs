//! Piecewise linear functions with jumps: optics along the value axis, weights along the gradient axis.

use super::Optics;
use crate::error::{Error, Fault, Result};

/// From which side a limit is taken at a knot where the function jumps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Limit from below.
    Left,
    /// Limit from above; the value of the function at an interior jump.
    Right,
}

/// One knot of a [`Curve`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// Position on the value axis, HU.
    pub value: f64,
    /// σ and q there.
    pub optics: Optics,
}

/// Optics as a piecewise linear function of the value, constant before the first and after the last knot.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    knots: Vec<Knot>,
}

/// A weight as a piecewise linear function of the gradient magnitude, constant before the first and after the last
/// knot.
#[derive(Debug, Clone, PartialEq)]
pub struct Weight {
    knots: Vec<[f64; 2]>,
}

impl Curve {
    /// A curve through `knots`, in any order: they are sorted (stably), and of several at one position the first and the
    /// last remain, which is a jump.
    ///
    /// # Errors
    /// `Fault::Spec` for no knots, a number that is not finite, or negative optics.
    pub fn new(mut knots: Vec<Knot>) -> Result<Self> {
        for knot in &knots {
            let Optics { extinction_per_mm: s, emission_per_mm: [r, g, b] } = knot.optics;
            if !knot.value.is_finite() || [s, r, g, b].iter().any(|x| !x.is_finite() || *x < 0.0) {
                return Err(Error::new(Fault::Spec, "a knot of a transfer function is not usable")
                    .found(format!("value {}, extinction {s}/mm, emission ({r}, {g}, {b})/mm", knot.value))
                    .expected("finite numbers, and optics of at least 0"));
            }
        }
        sort_and_keep_jumps(&mut knots, |k| k.value)?;
        Ok(Curve { knots })
    }

    /// The knots, ascending; two at one position are a jump.
    pub fn knots(&self) -> &[Knot] {
        &self.knots
    }

    /// Positions of the knots, ascending, a jump twice.
    pub fn positions(&self) -> impl Iterator<Item = f64> + '_ {
        self.knots.iter().map(|k| k.value)
    }

    /// The optics at `value`; `side` matters at a jump only.
    pub fn at(&self, value: f64, side: Side) -> Optics {
        match locate(&self.knots, value, side, |k| k.value) {
            Place::Knot(i) => self.knots[i].optics,
            Place::Between(i, u) => {
                let Knot { optics: a, .. } = self.knots[i];
                let Knot { optics: b, .. } = self.knots[i + 1];
                Optics::NOTHING.plus(1.0 - u, a).plus(u, b)
            }
        }
    }
}

impl Weight {
    /// A weight through `[gradient_per_mm, weight]` knots, sorted as those of a [`Curve`].
    ///
    /// # Errors
    /// `Fault::Spec` for no knots, a number that is not finite, or a negative weight.
    pub fn new(mut knots: Vec<[f64; 2]>) -> Result<Self> {
        if let Some([g, w]) = knots.iter().find(|[g, w]| !g.is_finite() || !w.is_finite() || *w < 0.0) {
            return Err(Error::new(Fault::Spec, "a knot of a gradient weight is not usable")
                .found(format!("weight {w} at {g} HU/mm"))
                .expected("finite numbers, and weights of at least 0"));
        }
        sort_and_keep_jumps(&mut knots, |k| k[0])?;
        Ok(Weight { knots })
    }

    /// The knots `[gradient_per_mm, weight]`, ascending; two at one position are a jump.
    pub fn knots(&self) -> &[[f64; 2]] {
        &self.knots
    }

    /// Positions of the knots, ascending, a jump twice.
    pub fn positions(&self) -> impl Iterator<Item = f64> + '_ {
        self.knots.iter().map(|k| k[0])
    }

    /// The weight at a gradient magnitude; `side` matters at a jump only.
    pub fn at(&self, gradient_per_mm: f64, side: Side) -> f64 {
        match locate(&self.knots, gradient_per_mm, side, |k| k[0]) {
            Place::Knot(i) => self.knots[i][1],
            Place::Between(i, u) => (1.0 - u) * self.knots[i][1] + u * self.knots[i + 1][1],
        }
    }
}

fn sort_and_keep_jumps<K: Copy>(knots: &mut Vec<K>, position: impl Fn(&K) -> f64) -> Result<()> {
    if knots.is_empty() {
        return Err(Error::new(Fault::Spec, "a transfer function has no knots").expected("at least one"));
    }
    knots.sort_by(|a, b| position(a).total_cmp(&position(b)));
    let mut kept: Vec<K> = Vec::with_capacity(knots.len());
    for &knot in knots.iter() {
        let here = position(&knot);
        let same = kept.iter().rev().take_while(|k| position(k) == here).count();
        if same == 2 {
            kept.pop();
        }
        kept.push(knot);
    }
    *knots = kept;
    Ok(())
}

enum Place {
    Knot(usize),
    Between(usize, f64),
}

/// Where `x` lies among ascending knots: at one, or the fraction `u` from knot `i` to `i + 1`.
fn locate<K>(knots: &[K], x: f64, side: Side, position: impl Fn(&K) -> f64) -> Place {
    let after = match side {
        Side::Left => knots.partition_point(|k| position(k) < x),
        Side::Right => knots.partition_point(|k| position(k) <= x),
    };
    match after {
        0 => Place::Knot(0),
        n if n == knots.len() => Place::Knot(n - 1),
        n => {
            let (a, b) = (position(&knots[n - 1]), position(&knots[n]));
            Place::Between(n - 1, (x - a) / (b - a))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unsorted_and_duplicate_knots_become_a_sorted_curve_with_a_jump() {
        let weight = Weight::new(vec![[10.0, 1.0], [0.0, 0.0], [10.0, 7.0], [10.0, 3.0], [20.0, 3.0]]).unwrap();
        assert_eq!(weight.knots(), [[0.0, 0.0], [10.0, 1.0], [10.0, 3.0], [20.0, 3.0]]);
        assert_eq!(weight.at(10.0, Side::Left), 1.0);
        assert_eq!(weight.at(10.0, Side::Right), 3.0);
        assert_eq!(weight.at(5.0, Side::Right), 0.5);
        assert_eq!(weight.at(-1.0, Side::Right), 0.0);
        assert_eq!(weight.at(99.0, Side::Right), 3.0);
    }

    #[test]
    fn one_knot_is_a_constant() {
        let weight = Weight::new(vec![[5.0, 0.25]]).unwrap();
        for g in [-1.0, 5.0, 9.0] {
            assert_eq!(weight.at(g, Side::Left), 0.25);
            assert_eq!(weight.at(g, Side::Right), 0.25);
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused() {
        assert!(Weight::new(vec![]).is_err());
        assert!(Weight::new(vec![[0.0, f64::NAN]]).is_err());
        assert!(Weight::new(vec![[f64::INFINITY, 1.0]]).is_err());
        assert!(Curve::new(vec![Knot { value: 0.0, optics: Optics::colored(-1.0, [0.0; 3]) }]).is_err());
    }
}
