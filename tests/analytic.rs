//! Tests of analytic.
