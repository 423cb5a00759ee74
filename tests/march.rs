//! Tests of marching, against a naive march in f64 and against itself where settings must not matter.

mod levels;
mod naive;
mod options;
pub(crate) mod scenes;
mod schedule;
mod stability;

pub(crate) use naive::march as naive_march;
