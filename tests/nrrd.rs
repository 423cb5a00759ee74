//! Tests of nrrd.
