//! Tests of march.
