//! How the integral of a piece is shared out to its nodes.

use super::light::{Finish, LIGHTS};
use super::nodes::{AtNodes, NODES, PLACES, WEIGHTS, brightest};
use crate::integrate::exact::linear::Linear;
use crate::integrate::exact::piece::{Integral, Optics};
use crate::math::bernstein::{self, sum};
use crate::math::each;
use crate::simd::Lanes;

/// Of a medium with the optical depth `τ`, the rule finds the mean of the places that are seen less than `c τ⁴` of a piece too
/// far, and never more than its first node lies behind the front; `c` holds the range of the nodes against that of the piece.
const SHIFT_PER_DEPTH: f64 = 1e-6;
const LARGEST_SHIFT: f64 = 0.06;

impl<L: Lanes> Finish<L> for AtNodes<'_, L> {
    #[inline(always)]
    fn finish<const N: usize, const M: usize>(&self, optics: &Optics<L, N>, length_mm: L) -> Integral<L> {
        let number = L::from_f64;
        let unlit = optics.integrate(length_mm);
        let mut transmitted = [L::ONE; NODES];
        for i in 0..NODES {
            let mut depth = L::ZERO;
            for k in 0..N {
                depth = optics.extinction[k].mul_plus(number(table::<N>().integrals[i][k]), depth);
            }
            transmitted[i] = number(WEIGHTS[i]) * (L::ONE - (length_mm * depth).absorbed());
        }
        let absorbed = shares(&optics.extinction, &transmitted, unlit.absorbed);
        let mut radiance = [L::ZERO; 3];
        for c in 0..3 {
            let emitted = shares(&optics.emission[c], &transmitted, unlit.radiance[c]);
            radiance[c] = number(self.lighting.ambient) * unlit.radiance[c];
            for (n, color) in self.lighting.colors.iter().enumerate().take(LIGHTS) {
                radiance[c] = dot_nodes(&emitted, &self.lambert[n]).mul_plus(number(f64::from(color[c])), radiance[c]);
            }
        }
        let brightest_unlit = unlit.radiance[0].max(unlit.radiance[1]).max(unlit.radiance[2]);
        let mut drift = L::ZERO;
        for (n, color) in self.lighting.colors.iter().enumerate().take(LIGHTS) {
            if self.lighting.specular != 0.0 {
                let gloss = dot_nodes(&absorbed, &self.gloss[n]);
                for c in 0..3 {
                    radiance[c] = gloss.mul_plus(number(f64::from(color[c])), radiance[c]);
                }
            }
            let varies = brightest_unlit * range(&self.lambert[n]) + unlit.absorbed * range(&self.gloss[n]);
            drift = varies.mul_plus(number(brightest(color)), drift);
        }
        let depth = length_mm * (number(1.0 / N as f64) * sum(&optics.extinction));
        Integral { radiance, error: self.error(&unlit, depth, drift), ..unlit }
    }

    /// As [`finish`](Self::finish). What is shared out to node `i` is `α t_i + β t_i d_i`, with the same `t_i` and `d_i` for all channels and
    /// for extinction, so that sums over nodes are made once: of `t_i` and of `t_i d_i`, and of both with each light.
    #[inline(always)]
    fn finish_linear(&self, linear: &Linear<L>, length_mm: L) -> Integral<L> {
        let number = L::from_f64;
        let unlit = linear.integrate(length_mm);
        let (mut seen, mut seen_distance) = ([L::ZERO; NODES], [L::ZERO; NODES]);
        for i in 0..NODES {
            let (mut distance, mut so_far) = (L::ZERO, L::ZERO);
            for k in 0..4 {
                distance = linear.distance[k].mul_plus(number(table::<4>().values[i][k]), distance);
                so_far = linear.distance[k].mul_plus(number(table::<4>().integrals[i][k]), so_far);
            }
            let depth = linear.slope[3].mul_plus(so_far, linear.low[3] * number(PLACES[i]));
            seen[i] = number(WEIGHTS[i]) * (L::ONE - (length_mm * depth).absorbed());
            seen_distance[i] = seen[i] * distance;
        }
        let (all, all_distance) = (sum(&seen), sum(&seen_distance));
        // Of each component, one over what is shared out; 0 for none.
        let per_total: [L; 4] = each(
            #[inline(always)]
            |c| {
                let total = linear.low[c].mul_plus(all, linear.slope[c] * all_distance);
                L::select(L::ZERO.lt(total), L::ONE / total, L::ZERO)
            },
        );
        let mean = Mean { linear, seen, seen_distance, per_total };
        let mut lit = Lit { factors: [number(self.lighting.ambient); 3], shine: [L::ZERO; 3], drift: L::ZERO };
        // One by one, as the lights' terms are.
        if let Some(color) = self.lighting.colors.first() {
            self.add(&mut lit, color, &self.lambert[0], &self.gloss[0], &mean, &unlit);
        }
        if let Some(color) = self.lighting.colors.get(1) {
            self.add(&mut lit, color, &self.lambert[1], &self.gloss[1], &mean, &unlit);
        }
        let mut radiance = unlit.radiance;
        for c in 0..3 {
            radiance[c] = lit.factors[c].mul_plus(radiance[c], lit.shine[c]);
        }
        let depth = length_mm * linear.at(3, linear.mean_distance());
        Integral { radiance, error: self.error(&unlit, depth, lit.drift), ..unlit }
    }
}

/// What lights do to a piece.
struct Lit<L> {
    /// Of the emission.
    factors: [L; 3],
    /// Light that is added.
    shine: [L; 3],
    /// By how much the light may change where it is seen elsewhere.
    drift: L,
}

impl<L: Lanes> AtNodes<'_, L> {
    /// Adds a light.
    #[inline(always)]
    fn add(
        &self,
        lit: &mut Lit<L>,
        color: &[f32; 3],
        lambert: &[L; NODES],
        gloss: &[L; NODES],
        mean: &Mean<'_, L>,
        unlit: &Integral<L>,
    ) {
        let sums = mean.sums(lambert);
        for c in 0..3 {
            let lambert = mean.of(c, &sums, self.lighting.diffuse);
            lit.factors[c] = lambert.mul_plus(L::splat(color[c]), lit.factors[c]);
        }
        let [red, green, blue] = unlit.radiance;
        let mut varies = red.max(green).max(blue) * range(lambert);
        if self.lighting.specular != 0.0 {
            let shine = unlit.absorbed * mean.of(3, &mean.sums(gloss), self.lighting.specular);
            for c in 0..3 {
                lit.shine[c] = shine.mul_plus(L::splat(color[c]), lit.shine[c]);
            }
            varies = unlit.absorbed.mul_plus(range(gloss), varies);
        }
        lit.drift = varies.mul_plus(L::from_f64(brightest(color)), lit.drift);
    }

    /// The error of a shaded piece that is so deep, by what its unshaded integral may miss, and by how much its light may change if
    /// seen elsewhere.
    #[inline(always)]
    fn error(&self, unlit: &Integral<L>, depth: L, drift: L) -> L {
        // Where little gets through, the nodes lie behind what is seen.
        let square = depth * depth;
        let shift = (L::from_f64(SHIFT_PER_DEPTH) * square * square).min(L::from_f64(LARGEST_SHIFT));
        shift.mul_plus(drift, L::from_f64(self.lighting.largest_reflected) * unlit.error)
    }
}

/// Means of factors at nodes over what is shared out to them.
struct Mean<'p, L> {
    linear: &'p Linear<L>,
    seen: [L; NODES],
    seen_distance: [L; NODES],
    per_total: [L; 4],
}

impl<L: Lanes> Mean<'_, L> {
    /// Sums of a factor over the nodes.
    #[inline(always)]
    fn sums(&self, at: &[L; NODES]) -> [L; 2] {
        [dot_nodes(&self.seen, at), dot_nodes(&self.seen_distance, at)]
    }

    /// The mean of a factor of these sums over a component. What is next to nothing may round to anything, but not to more than there
    /// is.
    #[inline(always)]
    fn of(&self, component: usize, [sum, sum_distance]: &[L; 2], largest: f64) -> L {
        let total = self.linear.low[component].mul_plus(*sum, self.linear.slope[component] * *sum_distance);
        (total * self.per_total[component]).max(L::ZERO).min(L::from_f64(largest))
    }
}

/// How much a factor differs between nodes.
#[inline(always)]
fn range<L: Lanes>(at: &[L; NODES]) -> L {
    let [low, high] = bernstein::range(at);
    high - low
}

#[inline(always)]
fn dot_nodes<L: Lanes>(a: &[L; NODES], b: &[L; NODES]) -> L {
    let mut sum = a[0] * b[0];
    for i in 1..NODES {
        sum = a[i].mul_plus(b[i], sum);
    }
    sum
}

/// What is shared out to the nodes: by the values of a polynomial there, times what is transmitted.
#[inline(always)]
fn shares<L: Lanes, const N: usize>(polynomial: &[L; N], transmitted: &[L; NODES], all: L) -> [L; NODES] {
    let mut found = [L::ZERO; NODES];
    for i in 0..NODES {
        for k in 0..N {
            found[i] = polynomial[k].mul_plus(L::from_f64(table::<N>().values[i][k]), found[i]);
        }
        found[i] = transmitted[i] * found[i];
    }
    let total = sum(&found);
    let scale = L::select(L::ZERO.lt(total), all / total, L::ZERO);
    for share in &mut found {
        *share = scale * *share;
    }
    found
}

/// Bernstein polynomials at the nodes, and their integrals up to the nodes.
struct NodeTable<const N: usize> {
    values: [[f64; N]; NODES],
    integrals: [[f64; N]; NODES],
}

#[inline(always)]
const fn table<const N: usize>() -> &'static NodeTable<N> {
    const { &NodeTable::<N>::new() }
}

impl<const N: usize> NodeTable<N> {
    const fn new() -> Self {
        let mut found = NodeTable { values: [[0.0; N]; NODES], integrals: [[0.0; N]; NODES] };
        let mut i = 0;
        while i < NODES {
            // Raised from degree to degree: B(k, n) = (1 − u) B(k, n−1) + u B(k−1, n−1).
            let u = PLACES[i];
            let mut b = [0.0; 16];
            b[0] = 1.0;
            let mut degree = 0;
            while degree < N {
                if degree == N - 1 {
                    let mut k = 0;
                    while k < N {
                        found.values[i][k] = b[k];
                        k += 1;
                    }
                }
                let mut k = degree + 1;
                while k > 0 {
                    b[k] = (1.0 - u) * b[k] + u * b[k - 1];
                    k -= 1;
                }
                b[0] *= 1.0 - u;
                degree += 1;
            }
            // ∫₀^u B(k, n) = Σ_{j > k} B(j, n+1) / (n + 1).
            let mut k = 0;
            while k < N {
                let mut sum = 0.0;
                let mut j = k + 1;
                while j <= N {
                    sum += b[j];
                    j += 1;
                }
                found.integrals[i][k] = sum / N as f64;
                k += 1;
            }
            i += 1;
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::bernstein::value;

    #[test]
    fn bernstein_polynomials_are_tabulated() {
        for i in 0..NODES {
            for (k, &found) in table::<4>().values[i].iter().enumerate() {
                let mut one = [0.0; 4];
                one[k] = 1.0;
                let expected = value(&one, PLACES[i]);
                assert!((found - expected).abs() < 1e-15, "B{k} at node {i}: {found}, expected {expected}");
                let (found, steps) = (table::<4>().integrals[i][k], 10_000);
                let at = |s: usize| value(&one, (s as f64 + 0.5) / steps as f64 * PLACES[i]);
                let expected = (0..steps).map(at).sum::<f64>() / steps as f64 * PLACES[i];
                assert!((found - expected).abs() < 1e-8, "∫B{k} to node {i}: {found}, expected {expected}");
            }
        }
    }
}
