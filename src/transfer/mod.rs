//! The transfer function: (value, gradient magnitude) → extinction and emission, exact in f64.
//!
//! **Definition.** A transfer function is a sum of [`Term`]s
//!
//! ```text
//! σ(v, g) = Σ_k  σ_k(v) · w_k(g)      extinction, 1/mm
//! q(v, g) = Σ_k  q_k(v) · w_k(g)      emission, 1/mm, linear RGB; usually q_k = σ_k c_k with a straight colour c_k
//! ```
//!
//! where `σ_k`, `q_k` and `w_k` are piecewise linear ([`Curve`], [`Weight`]). `v` is the value in HU and `g` the gradient
//! magnitude in HU/mm (Levoy 1988; Kniss, Kindlmann and Hansen 2002). So between neighbouring knots `σ` and `q` are
//! *bilinear* in `(v, g)`, which is what makes integration along a ray exact: see [`crate::integrate`].
//!
//! **Domain.** `v` is clamped to the window and `g` to `[0, gradient_range]`; at and beyond an end of the domain the
//! function takes its one-sided limit from inside. At a jump in the interior it is continuous from the right.
//!
//! **Attenuation** of X-rays, from CT numbers and a photon energy, becomes a curve in [`attenuation`].
//!
//! **Shapes** (rectangle, triangle, trapezoid, ellipse, Gaussian, Levoy's contours) and 1D point lists become terms in
//! [`shapes`]; where a shape is not a product of piecewise linear factors, knots are inserted to a stated bound,
//! and the function rendered is *defined* to be the terms.

pub mod attenuation;
mod curve;
pub mod shapes;

pub use curve::{Curve, Knot, Side, Weight};

use crate::error::{Error, Fault, Result};

/// Extinction and emission at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Optics {
    /// σ, 1/mm, at least 0.
    pub extinction_per_mm: f64,
    /// q, 1/mm, linear RGB, at least 0. The light added per mm; `q = σ c` for a straight colour `c` of what absorbs.
    pub emission_per_mm: [f64; 3],
}

impl Optics {
    /// Neither absorbs nor emits.
    pub const NOTHING: Optics = Optics { extinction_per_mm: 0.0, emission_per_mm: [0.0; 3] };

    /// What absorbs `extinction_per_mm` and looks `color` (straight, linear RGB in [0, 1]) when opaque.
    pub fn colored(extinction_per_mm: f64, color: [f64; 3]) -> Self {
        Optics { extinction_per_mm, emission_per_mm: color.map(|c| c * extinction_per_mm) }
    }

    /// The brightest channel of q over σ: 0 where nothing is emitted, infinite where something is that does not absorb.
    pub fn largest_color(&self) -> f64 {
        let brightest = self.emission_per_mm.into_iter().fold(0.0, f64::max);
        if brightest > 0.0 { brightest / self.extinction_per_mm } else { 0.0 }
    }

    /// `self + w · other`, component by component.
    #[must_use]
    pub fn plus(self, w: f64, other: Optics) -> Optics {
        let [r, g, b] = self.emission_per_mm;
        let [or, og, ob] = other.emission_per_mm;
        Optics {
            extinction_per_mm: self.extinction_per_mm + w * other.extinction_per_mm,
            emission_per_mm: [r + w * or, g + w * og, b + w * ob],
        }
    }
}

/// One product of the sum: optics along the value axis times a weight along the gradient axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// σ_k(v) and q_k(v).
    pub curve: Curve,
    /// w_k(g); `None` is 1 everywhere, which is a 1D transfer function.
    pub weight: Option<Weight>,
}

/// A transfer function with its domain. See the [module](self) for its definition.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferFunction {
    window: [f64; 2],
    gradient_range_per_mm: f64,
    terms: Vec<Term>,
}

impl TransferFunction {
    /// The sum of `terms` over the window `[low, high]` (HU) and gradient magnitudes up to `gradient_range_per_mm`
    /// (HU/mm).
    ///
    /// # Errors
    /// `Fault::Spec` for an empty or non-finite domain.
    pub fn new(window: [f64; 2], gradient_range_per_mm: f64, terms: Vec<Term>) -> Result<Self> {
        let [low, high] = window;
        if !(low.is_finite() && high.is_finite() && low < high) {
            return Err(Error::new(Fault::Spec, "the window of values is empty")
                .found(format!("[{low}, {high}]"))
                .expected("two finite numbers, the lower first"));
        }
        if !(gradient_range_per_mm.is_finite() && gradient_range_per_mm > 0.0) {
            return Err(Error::new(Fault::Spec, "the range of gradient magnitudes is empty")
                .found(gradient_range_per_mm.to_string())
                .expected("a finite number above 0"));
        }
        Ok(TransferFunction { window, gradient_range_per_mm, terms })
    }

    /// Lower and upper end of the domain along the value axis.
    pub fn window(&self) -> [f64; 2] {
        self.window
    }

    /// Upper end of the domain along the gradient axis, HU/mm.
    pub fn gradient_range_per_mm(&self) -> f64 {
        self.gradient_range_per_mm
    }

    /// The terms of the sum.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// On the same domain, 0 everywhere.
    #[must_use]
    pub fn without_terms(&self) -> Self {
        TransferFunction { terms: Vec::new(), ..*self }
    }

    /// True if some term depends on the gradient magnitude; if not, nobody need compute it.
    pub fn reads_gradient(&self) -> bool {
        self.terms.iter().any(|t| t.weight.is_some())
    }

    /// σ and q at a value and gradient magnitude.
    pub fn evaluate(&self, value: f64, gradient_per_mm: f64) -> Optics {
        let [low, high] = self.window;
        let value_side = if value >= high { Side::Left } else { Side::Right };
        let gradient_side = if gradient_per_mm >= self.gradient_range_per_mm { Side::Left } else { Side::Right };
        let v = value.clamp(low, high);
        let g = gradient_per_mm.clamp(0.0, self.gradient_range_per_mm);
        self.evaluate_side(v, value_side, g, gradient_side)
    }

    /// One-sided limit of σ and q; arguments inside the domain. Evaluating from inside a patch of [`Self::value_knots`] ×
    /// [`Self::gradient_knots`] gives the corners of the bilinear function there.
    pub fn evaluate_side(&self, value: f64, value_side: Side, gradient_per_mm: f64, gradient_side: Side) -> Optics {
        self.terms.iter().fold(Optics::NOTHING, |sum, term| {
            let w = term.weight.as_ref().map_or(1.0, |w| w.at(gradient_per_mm, gradient_side));
            if w == 0.0 { sum } else { sum.plus(w, term.curve.at(value, value_side)) }
        })
    }

    /// σ and q at the corners of all patches, from each of their sides. Between knots both are bilinear, so bounds that hold here
    /// hold everywhere.
    pub fn corners(&self) -> impl Iterator<Item = Optics> {
        let sides = [
            (Side::Left, Side::Left),
            (Side::Left, Side::Right),
            (Side::Right, Side::Left),
            (Side::Right, Side::Right),
        ];
        let gradients = self.gradient_knots();
        let places =
            self.value_knots().into_iter().flat_map(move |v| gradients.clone().into_iter().map(move |g| (v, g)));
        places.flat_map(move |(v, g)| sides.map(|(v_side, g_side)| self.evaluate_side(v, v_side, g, g_side)))
    }

    /// The largest [`Optics::largest_color`].
    pub fn largest_color(&self) -> f64 {
        self.corners().map(|optics| optics.largest_color()).fold(0.0, f64::max)
    }

    /// Knots along the value axis, ascending, without duplicates; the first and last are the ends of the window.
    pub fn value_knots(&self) -> Vec<f64> {
        let inner = self.terms.iter().flat_map(|t| t.curve.positions());
        knots_within(self.window, inner)
    }

    /// Knots along the gradient axis, ascending, without duplicates, from 0 to the range.
    pub fn gradient_knots(&self) -> Vec<f64> {
        let inner = self.terms.iter().filter_map(|t| t.weight.as_ref()).flat_map(|w| w.positions());
        knots_within([0.0, self.gradient_range_per_mm], inner)
    }
}

fn knots_within([low, high]: [f64; 2], inner: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut knots: Vec<f64> = inner.filter(|&x| low < x && x < high).chain([low, high]).collect();
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    knots
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> TransferFunction {
        let knots = vec![
            Knot { value: 0.0, optics: Optics::NOTHING },
            Knot { value: 100.0, optics: Optics::colored(2.0, [1.0, 0.5, 0.0]) },
            Knot { value: 100.0, optics: Optics::colored(4.0, [0.0, 0.0, 1.0]) },
        ];
        let weight = Weight::new(vec![[0.0, 0.0], [10.0, 1.0]]).unwrap();
        let term = Term { curve: Curve::new(knots).unwrap(), weight: Some(weight) };
        TransferFunction::new([-50.0, 100.0], 20.0, vec![term]).unwrap()
    }

    #[test]
    fn value_and_weight_multiply() {
        let o = ramp().evaluate(50.0, 5.0);
        assert!((o.extinction_per_mm - 0.5).abs() < 1e-15, "half of half of 2: found {}", o.extinction_per_mm);
        assert_eq!(o.emission_per_mm, [0.5, 0.25, 0.0]);
    }

    #[test]
    fn the_end_of_the_window_is_the_limit_from_inside() {
        let tf = ramp();
        assert_eq!(tf.evaluate(100.0, 20.0).extinction_per_mm, 2.0, "the jump at the end belongs to the outside");
        assert_eq!(tf.evaluate(5000.0, 20.0).extinction_per_mm, 2.0, "beyond the window as at its end");
        assert_eq!(tf.evaluate(-5000.0, 20.0), Optics::NOTHING);
    }

    #[test]
    fn the_largest_color_is_that_of_a_corner_and_infinite_where_nothing_absorbs() {
        assert_eq!(ramp().largest_color(), 1.0, "red below the jump, blue above");
        let glow = Optics { extinction_per_mm: 0.0, emission_per_mm: [0.0, 0.25, 0.0] };
        let knots = [(0.0, Optics::NOTHING), (100.0, glow)].map(|(value, optics)| Knot { value, optics });
        let term = Term { curve: Curve::new(knots.to_vec()).unwrap(), weight: None };
        let tf = TransferFunction::new([-50.0, 100.0], 20.0, vec![term]).unwrap();
        assert_eq!(tf.largest_color(), f64::INFINITY);
        assert_eq!(tf.without_terms().largest_color(), 0.0, "nothing shines");
    }

    #[test]
    fn knots_cover_the_domain_once() {
        assert_eq!(ramp().value_knots(), [-50.0, 0.0, 100.0]);
        assert_eq!(ramp().gradient_knots(), [0.0, 10.0, 20.0]);
        assert!(ramp().reads_gradient());
    }
}
