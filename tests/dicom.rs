//! Tests of dicom: synthetic series with every attribute under control, frames compressed by other programs, public scans.

mod codecs;
mod folders;
mod geometry;
mod pixels;
mod public_scans;
mod slices;
mod written;
