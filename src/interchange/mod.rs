//! Scenes for other programs, so that anyone can hold pellucid's pictures against theirs.

pub mod vtk;
