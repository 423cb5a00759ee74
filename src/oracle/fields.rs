//! The fields along one passage, and the pieces on which the transfer function is smooth along it.

use glam::DVec3;

use super::bernstein::{Bernstein, Cubic};
use super::cell::{Cell, along};
use super::panel::Panel;
use super::patches::{Channels, Corners, Patches};
use super::path::Passage;
use super::splits::Splits;
use crate::volume::Volume;

/// Fields along a passage through one cell; each is exactly a cubic.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fields {
    value: Cubic,
    /// The magnitude at the lattice points, interpolated: what a 2D transfer function reads.
    gradient_magnitude: Option<Cubic>,
    /// The vector, interpolated: what shading reads.
    pub(super) gradient: Option<[Cubic; 3]>,
}

/// A part of a passage within one patch of the transfer function.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece<'a> {
    /// Where it begins in the passage, in [0, 1].
    pub(super) from: f64,
    /// Where it ends.
    pub(super) to: f64,
    value_interval: usize,
    gradient_interval: usize,
    corners: &'a Corners,
}

impl Fields {
    /// The fields that are read, or `None` if nothing can be shown at any value within the cell.
    pub(super) fn new(volume: &Volume, patches: &Patches, shaded: bool, passage: &Passage) -> Option<Fields> {
        let cell = Cell::new(volume, passage.cell);
        let values = cell.values();
        // A trilinear function lies within its corners.
        let (low, high) = values.iter().fold((values[0], values[0]), |(l, h), &v| (l.min(v), h.max(v)));
        if patches.nothing_in(low, high) {
            return None;
        }
        let mut fields = Fields { value: along(&values, passage), gradient_magnitude: None, gradient: None };
        if shaded || patches.gradient.is_some() {
            let gradients = cell.gradients_per_mm();
            if patches.gradient.is_some() {
                fields.gradient_magnitude = Some(along(&gradients.map(DVec3::length), passage));
            }
            if shaded {
                fields.gradient = Some(std::array::from_fn(|a| along(&gradients.map(|g| g[a]), passage)));
            }
        }
        Some(fields)
    }

    /// Adds the cuts at the knots of the transfer function.
    pub(super) fn add_knots(&self, patches: &Patches, splits: &mut Splits) {
        splits.add_knots(&self.value, &patches.value);
        if let (Some(magnitude), Some(axis)) = (&self.gradient_magnitude, &patches.gradient) {
            splits.add_knots(magnitude, axis);
        }
    }

    /// The piece between two neighbouring cuts, or `None` if it shows nothing.
    pub(super) fn piece<'a>(&self, patches: &'a Patches, [from, to]: [f64; 2]) -> Option<Piece<'a>> {
        let middle = 0.5 * (from + to);
        let value_interval = patches.value.interval(self.value.at(middle));
        let gradient_interval = match (&self.gradient_magnitude, &patches.gradient) {
            (Some(magnitude), Some(axis)) => axis.interval(magnitude.at(middle)),
            _ => 0,
        };
        let corners = patches.corners(value_interval, gradient_interval)?;
        Some(Piece { from, to, value_interval, gradient_interval, corners })
    }

    /// σ and q at `t` of the passage, within a piece.
    pub(super) fn optics(&self, patches: &Patches, piece: &Piece, t: f64) -> Channels {
        let x = patches.value.fraction(piece.value_interval, self.value.at(t)).clamp(0.0, 1.0);
        let y = match (&self.gradient_magnitude, &patches.gradient) {
            (Some(magnitude), Some(axis)) => axis.fraction(piece.gradient_interval, magnitude.at(t)).clamp(0.0, 1.0),
            _ => 0.0,
        };
        let [low, high] = piece.corners;
        std::array::from_fn(|c| {
            let at_low = low[0][c] + y * (low[1][c] - low[0][c]);
            let at_high = high[0][c] + y * (high[1][c] - high[0][c]);
            at_low + x * (at_high - at_low)
        })
    }

    /// σ and q over a piece as cubics, for a function of the value alone.
    pub(super) fn cubic_panel(&self, patches: &Patches, piece: &Piece, length_mm: f64) -> Panel<4> {
        let x = self.value_fraction(patches, piece);
        let [low, high] = piece.corners;
        let channels = std::array::from_fn(|c| x.map(|x| low[0][c] + x * (high[0][c] - low[0][c])));
        Panel { channels, length_mm }
    }

    /// σ and q over a piece as polynomials of degree 6, for a function that reads the gradient; `None` for one that does
    /// not.
    pub(super) fn sextic_panel(&self, patches: &Patches, piece: &Piece, length_mm: f64) -> Option<Panel<7>> {
        let (magnitude, axis) = (self.gradient_magnitude?, patches.gradient.as_ref()?);
        let x = self.value_fraction(patches, piece);
        let y = magnitude.restrict(piece.from, piece.to).map(|g| axis.fraction(piece.gradient_interval, g));
        let [low, high] = piece.corners;
        let channels = std::array::from_fn(|c| {
            let near = x.map(|x| low[0][c] + x * (high[0][c] - low[0][c]));
            let far = x.map(|x| low[1][c] + x * (high[1][c] - low[1][c]));
            let rise = Bernstein(std::array::from_fn(|i| far.0[i] - near.0[i]));
            let (flat, sloped) = (near.elevated(), y.times(&rise));
            Bernstein(std::array::from_fn(|i| flat.0[i] + sloped.0[i]))
        });
        Some(Panel { channels, length_mm })
    }

    fn value_fraction(&self, patches: &Patches, piece: &Piece) -> Cubic {
        self.value.restrict(piece.from, piece.to).map(|v| patches.value.fraction(piece.value_interval, v))
    }
}
