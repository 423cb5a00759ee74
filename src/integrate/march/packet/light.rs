//! Light gathered along rays in lanes, front to back.
//!
//! With `x = σΔ` an interval absorbs the share `A = 1 − e^{−x}` of the light from behind and adds `q Δ A/x`, both computed in f32,
//! accurate relative to themselves, as by [`composite`](super::super::composite). Sums are compensated for what rounding takes from
//! each step: in f32 alone intervals of opacity 1e-8 would leave a transmittance of 1 however many there are. A sample in which
//! nothing shows leaves every bit as it was, so that leaping over it changes nothing.

use crate::simd::Lanes;

/// A sum, and what rounding took from it (Kahan 1965).
#[derive(Debug, Clone, Copy)]
struct Sum<L> {
    sum: L,
    rest: L,
}

impl<L: Lanes> Sum<L> {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Sum { sum: L::from_f64(x), rest: L::ZERO }
    }

    /// Adds `x`, with `rest` instead of what rounding took before.
    #[inline(always)]
    fn plus(self, x: L, rest: L) -> Self {
        let x = x + rest;
        let sum = self.sum + x;
        Sum { sum, rest: x - (sum - self.sum) }
    }

    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Sum { sum: L::select(mask, yes.sum, no.sum), rest: L::select(mask, yes.rest, no.rest) }
    }

    /// The numbers of all lanes.
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let mut parts = [[0.0; crate::simd::BATCH]; 2];
        self.sum.store(&mut parts[0]);
        self.rest.store(&mut parts[1]);
        for (k, to) in to[..L::LANES].iter_mut().enumerate() {
            *to = f64::from(parts[0][k]) + f64::from(parts[1][k]);
        }
    }
}

/// Light of as many pieces of rays as a register has lanes.
pub(super) struct Light<L> {
    color: [Sum<L>; 3],
    transmittance: Sum<L>,
}

impl<L: Lanes> Light<L> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Light { color: [Sum::splat(0.0); 3], transmittance: Sum::splat(1.0) }
    }

    /// Begins new pieces.
    #[inline(always)]
    pub(super) fn begin(&mut self, beginning: L::Mask) {
        let Light { color, transmittance } = Light::new();
        for c in 0..3 {
            self.color[c] = Sum::select(beginning, color[c], self.color[c]);
        }
        self.transmittance = Sum::select(beginning, transmittance, self.transmittance);
    }

    /// What is let through from behind.
    #[inline(always)]
    pub(super) fn transmittance(&self) -> L {
        self.transmittance.sum
    }

    /// Adds light that reaches the eye.
    #[inline(always)]
    pub(super) fn add(&mut self, lit: L::Mask, light: [L; 3]) {
        for c in 0..3 {
            let before = self.color[c];
            self.color[c] = Sum::select(lit, before.plus(light[c], before.rest), before);
        }
    }

    /// Loses a share of what comes from behind.
    #[inline(always)]
    pub(super) fn absorb(&mut self, lit: L::Mask, opacity: L) {
        let before = self.transmittance;
        let after = before.plus(-(before.sum * opacity), before.rest.minus_product(before.rest, opacity));
        self.transmittance = Sum::select(lit, after, before);
    }

    /// Colours and transmittances of all lanes.
    #[inline(always)]
    pub(super) fn store(&self, to: &mut [[f64; crate::simd::BATCH]; 4]) {
        let [red, green, blue, transmittance] = to;
        self.color[0].store(red);
        self.color[1].store(green);
        self.color[2].store(blue);
        self.transmittance.store(transmittance);
    }
}

/// What intervals of these lengths absorb of the light from behind, and what their emission is multiplied by.
#[inline(always)]
pub(super) fn interval<L: Lanes>(extinction: L, delta_mm: L) -> (L, L) {
    let (absorbed, mean_transmittance) = (extinction * delta_mm).absorbed_and_mean_transmittance();
    (absorbed, delta_mm * mean_transmittance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::BATCH;

    /// Colour and transmittance after so many samples of this emission and extinction.
    fn after(samples: impl IntoIterator<Item = [f32; 2]>, delta_mm: f32) -> [f64; 2] {
        let mut light = Light::<f32>::new();
        for [emission, extinction] in samples {
            let (opacity, weight) = interval(extinction, delta_mm);
            light.add(true, [light.transmittance() * weight * emission, 0.0, 0.0]);
            light.absorb(true, opacity);
        }
        let mut all = [[0.0; BATCH]; 4];
        light.store(&mut all);
        [all[0][0], all[3][0]]
    }

    #[test]
    fn emission_without_absorption_adds_up() {
        assert_eq!(after([[0.25, 0.0]; 8], 0.5), [1.0, 1.0], "q L, and nothing absorbed");
        assert_eq!(after([[0.25, 1e-42]; 8], 0.5)[0], 1.0, "an extinction whose square vanishes");
    }

    #[test]
    fn many_thin_intervals_absorb() {
        for (count, opacity) in [(100_000, 1e-5f32), (1_000_000, 1e-8)] {
            let [color, transmittance] = after(std::iter::repeat_n([opacity; 2], count), 1.0);
            let expected = -(-f64::from(opacity) * count as f64).exp_m1();
            let apart = (1.0 - transmittance) / expected - 1.0;
            assert!(apart.abs() < 1e-6, "{count} of opacity {opacity:e}: {apart:e} from {expected}, relatively");
            assert!((color + transmittance - 1.0).abs() < 1e-6, "what is absorbed is emitted again: {color}");
        }
    }

    #[test]
    fn an_enormous_extinction_is_opaque_and_no_nan() {
        assert_eq!(after([[1e30, 1e30], [5.0, 1e30]], 10.0), [1.0, 0.0]);
    }

    #[test]
    fn what_is_not_lit_keeps_its_bits() {
        let mut light = Light::<f32>::new();
        light.add(true, [0.1; 3]);
        light.absorb(true, 0.3);
        let (mut before, mut found) = ([[0.0; BATCH]; 4], [[0.0; BATCH]; 4]);
        light.store(&mut before);
        light.add(false, [f32::NAN; 3]);
        light.absorb(false, f32::NAN);
        light.store(&mut found);
        assert_eq!(found, before);
    }
}
