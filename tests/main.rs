//! One test binary; see README.md in this folder.

mod analytic;
mod cli;
mod clip;
mod dicom;
mod effects;
mod exact;
mod formulas;
mod hard_cases;
mod house;
mod image;
mod layering;
mod march;
mod mask;
mod models;
mod nifti;
mod nrrd;
mod oracle;
mod phantom;
mod plan;
mod properties;
mod rectilinear;
mod spec;
mod support;
mod tissue;
mod verify;
mod voxels;
