//! The truth in f64: slow, adaptive, and sharing nothing with the integrators but definitions.
