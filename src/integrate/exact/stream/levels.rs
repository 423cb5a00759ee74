//! Where cubics turn, and where they take a level.

use crate::math::bernstein::Cubic;
use crate::math::powers::{self, Powers};
use crate::simd::{Lanes, Mask};

/// Iterations after which a crossing is not sought any further; bisection alone would be done by then.
const MOST_ITERATIONS: usize = 40;

/// How long the last step of the iteration for a crossing may be, in cells: Newton's iteration then doubles the digits once more.
///
/// Where the function jumps, nothing but rounding is good enough. Elsewhere a cut that is off by `u` leaves a value off its knot by
/// `u` times the slope, along `u` of the cell; half their product is at most 1.5 times the cube of the last step (the test below
/// holds it to that), in units of what the value changes by along the cell. The function may be steep there: by a depth of 100, did
/// the cell go on like that. So a cut is to cost a hundredth of the tolerance even then.
pub(super) fn precision(jumps: bool, tolerance: f64) -> f32 {
    const COARSEST: f64 = 1.0 / 32.0;
    if jumps { 0.5 * f32::EPSILON } else { (0.04 * tolerance.cbrt()).min(COARSEST) as f32 }
}

/// Where in `(0, 1)` the derivative vanishes, ascending; 1 where it does not.
#[inline(always)]
pub(super) fn critical_points<L: Lanes>(b: &Cubic<L>) -> [L; 2] {
    let (d0, d1, d2) = (b[1] - b[0], b[2] - b[1], b[3] - b[2]);
    // d(u) = d0 (1−u)² + 2 d1 u (1−u) + d2 u²  =  a u² + 2 h u + d0.
    let a = (d0 - d1) + (d2 - d1);
    let h = d1 - d0;
    let discriminant = (h * h).minus_product(a, d0);
    let root = discriminant.max(L::ZERO).sqrt();
    // The stable pair of roots: no difference of nearly equal numbers.
    let q = -(h + L::select(h.lt(L::ZERO), -root, root));
    // NaN from 0 / 0 compares as outside.
    let mut found = [d0 / q, q / a];
    for u in &mut found {
        let counts = is_between(*u, L::ZERO, L::ONE).and(L::ZERO.lt(discriminant));
        *u = L::select(counts, *u, L::ONE);
    }
    [found[0].min(found[1]), found[0].max(found[1])]
}

#[inline(always)]
fn is_between<L: Lanes>(u: L, low: L, high: L) -> L::Mask {
    low.lt(u).and(u.lt(high))
}

/// A stretch on which a cubic is monotone, and what it has above a level at the ends.
pub(super) struct Between<L> {
    pub(super) from: L,
    pub(super) to: L,
    pub(super) at_from: L,
    pub(super) at_to: L,
}

/// Where rising cubics take 0, as far as is known.
struct Bracket<L> {
    low: L,
    high: L,
}

impl<L: Lanes> Bracket<L> {
    #[inline(always)]
    fn middle(&self) -> L {
        L::from_f64(0.5) * (self.low + self.high)
    }

    /// A step of Newton's iteration, kept inside.
    #[inline(always)]
    fn newton(&mut self, cubic: &Powers<L>, u: L) -> L {
        let (miss, slope) = (powers::value(cubic, u), powers::slope(cubic, u));
        let beyond = L::ZERO.lt(miss);
        self.high = L::select(beyond, u, self.high);
        self.low = L::select(beyond, self.low, u);
        let next = u - miss / slope;
        // NaN and infinity from a flat place fail the comparison and bisect.
        L::select(self.low.le(next).and(next.le(self.high)), next, self.middle())
    }
}

/// Where monotone cubics take a level that lies between their values at the ends. Newton's iteration kept inside a shrinking
/// bracket, begun where the chord crosses, until a step is no longer than `precision`.
#[inline(always)]
pub(super) fn crossing<L: Lanes>(
    powers: &Powers<L>,
    level: L,
    rises: L::Mask,
    wanted: L::Mask,
    between: &Between<L>,
    precision: f32,
) -> L {
    let [c0, c1, c2, c3] = *powers;
    let mut above = [c0 - level, c1, c2, c3];
    for c in &mut above {
        // As if all rose.
        *c = L::select(rises, *c, -*c);
    }
    let mut bracket = Bracket { low: between.from, high: between.to };
    let Between { from, to, at_from, at_to } = *between;
    let chord = from + (to - from) * (at_from / (at_from - at_to));
    let precision = L::splat(precision);
    let mut u = L::select(is_between(chord, from, to), chord, bracket.middle());
    let mut open = wanted;
    for _ in 0..MOST_ITERATIONS {
        let next = bracket.newton(&above, u);
        let moved = precision.lt((next - u).abs());
        u = L::select(open, next, u);
        open = open.and(moved);
        if !open.any() {
            break;
        }
    }
    u
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::bernstein::value;

    /// Half of what a value at a cut misses its level by, times how far off the cut is: the largest, over the cube of
    /// the precision, for cubics from 0 to 1 at levels everywhere and next to where they turn.
    fn largest_miss(precision: f32) -> f64 {
        let mut most = 0.0f64;
        let mut found = 0;
        for n in 0..20_000 {
            let u = |k: f64| (f64::from(n) * k + 0.13).fract();
            let b = [u(0.618_034), u(0.414_214), u(0.732_051), u(0.236_068)];
            let single = b.map(|x| x as f32);
            let [first, second] = critical_points::<f32>(&single).map(f64::from);
            for [from, to] in [[0.0, first], [first, second], [second, 1.0]] {
                let share = [1e-4, 0.01, 0.3, 0.7, 0.99, 0.9999][n as usize % 6];
                let ends = [value(&b, from), value(&b, to)];
                let level = ends[0] + share * (ends[1] - ends[0]);
                if to - from < 1e-3 || (ends[1] - ends[0]).abs() < 1e-3 {
                    continue;
                }
                let rises = ends[0] < ends[1];
                let (mut low, mut high) = (from, to);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if (value(&b, middle) < level) == rises { low = middle } else { high = middle }
                }
                let above = |x: f64| (x - level) as f32;
                let [at_from, at_to] = ends.map(above);
                let between = Between { from: from as f32, to: to as f32, at_from, at_to };
                let cut = crossing(&powers::of(&single), level as f32, rises, true, &between, precision);
                let (off, value_off) = (f64::from(cut) - low, value(&b, f64::from(cut)) - level);
                most = most.max(0.5 * off.abs() * value_off.abs());
                found += 1;
            }
        }
        assert!(found > 15_000, "{found} crossings");
        most / f64::from(precision).powi(3)
    }

    #[test]
    fn a_cut_misses_little_more_than_the_cube_of_the_last_step() {
        for tolerance in [0.1, 1.0 / 255.0, 1e-4, 1e-5] {
            let miss = largest_miss(precision(false, tolerance));
            assert!(miss < 1.5, "tolerance {tolerance}: {miss} of the cube");
            assert!(miss > 1e-3, "tolerance {tolerance}: {miss} of the cube, so that steps could be longer");
        }
    }
}
