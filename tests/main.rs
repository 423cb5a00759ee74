//! One test binary; see README.md in this folder.

mod analytic;
mod cli;
mod dicom;
mod exact;
mod hard_cases;
mod house;
mod image;
mod layering;
mod march;
mod models;
mod nrrd;
mod oracle;
mod phantom;
mod plan;
mod properties;
mod spec;
mod support;
mod verify;
mod vtk;
