//! How many voxels have which value and gradient magnitude, and between which two materials they lie.
//!
//! **Joint histogram** ([`joint`]). Each voxel counts once, at its value `v` and at the [gradient magnitude](crate::field)
//! `g` there: the two numbers that transfer functions classify by. Materials are dense spots at the foot, the boundaries
//! between them arcs above (Kindlmann and Durkin 1998; Kniss, Kindlmann and Hansen 2002).
//!
//! **Low-high histogram** ([`low_high`]; Šereda, Vilanova Bartrolí, Serlie and Gerritsen 2006). Each voxel counts once, at
//! the values `(L, H)` of the two materials between which it lies, so `L ≤ v ≤ H`; the axes are those of the value:
//!
//! * Where `|∇| < flat_per_mm` at the voxel, it lies inside a material: `L = H = v`, on the diagonal.
//! * Elsewhere `H` is the value at the end of a path that follows the gradient upward, and `L` that of one downward. A path
//!   takes steps of half the smallest voxel edge, by the midpoint rule, along the trilinearly interpolated gradient. It ends
//!   before a step that would leave the domain or along which the value would not rise (fall): an extremum; and before one
//!   to where the length of the gradient, having fallen, rises again: an inflection point, where the next boundary begins.
//!   It ends at the first point with `|∇| < flat_per_mm`, or after 256 steps. A voxel at an inflection point
//!   itself is thus between the outer two of the three materials.
//!
//! So a material is a peak on the diagonal and a boundary a peak beside it, at the row and column of its two materials, where
//! the joint histogram has an arc.
//!
//! **Bins** ([`Axis`]) are equal and half-open, `[e_n, e_n+1)`; the last is closed. Counts are whole numbers, so they are the
//! same on any number of threads.

mod axis;
mod ends;
mod joint;
mod low_high;
mod sampled;

pub use axis::{Axis, MOST_BINS};
pub use ends::{gradient_end_per_mm, value_axis};
pub use joint::joint;
pub use low_high::low_high;

/// Counts of voxels over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Counts {
    x: Axis,
    y: Axis,
    /// Bin `(i, j)` at `i * y.bins() + j`.
    counts: Vec<u64>,
    voxels: u64,
}

impl Counts {
    /// No voxels yet.
    fn new(x: Axis, y: Axis) -> Self {
        Counts { x, y, counts: vec![0; x.bins() * y.bins()], voxels: 0 }
    }

    /// Counts a voxel: in its bin, or as one outside of the axes.
    fn add(&mut self, x: f64, y: f64) {
        self.voxels += 1;
        if let (Some(i), Some(j)) = (self.x.bin(x), self.y.bin(y)) {
            self.counts[i * self.y.bins() + j] += 1;
        }
    }

    /// The voxels of both, over the same axes.
    fn plus(mut self, other: Counts) -> Self {
        self.voxels += other.voxels;
        self.counts.iter_mut().zip(other.counts).for_each(|(sum, more)| *sum += more);
        self
    }

    /// The horizontal axis: the value, or that of the lower material.
    pub fn x(&self) -> Axis {
        self.x
    }

    /// The vertical axis: the gradient magnitude, or the value of the higher material.
    pub fn y(&self) -> Axis {
        self.y
    }

    /// Voxels in bin `i` of the horizontal and `j` of the vertical axis.
    pub fn at(&self, i: usize, j: usize) -> u64 {
        self.column(i)[j]
    }

    /// Voxels in bin `i` of the horizontal axis, bin by bin along the vertical one.
    pub fn column(&self, i: usize) -> &[u64] {
        &self.counts[i * self.y.bins()..][..self.y.bins()]
    }

    /// Voxels of the volume, within the axes or not.
    pub fn voxels(&self) -> u64 {
        self.voxels
    }

    /// Voxels within the axes.
    pub fn counted(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Voxels in the fullest bin.
    pub fn highest(&self) -> u64 {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// Voxels within the axes by their bin along the horizontal one.
    pub fn along_x(&self) -> Vec<u64> {
        (0..self.x.bins()).map(|i| self.column(i).iter().sum()).collect()
    }

    /// Voxels within the axes by their bin along the vertical one.
    pub fn along_y(&self) -> Vec<u64> {
        (0..self.y.bins()).map(|j| (0..self.x.bins()).map(|i| self.at(i, j)).sum()).collect()
    }
}
