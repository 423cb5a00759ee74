//! Marches with one mistake each, and the checks that must find it.

use super::march::Reference;

/// No mistake.
pub(super) const REFERENCE: Reference = Reference {
    place: 0.5,
    skip_first: false,
    skip_last: false,
    opacity_of_mm: None,
    twice_weighted: false,
    shift_voxels: 0.0,
    bits: None,
};

/// A march with a mistake.
pub(super) struct Broken {
    pub(super) name: &'static str,
    pub(super) march: Reference,
    /// Names of checks that fail for it.
    pub(super) caught_by: &'static [&'static str],
}

const SMOOTH: &str = "order in the step, smooth";
const FINEST: &str = "error at 1/1024 of the cube";

pub(super) const MARCHES: [Broken; 8] = [
    Broken {
        name: "the first sample is left out",
        march: Reference { skip_first: true, ..REFERENCE },
        caught_by: &[SMOOTH, FINEST],
    },
    Broken {
        name: "the last sample is left out",
        march: Reference { skip_last: true, ..REFERENCE },
        caught_by: &[SMOOTH, FINEST],
    },
    Broken {
        name: "samples lie a tenth of a step from the middle",
        march: Reference { place: 0.6, ..REFERENCE },
        caught_by: &[SMOOTH, FINEST],
    },
    Broken {
        name: "opacity is not corrected for the step",
        march: Reference { opacity_of_mm: Some(1.0), ..REFERENCE },
        caught_by: &[SMOOTH, FINEST, "absorption only: T = exp(-∫σ)"],
    },
    Broken {
        name: "straight colour is weighted by opacity twice",
        march: Reference { twice_weighted: true, ..REFERENCE },
        caught_by: &[SMOOTH, FINEST, "one colour c: C = c (1 - T)"],
    },
    Broken {
        name: "the field is half a voxel away",
        march: Reference { shift_voxels: 0.5, ..REFERENCE },
        caught_by: &[SMOOTH, FINEST, "2 to 33 points a side of a trilinear field", "order in the lattice's spacing"],
    },
    Broken {
        name: "8 bits are kept between samples",
        march: Reference { bits: Some(8), ..REFERENCE },
        caught_by: &[SMOOTH, FINEST],
    },
    Broken {
        name: "15 bits are kept between samples",
        march: Reference { bits: Some(15), ..REFERENCE },
        caught_by: &[FINEST, "emission only: C = ∫q"],
    },
];
