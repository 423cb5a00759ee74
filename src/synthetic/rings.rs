//! An RGBA volume by formula: three rings around a cloud, in colours that no transfer function of one value could give.

use glam::DVec3;
use rayon::prelude::*;

use crate::error::{Error, Fault, Result};
use crate::image::srgb;
use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};

/// Length of the volume's sides, mm.
const SIDE_MM: f64 = 100.0;

/// Fewest and most voxels along a side; 4 GB.
const SIZES: std::ops::RangeInclusive<usize> = 2..=1024;

/// A ring: its axis, the radius of its centre line and of its cross-section, mm.
const RINGS: [(DVec3, f64, f64); 3] = [(DVec3::Z, 38.0, 6.0), (DVec3::X, 27.0, 5.0), (DVec3::Y, 17.0, 4.0)];

/// Extinction inside a ring, 1/mm.
const RING_PER_MM: f64 = 0.6;

/// Extinction in the middle of the cloud, 1/mm, and the length over which it falls off.
const CLOUD: (f64, f64) = (0.05, 9.0);

/// Three rings, one inside the other and each across the next, whose hue runs once around, with a grey cloud in the middle:
/// `size`³ voxels over 100 mm, 8 bits per component. Alpha is the opacity of a voxel's length, so that the picture does not
/// depend on the size.
///
/// # Errors
/// `Fault::Spec` for a size out of range, `Fault::Limit` where memory for the voxels cannot be had.
pub fn rings(size: usize) -> Result<Volume> {
    if !SIZES.contains(&size) {
        return Err(Error::new(Fault::Spec, "the rings cannot have this size")
            .element("size")
            .found(size.to_string())
            .expected(format!("{} to {} voxels along each side", SIZES.start(), SIZES.end())));
    }
    let spacing_mm = SIDE_MM / size as f64;
    let grid = Grid::axis_aligned([size; 3], DVec3::splat(spacing_mm))?;
    let mut texels: Vec<[u8; 4]> = Vec::new();
    texels.try_reserve_exact(grid.voxel_count()).map_err(|error| {
        Error::new(Fault::Limit, "there is no memory for the rings")
            .found(format!("{:?} voxels of 4 bytes", grid.dims()))
            .remedy("ask for a smaller size")
            .caused_by(error)
    })?;
    texels.resize(grid.voxel_count(), [0; 4]);
    let centre = DVec3::splat(0.5 * (size - 1) as f64);
    texels.par_iter_mut().enumerate().for_each(|(voxel, texel)| {
        let index = DVec3::from_array(grid.unflatten(voxel).map(|i| i as f64));
        *texel = at((index - centre) * spacing_mm, spacing_mm);
    });
    Volume::new(grid, Samples::Rgba8(texels), Rescale::IDENTITY, Quantity::Arbitrary)
}

/// Colour and opacity over `length_mm` at a point, mm from the centre.
fn at(point_mm: DVec3, length_mm: f64) -> [u8; 4] {
    let (cloud_per_mm, cloud_mm) = CLOUD;
    let mut extinction = cloud_per_mm * (-point_mm.length_squared() / (cloud_mm * cloud_mm)).exp();
    let mut emission = DVec3::splat(0.8 * extinction);
    for (axis, radius_mm, thickness_mm) in RINGS {
        let along = point_mm.dot(axis);
        let across = point_mm - along * axis;
        let distance_mm = DVec3::new(across.length() - radius_mm, along, 0.0).length();
        // The edge is two voxels wide.
        let share = (0.5 + (thickness_mm - distance_mm) / (2.0 * length_mm)).clamp(0.0, 1.0);
        let (x, y) = (across.dot(axis.any_orthonormal_vector()), across.dot(axis.cross(axis.any_orthonormal_vector())));
        extinction += share * RING_PER_MM;
        emission += share * RING_PER_MM * hue(y.atan2(x));
    }
    let opacity = -(-extinction * length_mm).exp_m1();
    let [r, g, b] = (emission / extinction.max(f64::MIN_POSITIVE)).to_array().map(|c| srgb::encode(c.clamp(0.0, 1.0)));
    [r, g, b, opacity].map(|x| (255.0 * x).round() as u8)
}

/// A colour of the wheel by its angle in radians, linear RGB.
fn hue(angle: f64) -> DVec3 {
    let third = std::f64::consts::TAU / 3.0;
    let component = |shift: f64| 0.5 + 0.5 * (angle - shift).cos();
    DVec3::new(component(0.0), component(third), component(2.0 * third))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_dense_and_coloured_and_the_corners_are_empty() {
        let volume = rings(50).unwrap();
        let at = |index| volume.optics_per_mm(index).unwrap();
        assert_eq!(at([0, 0, 0]), [0.0; 4], "a corner");
        let [r, g, b, extinction] = at([24 + 19, 24, 24]);
        assert!((extinction - RING_PER_MM).abs() < 0.02, "inside a ring: found {extinction} per mm");
        assert!(r.max(g).max(b) > 2.0 * r.min(g).min(b), "coloured: found {r}, {g}, {b}");
    }

    #[test]
    fn extinction_does_not_depend_on_the_size() {
        for (size, middle) in [(41, 20), (81, 40)] {
            let [.., extinction] = rings(size).unwrap().optics_per_mm([middle; 3]).unwrap();
            assert!((extinction - 0.05).abs() < 2e-3, "size {size}: found {extinction} per mm, expected 0.05");
        }
        assert!(rings(1).is_err() && rings(1025).is_err(), "sizes out of range");
    }
}
