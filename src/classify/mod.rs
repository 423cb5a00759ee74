//! The transfer function baked for kernels: (stored value, gradient magnitude) → emission and extinction.
//!
//! Between knots a transfer function is bilinear (see [`crate::transfer`]), so baking it needs no sampled table: the knots
//! of all terms cut the domain into intervals ([`OneD`]) or patches ([`TwoD`]), each holds the coefficients of its
//! (bi)linear function, and evaluating one is exact up to rounding. The value axis is in *stored* units, so kernels never
//! rescale a sample.

mod axis;
mod lanes;
mod one_d;
mod table;
mod texture;
mod two_d;

pub use axis::Axis;
pub use one_d::{Linear, OneD};
pub use table::Tabulated;
pub use texture::{StepOpacity, Texture};
pub use two_d::{Bilinear, TwoD};

pub(crate) use lanes::{LaneClassifier, OneDColumns, TwoDColumns};

use crate::math::Real;
use crate::transfer::{Optics, TransferFunction};
use crate::volume::Rescale;

/// Emission (linear RGB) and extinction at a sample, `[q_r, q_g, q_b, σ]`, 1/mm.
pub type Rgbs<R> = [R; 4];

/// Looks up a transfer function. Chosen by type, once per frame.
pub trait Classifier<R: Real>: Sync {
    /// Whether the second argument of [`Classifier::classify`] matters.
    const READS_GRADIENT: bool;

    /// Emission and extinction for a stored value and a gradient magnitude in HU/mm.
    fn classify(&self, stored: R, gradient_per_mm: R) -> Rgbs<R>;

    /// True if nothing absorbs or emits for any value and gradient magnitude in these closed ranges `[low, high]`.
    fn is_empty(&self, stored: [R; 2], gradient_per_mm: [R; 2]) -> bool;
}

/// A baked transfer function.
#[derive(Debug, Clone)]
pub enum Baked<R> {
    /// Value alone.
    OneD(OneD<R>),
    /// Value and gradient magnitude.
    TwoD(TwoD<R>),
}

impl<R: Real> Baked<R> {
    /// As [`Classifier::is_empty`].
    pub fn is_empty(&self, stored: [R; 2], gradient_per_mm: [R; 2]) -> bool {
        match self {
            Baked::OneD(c) => c.is_empty(stored, gradient_per_mm),
            Baked::TwoD(c) => c.is_empty(stored, gradient_per_mm),
        }
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        match self {
            Baked::OneD(c) => c.bytes(),
            Baked::TwoD(c) => c.bytes(),
        }
    }
}

/// Bakes a transfer function for samples with this rescale.
pub fn bake<R: Real>(transfer_function: &TransferFunction, rescale: Rescale) -> Baked<R> {
    if transfer_function.reads_gradient() {
        Baked::TwoD(TwoD::bake(transfer_function, rescale))
    } else {
        Baked::OneD(OneD::bake(transfer_function, rescale))
    }
}

/// Several baked transfer functions, all of the same kind.
#[derive(Debug, Clone)]
pub enum BakedAlike<R> {
    /// Value alone.
    OneD(Vec<OneD<R>>),
    /// Value and gradient magnitude.
    TwoD(Vec<TwoD<R>>),
}

/// Bakes transfer functions for samples with this rescale: all by value and gradient magnitude if one of them needs it.
pub fn bake_alike<R: Real>(transfer_functions: &[TransferFunction], rescale: Rescale) -> BakedAlike<R> {
    if transfer_functions.iter().any(TransferFunction::reads_gradient) {
        BakedAlike::TwoD(transfer_functions.iter().map(|f| TwoD::bake(f, rescale)).collect())
    } else {
        BakedAlike::OneD(transfer_functions.iter().map(|f| OneD::bake(f, rescale)).collect())
    }
}

/// Width of the narrowest interval between knots of a transfer function baked in f64, over the largest magnitude of a knot on
/// its axis.
pub fn narrowest(transfer_function: &TransferFunction, rescale: Rescale) -> f64 {
    let (values, _) = Axis::<f64>::bake(&transfer_function.value_knots(), |value| rescale.stored(value));
    if !transfer_function.reads_gradient() {
        return values.narrowest();
    }
    let (gradients, _) = Axis::<f64>::bake(&transfer_function.gradient_knots(), |gradient| gradient);
    values.narrowest().min(gradients.narrowest())
}

fn rgbs(optics: Optics) -> Rgbs<f64> {
    let [r, g, b] = optics.emission_per_mm;
    [r, g, b, optics.extinction_per_mm]
}
