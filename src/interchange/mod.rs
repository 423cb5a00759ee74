//! Scenes for other programs, so that anyone can hold pellucid's pictures against theirs, and presets from and for them.

pub mod presets;
pub mod vtk;
