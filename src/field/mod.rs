//! What a ray may ask at a point: the value, its gradient, the gradient magnitude, and what blocks of cells hold.
//!
//! **Definitions.** Positions are continuous voxel indices inside [`Grid::index_bounds`](crate::volume::Grid::index_bounds).
//! The cell `(i, j, k)` is the box between the voxels `(i, j, k)` and `(i+1, j+1, k+1)`. Where slices are at uneven distances
//! ([`Slices`](crate::volume::Slices)) the third index is a place `p` in their table, and `(k, k+1)` stands for `(p_k, p_k+1)`.
//!
//! * *Value* ([`Trilinear::value`]): trilinear interpolation of the stored samples. Kernels work in stored units; the
//!   rescale to HU is in the [baked transfer function](crate::classify).
//! * *Gradient* ([`Trilinear::gradient_per_index`]): at the voxels the difference between both neighbours over their distance,
//!   `(v[k+1] − v[k−1]) / (p[k+1] − p[k−1])` (central differences, for even slices), one-sided on the border, 0 along an axis of
//!   one voxel. It is exact for linear fields on any lattice, and of second order on even ones. The *vector* is interpolated trilinearly, so it is continuous and, along a ray inside a cell, each
//!   component is a cubic. [`GradientUnits`] maps it to HU/mm by the inverse transpose of the grid's affine.
//! * *Gradient magnitude* ([`gradient_magnitude_per_mm`]): the length of that vector at the voxels, HU/mm, as a scalar
//!   channel that is interpolated like the value. It is what 2D transfer functions classify by. (The length of the
//!   interpolated vector is another function: it dips where neighbouring gradients disagree.)
//! * *Macrocells* ([`Macrocells`]): lowest and highest stored value of blocks of 8³ cells, and likewise of the magnitude.

mod batch;
mod bricks;
mod chord;
mod chords;
mod corners;
mod gradient;
mod lanes;
mod macrocell;
mod magnitude;
mod position;
mod spacing;
mod trilinear;
mod voxel;

pub use batch::{Batch, MOST_VOXELS_PER_STEP, Offsets, SAMPLES, offsets};
pub use chord::Chord;
pub use chords::Chords;
pub use corners::Corners;
pub use gradient::GradientUnits;
pub use macrocell::{BLOCK_CELLS, BlockRanges, Macrocells};
pub use magnitude::{
    Magnitude, Magnitudes, Steps, gradient_magnitude_per_mm, gradient_magnitude_row, gradient_magnitudes,
    gradient_range_per_mm,
};
pub use position::{Cell, Pace, Position, Step};
pub use spacing::{Even, SliceTable, Spacing, Uneven};
pub use trilinear::{Trilinear, interpolate};
pub use voxel::Voxel;

pub(crate) use lanes::Cells;
