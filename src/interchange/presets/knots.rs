//! Knots, inserted until lines between them are close enough, and what close means.

use crate::error::{Error, Fault, Result};
use crate::image::srgb;
use crate::transfer::Optics;

/// What a slab of one unit distance does: its opacity, and the light it sends, linear and premultiplied.
pub(super) type Slab = [f64; 4];

/// The slab of an extinction and emission over `length_mm`.
pub(super) fn slab_of(optics: Optics, length_mm: f64) -> Slab {
    let Optics { extinction_per_mm: sigma, emission_per_mm: [r, g, b] } = optics;
    let opacity = -(-sigma * length_mm).exp_m1();
    // Emission follows extinction, so light is opacity times the straight colour q/σ.
    let light = |q: f64| if sigma > 0.0 { q / sigma * opacity } else { 0.0 };
    [opacity, light(r), light(g), light(b)]
}

/// The slab of an opacity and a colour in sRGB numbers.
pub(super) fn slab_of_srgb(opacity: f64, color: [f64; 3]) -> Slab {
    let [r, g, b] = color.map(|c| srgb::decode(c) * opacity);
    [opacity, r, g, b]
}

/// The largest difference of slabs of two media, of any length from 1/64 to 1024 times the unit: those and each twice as long as
/// the one before. What is off by a share of its extinction is most off where the optical depth is 1, wherever that is.
pub(super) fn difference_of_media(a: Optics, b: Optics, unit_mm: f64) -> f64 {
    let lengths_mm = (-6..=10).map(|exponent| unit_mm * 2f64.powi(exponent));
    lengths_mm.map(|length_mm| difference(slab_of(a, length_mm), slab_of(b, length_mm))).fold(0.0, f64::max)
}

/// The largest difference of two slabs.
pub(super) fn difference(a: Slab, b: Slab) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// Lines that stand in for something curved.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Refined {
    /// Positions of the knots, ascending.
    pub(super) positions: Vec<f64>,
    /// The largest deviation found.
    pub(super) max_deviation: f64,
}

/// Intervals into which a piece between knots is divided to measure how far its line is off.
const INTERVALS: usize = 64;

/// Share of the bound that what is measured may take; the rest is for what lies between.
const SHARE: f64 = 0.9;

/// Knots that nobody could want for one curve.
const MOST_KNOTS: usize = 4096;

/// Halves the pieces between `breaks` until none deviates by more than `bound`. `deviation(piece, t)` is that at the share
/// `t` of the way along a piece, with limits from within the piece at its ends.
///
/// # Errors
/// `Fault::Spec` if that takes more than 4096 knots.
pub(super) fn refine(breaks: &[f64], bound: f64, deviation: impl Fn([f64; 2], f64) -> f64) -> Result<Refined> {
    let mut positions: Vec<f64> = breaks.first().copied().into_iter().collect();
    let mut max_deviation = 0.0f64;
    let mut open: Vec<[f64; 2]> = breaks.windows(2).rev().map(|pair| [pair[0], pair[1]]).collect();
    while let Some(piece) = open.pop() {
        let [a, b] = piece;
        let middle = middle(a, b);
        // Neighbouring numbers, as a jump is written in some formats: nothing lies between them.
        let worst = match middle {
            Some(_) => (0..=INTERVALS).map(|i| deviation(piece, i as f64 / INTERVALS as f64)).fold(0.0, f64::max),
            None => 0.0,
        };
        match middle {
            Some(middle) if worst > SHARE * bound => open.extend([[middle, b], [a, middle]]),
            _ => {
                max_deviation = max_deviation.max(worst);
                positions.push(b);
            }
        }
        if positions.len() + open.len() > MOST_KNOTS {
            return Err(Error::new(Fault::Spec, "the bound takes too many knots")
                .found(bound.to_string())
                .expected(format!("one that {MOST_KNOTS} knots can keep"))
                .remedy("raise --max-deviation"));
        }
    }
    Ok(Refined { positions, max_deviation })
}

/// A number near the middle with few digits, since people read presets.
fn middle(a: f64, b: f64) -> Option<f64> {
    let middle = 0.5 * (a + b);
    let digits = -((b - a) / 50.0).log10().floor();
    // Beyond that, a power of ten has no exact inverse to round by.
    let short = if digits.abs() <= 15.0 { (middle * 10f64.powf(digits)).round() / 10f64.powf(digits) } else { middle };
    [short, middle].into_iter().find(|m| a < *m && *m < b)
}

/// To six significant digits, for numbers that people read.
pub(super) fn short(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parabola([a, b]: [f64; 2], t: f64) -> f64 {
        let x = a + t * (b - a);
        ((1.0 - t) * a * a + t * b * b - x * x).abs()
    }

    #[test]
    fn a_bound_is_kept_with_few_knots() {
        let refined = refine(&[0.0, 1.0], 1e-3, parabola).unwrap();
        assert!(refined.max_deviation <= 1e-3, "found {}", refined.max_deviation);
        // Lines over a parabola of pieces h are off by h²/4, and what is measured may take 0.9 of the bound.
        assert_eq!(refined.positions.len(), 33, "found {:?}", refined.positions);
        assert!(refine(&[0.0, 1.0], 1e-9, parabola).is_err(), "more than 4096 knots");
    }

    #[test]
    fn a_line_needs_none_and_a_jump_no_more() {
        let line = refine(&[-1000.0, 152.19, 278.93], 1e-3, |_, _| 0.0).unwrap();
        assert_eq!(line.positions, [-1000.0, 152.19, 278.93]);
        let jump = refine(&[1.0, 1f64.next_up()], 1e-3, |_, _| 1.0).unwrap();
        assert_eq!(jump, Refined { positions: vec![1.0, 1f64.next_up()], max_deviation: 0.0 });
    }

    #[test]
    fn slabs_of_one_medium_agree() {
        let color = [0.25, 0.5, 0.75];
        let linear = color.map(srgb::decode);
        let optics = Optics::colored(-(1.0f64 - 0.3).ln() / 2.0, linear);
        let found = difference(slab_of(optics, 2.0), slab_of_srgb(0.3, color));
        assert!(found < 1e-15, "found {found}");
        assert!(difference(slab_of(optics, 1.0), slab_of_srgb(0.3, color)) > 0.1, "another length is another slab");
    }

    /// A share `e` more of an extinction is `e / exp(1)` of opacity at most, at the length at which the optical depth is 1.
    #[test]
    fn faint_media_differ_at_length() {
        for extinction_per_mm in [0.004, 0.05, 0.7] {
            let media = [1.0, 1.01].map(|share| Optics::colored(share * extinction_per_mm, [1.0; 3]));
            let found = difference_of_media(media[0], media[1], 1.0);
            let expected = 0.01 / 1f64.exp();
            assert!((found / expected - 1.0).abs() < 0.07, "{extinction_per_mm}: found {found}, expected {expected}");
        }
    }
}
