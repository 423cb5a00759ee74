//! The Euclidean distance transform, exact (Felzenszwalb and Huttenlocher 2012, doi 10.4086/toc.2012.v008a019).
//!
//! The square of a distance on a lattice with axes at right angles is a sum over the axes, so the nearest voxel is found by a
//! pass along each: along a line, the least of `f(q) + s² (p − q)²` over `q` is the lower envelope of parabolas.

use glam::DVec3;
use rayon::prelude::*;

use crate::error::{Error, Fault, Result};
use crate::volume::Grid;

/// How far from a right angle axes may be, as the cosine: what rounding in files makes of one.
const RIGHT_ANGLE: f64 = 1e-4;

/// Spacing in mm of a lattice on which distances are sums over the axes.
///
/// # Errors
/// `Fault::Unsupported` for axes that are not at right angles, as those of a scan with gantry tilt.
pub(super) fn orthogonal_spacing_mm(grid: &Grid) -> Result<DVec3> {
    let m = grid.index_to_lps_mm().matrix3;
    let [a, b, c] = [m.x_axis.normalize(), m.y_axis.normalize(), m.z_axis.normalize()];
    let cosine = a.dot(b).abs().max(b.dot(c).abs()).max(c.dot(a).abs());
    if cosine <= RIGHT_ANGLE {
        return Ok(grid.spacing_mm());
    }
    Err(Error::new(Fault::Unsupported, "distances in mm need voxel axes at right angles")
        .found(format!("axes {:.2}° away from them", cosine.min(1.0).asin().to_degrees()))
        .remedy("leave out closing_mm and distances, or resample the scan"))
}

/// Square of the distance in mm² from each voxel to the nearest for which `inside` is true, given the linear index; infinite
/// if there is none.
pub(super) fn squared_distances_mm2(
    dims: [usize; 3],
    spacing_mm: DVec3,
    inside: impl Fn(usize) -> bool + Sync,
) -> Vec<f32> {
    let [nx, ny, nz] = dims;
    let mut squares: Vec<f32> = vec![0.0; nx * ny * nz];
    squares.par_chunks_mut(nx * ny).enumerate().for_each_init(Envelope::default, |envelope, (k, slice)| {
        for (offset, square) in slice.iter_mut().enumerate() {
            *square = if inside(k * nx * ny + offset) { 0.0 } else { f32::INFINITY };
        }
        within_slice(envelope, nx, spacing_mm, slice);
    });
    along_k(dims, spacing_mm.z, &mut squares);
    squares
}

/// The first two passes.
fn within_slice(envelope: &mut Envelope, nx: usize, spacing_mm: DVec3, slice: &mut [f32]) {
    for line in slice.chunks_mut(nx) {
        envelope.transform(line.len(), spacing_mm.x, |i| line[i]);
        line.copy_from_slice(&envelope.line);
    }
    let ny = slice.len() / nx;
    for i in 0..nx {
        envelope.transform(ny, spacing_mm.y, |j| slice[i + nx * j]);
        for (j, square) in envelope.line.iter().enumerate() {
            slice[i + nx * j] = *square;
        }
    }
}

/// Slices of which it is told at once what is near.
const SLICES_AT_ONCE: usize = 8;

/// Tells of each voxel whether one that is `wanted` lies within `radius_mm` of it, a few slices at a time: no distances are kept but
/// those within the slices that have a say, so that memory does not go with the volume.
///
/// `row([j, k])` has the voxels of a row. `tell` hears the number of a slice, and the answers for it and those that follow.
pub(super) fn tell_near<'a>(
    [nx, ny, nz]: [usize; 3],
    spacing_mm: DVec3,
    radius_mm: f64,
    wanted: bool,
    row: impl Fn([usize; 2]) -> &'a [bool] + Sync,
    mut tell: impl FnMut(usize, &[bool]),
) {
    // The radius itself is within the ball, whatever rounding says.
    let square = radius_mm * radius_mm * (1.0 + 1e-6);
    let reach = (square.sqrt() / spacing_mm.z) as usize;
    let mut near = vec![false; nx * ny * SLICES_AT_ONCE.min(nz)];
    for first in (0..nz).step_by(SLICES_AT_ONCE) {
        let end = nz.min(first + SLICES_AT_ONCE);
        let from = first.saturating_sub(reach);
        let transformed = |envelope: &mut Envelope, k: usize| {
            let squares = (0..ny)
                .flat_map(|j| row([j, k]).iter().map(|inside| if *inside == wanted { 0.0 } else { f32::INFINITY }));
            let mut squares: Vec<f32> = squares.collect();
            within_slice(envelope, nx, spacing_mm, &mut squares);
            squares
        };
        let slices = from..nz.min(end + reach);
        let planes: Vec<Vec<f32>> = slices.into_par_iter().map_init(Envelope::default, transformed).collect();
        let near = &mut near[..nx * ny * (end - first)];
        near.par_chunks_mut(nx * ny).enumerate().for_each(|(n, near)| {
            let k = first + n;
            near.fill(false);
            for other in k.saturating_sub(reach)..nz.min(k + reach + 1) {
                let along_k = k.abs_diff(other) as f64 * spacing_mm.z;
                let rest = (square - along_k * along_k) as f32;
                near.iter_mut().zip(&planes[other - from]).for_each(|(near, square)| *near |= *square <= rest);
            }
        });
        tell(first, near);
    }
}

/// The last pass, over slabs of rows so that lines along k lie together while they are worked on.
fn along_k([nx, ny, nz]: [usize; 3], spacing_mm: f64, squares: &mut [f32]) {
    const ROWS_AT_ONCE: usize = 32;
    for first in (0..ny).step_by(ROWS_AT_ONCE) {
        let rows = ROWS_AT_ONCE.min(ny - first);
        let lines: Vec<Vec<f32>> = (first * nx..(first + rows) * nx)
            .into_par_iter()
            .map_init(Envelope::default, |envelope, offset| {
                envelope.transform(nz, spacing_mm, |k| squares[offset + nx * ny * k]);
                envelope.line.clone()
            })
            .collect();
        squares.par_chunks_mut(nx * ny).enumerate().for_each(|(k, slice)| {
            for (square, line) in slice[first * nx..].iter_mut().zip(&lines) {
                *square = line[k];
            }
        });
    }
}

/// The lower envelope of the parabolas of a line.
#[derive(Default)]
struct Envelope {
    /// Voxel and height of each parabola that is part of the envelope, from left to right.
    parabolas: Vec<(f64, f64)>,
    /// Where each takes over from the one before, in voxels.
    from: Vec<f64>,
    /// The result.
    line: Vec<f32>,
}

impl Envelope {
    fn transform(&mut self, count: usize, spacing_mm: f64, height: impl Fn(usize) -> f32) {
        self.parabolas.clear();
        self.from.clear();
        let per_square = 1.0 / (spacing_mm * spacing_mm);
        for q in 0..count {
            // In units of squared voxels.
            let (at, h) = (q as f64, f64::from(height(q)) * per_square);
            if h.is_infinite() {
                continue;
            }
            let mut from = f64::NEG_INFINITY;
            while let Some(&(p, low)) = self.parabolas.last() {
                from = ((h + at * at) - (low + p * p)) / (2.0 * (at - p));
                if self.from.last().is_some_and(|&last| from <= last) {
                    self.parabolas.pop();
                    self.from.pop();
                    from = f64::NEG_INFINITY;
                } else {
                    break;
                }
            }
            self.parabolas.push((at, h));
            self.from.push(from);
        }
        self.line.clear();
        if self.parabolas.is_empty() {
            self.line.resize(count, f32::INFINITY);
            return;
        }
        let mut n = 0;
        for p in 0..count {
            let at = p as f64;
            while n + 1 < self.from.len() && self.from[n + 1] <= at {
                n += 1;
            }
            let (q, h) = self.parabolas[n];
            self.line.push(((h + (at - q) * (at - q)) / per_square) as f32);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3};

    #[test]
    fn it_is_the_distance_to_the_nearest() {
        let cases = [([7, 6, 5], DVec3::new(0.5, 0.7, 3.0)), ([1, 9, 4], DVec3::ONE), ([40, 1, 1], DVec3::splat(0.3))];
        for (dims, spacing) in cases {
            for every in [2, 7, 23, usize::MAX] {
                let inside = |index: usize| every != usize::MAX && (index * 7919 % 101).is_multiple_of(every);
                let found = squared_distances_mm2(dims, spacing, inside);
                let place = |index: usize| {
                    let [nx, ny, _] = dims;
                    spacing * DVec3::new((index % nx) as f64, (index / nx % ny) as f64, (index / (nx * ny)) as f64)
                };
                for (index, square) in found.iter().enumerate() {
                    let seeds = (0..found.len()).filter(|&seed| inside(seed));
                    let nearest = seeds.map(|seed| place(seed).distance_squared(place(index)));
                    let expected = nearest.fold(f64::INFINITY, f64::min);
                    let square = f64::from(*square);
                    let same = square == expected || (square - expected).abs() <= 1e-6 * expected.max(1e-3);
                    assert!(same, "{dims:?}, voxel {index}: found {square} mm², expected {expected} mm²");
                }
            }
        }
    }

    #[test]
    fn sheared_axes_are_refused() {
        let sheared = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(0.0, 0.3, 1.0));
        let grid = Grid::new([2, 2, 2], DAffine3::from_mat3(sheared)).unwrap();
        let error = orthogonal_spacing_mm(&grid).unwrap_err();
        assert_eq!(error.fault(), Fault::Unsupported, "{error}");
        assert!(orthogonal_spacing_mm(&Grid::axis_aligned([2, 2, 2], DVec3::ONE).unwrap()).is_ok());
    }
}
