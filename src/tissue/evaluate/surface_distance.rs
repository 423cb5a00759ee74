//! Distances between the surfaces of two masks.

use glam::DVec3;

use crate::tissue::Mask;
use crate::tissue::crop::Crop;
use crate::tissue::distance::squared_distances_mm2;

/// Distances from each voxel of one surface to the nearest of the other, both ways, mm.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SurfaceDistances {
    /// From the first to the second, ascending.
    there: Vec<f64>,
    /// From the second to the first, ascending.
    back: Vec<f64>,
}

impl SurfaceDistances {
    /// `None` if either mask is empty.
    pub(super) fn between(a: &Mask, b: &Mask, spacing_mm: DVec3) -> Option<Self> {
        let (first, second) = (a.bounds()?, b.bounds()?);
        let both = std::array::from_fn(|n| [first[n][0].min(second[n][0]), first[n][1].max(second[n][1])]);
        // All surface voxels lie in the box around both; a voxel more makes the end of the volume the only end.
        let crop = Crop::around(both, [1; 3], a.dims);
        let (a, b) = (surface(&crop.of(a)), surface(&crop.of(b)));
        let directed = |from: &[bool], to: &[bool]| {
            let squares = squared_distances_mm2(crop.dims, spacing_mm, |index| to[index]);
            let on_surface = squares.iter().zip(from).filter(|(_, from)| **from);
            let mut distances: Vec<f64> = on_surface.map(|(square, _)| f64::from(*square).sqrt()).collect();
            distances.sort_by(f64::total_cmp);
            distances
        };
        Some(SurfaceDistances { there: directed(&a, &b), back: directed(&b, &a) })
    }

    pub(super) fn hausdorff_95_mm(&self) -> f64 {
        percentile(&self.there, 0.95).max(percentile(&self.back, 0.95))
    }

    pub(super) fn mean_mm(&self) -> f64 {
        let sum: f64 = self.there.iter().chain(&self.back).sum();
        sum / (self.there.len() + self.back.len()) as f64
    }
}

/// Voxels inside with a face to one that is not, or to the end of the box.
fn surface(mask: &Mask) -> Vec<bool> {
    let [nx, ny, nz] = mask.dims;
    let steps = [1, nx, nx * ny];
    let on_surface = |index: usize| {
        let at = [index % nx, index / nx % ny, index / (nx * ny)];
        let outside = |axis: usize| {
            let ends = at[axis] == 0 || at[axis] == [nx, ny, nz][axis] - 1;
            ends || !mask.inside[index - steps[axis]] || !mask.inside[index + steps[axis]]
        };
        mask.inside[index] && (0..3).any(outside)
    };
    (0..mask.inside.len()).map(on_surface).collect()
}

/// What a share of ascending numbers stays below, linear between ranks.
fn percentile(ascending: &[f64], share: f64) -> f64 {
    let rank = share * (ascending.len() - 1) as f64;
    let below = rank.floor() as usize;
    let above = (below + 1).min(ascending.len() - 1);
    ascending[below] + (rank - below as f64) * (ascending[above] - ascending[below])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::Grid;

    const SPACING: DVec3 = DVec3::new(1.0, 2.0, 3.0);

    fn cuboid(first: [usize; 3], last: [usize; 3]) -> Mask {
        let grid = Grid::axis_aligned([20, 12, 10], SPACING).unwrap();
        Mask::new(&grid, |index| {
            let at = grid.unflatten(index);
            (0..3).all(|a| (first[a]..=last[a]).contains(&at[a]))
        })
    }

    #[test]
    fn the_same_surface_is_no_distance_apart() {
        let a = cuboid([3, 3, 3], [9, 7, 6]);
        let distances = SurfaceDistances::between(&a, &a, SPACING).unwrap();
        assert_eq!((distances.hausdorff_95_mm(), distances.mean_mm()), (0.0, 0.0));
        assert_eq!(SurfaceDistances::between(&a, &cuboid([1; 3], [0; 3]), SPACING), None, "one is empty");
    }

    #[test]
    fn distances_are_those_of_all_pairs() {
        let (a, b) = (cuboid([0, 3, 3], [9, 7, 6]), cuboid([5, 0, 4], [14, 7, 9]));
        let found = SurfaceDistances::between(&a, &b, SPACING).unwrap();
        let grid = Grid::axis_aligned(a.dims, SPACING).unwrap();
        let points = |mask: &Mask| -> Vec<DVec3> {
            let surface = surface(mask);
            let at = |index: usize| SPACING * DVec3::from_array(grid.unflatten(index).map(|i| i as f64));
            (0..surface.len()).filter(|index| surface[*index]).map(at).collect()
        };
        let directed = |from: &[DVec3], to: &[DVec3]| {
            let nearest = |p: &DVec3| to.iter().map(|q| p.distance(*q)).fold(f64::INFINITY, f64::min);
            let mut all: Vec<f64> = from.iter().map(nearest).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let (p, q) = (points(&a), points(&b));
        for (found, expected) in [(&found.there, directed(&p, &q)), (&found.back, directed(&q, &p))] {
            assert_eq!(found.len(), expected.len(), "voxels on the surface");
            let apart = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-5, "distances differ by {apart} mm");
        }
    }

    #[test]
    fn percentiles_are_linear_between_ranks() {
        assert_eq!(percentile(&[1.0, 2.0, 4.0], 0.75), 3.0);
        assert_eq!(percentile(&[7.0], 0.95), 7.0);
    }
}
