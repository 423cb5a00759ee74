//! The transfer function baked for kernels: (value, gradient magnitude) → emission and extinction, fast and without error
//! beyond f32 rounding.
