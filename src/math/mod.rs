//! Mathematics without a domain: real numbers in two precisions, polynomials in Bernstein form and by powers, stable exponentials.

mod absorb;
pub mod bernstein;
mod each;
mod number;
mod opacity;
mod power;
pub mod powers;
mod real;
pub mod scattering;

pub use absorb::{THIN, absorbed_f32, mean_transmittance_f32, mean_transmittance_of_thin};
pub use each::each;
pub use number::Number;
pub use opacity::extinction_per_mm;
pub use power::Power;
pub use real::Real;
