//! Clipping, resolved to the half-spaces that cut something off.

use glam::DVec3;

use crate::scene::{Clip, HalfSpace};
use crate::spec::{ClipBoxSpec, ClipPlaneSpec, ClipSpec, RangeSpec, Spec, TrimSpec};
use crate::volume::Grid;

/// What is closer than this to a plane is taken for being on it, as a fraction of the volume's diagonal: some thousand
/// roundings of a coordinate.
const ROUNDING: f64 = 1e-11;

/// The half-spaces that a spec asks for, with normals of length 1, less those that hold the whole volume.
pub(super) fn resolve(spec: &Spec, grid: &Grid) -> Clip {
    let Some(written) = written(spec) else { return Clip::default() };
    let mut half_spaces = match &written.within {
        None => Vec::new(),
        Some(ClipBoxSpec::Voxels(ranges)) => of_voxels(ranges, grid),
        Some(ClipBoxSpec::Mm(ranges)) => of_ranges(ranges, [DVec3::X, DVec3::Y, DVec3::Z]),
        Some(ClipBoxSpec::TrimMm(trim)) => of_ranges(&trimmed(trim, grid), [DVec3::X, DVec3::Y, DVec3::Z]),
    };
    half_spaces.extend(written.planes.iter().flatten().map(of_plane));
    let corners = grid.corners_mm();
    let margin_mm = ROUNDING * corners[0].distance(corners[7]);
    half_spaces.retain(|h| corners.iter().any(|&corner| depth_mm(h, corner) < -margin_mm));
    Clip { half_spaces }
}

/// What the pipeline says of clipping.
pub(super) fn written(spec: &Spec) -> Option<&ClipSpec> {
    spec.pipeline.effects.as_ref()?.clip.as_ref()
}

fn of_voxels(ranges: &[RangeSpec; 3], grid: &Grid) -> Vec<HalfSpace> {
    // Seen from the first voxel, an index is the product with a row of the inverse map.
    let rows = grid.lps_mm_to_index().matrix3.transpose();
    let mut half_spaces = of_ranges(ranges, [rows.x_axis, rows.y_axis, rows.z_axis]);
    for half_space in &mut half_spaces {
        half_space.offset_mm += half_space.normal.dot(grid.index_to_lps_mm().translation);
    }
    half_spaces
}

/// The half-spaces of `low ≤ axis · x ≤ high` for three axes of any length.
fn of_ranges(ranges: &[RangeSpec; 3], axes: [DVec3; 3]) -> Vec<HalfSpace> {
    let ends = ranges.iter().zip(axes).flat_map(|(range, axis)| {
        let from = range.low.map(|low| unit(axis, low));
        let to = range.high.map(|high| unit(-axis, -high));
        [from, to]
    });
    ends.flatten().collect()
}

/// The ranges of patient coordinates that are left.
fn trimmed(trim: &TrimSpec, grid: &Grid) -> [RangeSpec; 3] {
    let corners = grid.corners_mm();
    let (low, high) = corners.iter().fold((corners[0], corners[0]), |(low, high), &c| (low.min(c), high.max(c)));
    // LPS: x to the patient's left, y to the back, z to the head.
    let off = [[trim.right, trim.left], [trim.anterior, trim.posterior], [trim.inferior, trim.superior]];
    std::array::from_fn(|a| RangeSpec { low: off[a][0].map(|mm| low[a] + mm), high: off[a][1].map(|mm| high[a] - mm) })
}

fn of_plane(plane: &ClipPlaneSpec) -> HalfSpace {
    let normal = DVec3::from_array(plane.normal);
    // Dividing by the largest component first keeps the length from overflowing; the spec refuses the zero vector.
    let normal = (normal / normal.abs().max_element()).normalize();
    let through = plane.point_mm.map(|point| normal.dot(point.into()));
    HalfSpace { normal, offset_mm: through.or(plane.offset_mm).unwrap_or(0.0) }
}

/// `axis · x ≥ offset` with a normal of length 1.
fn unit(axis: DVec3, offset: f64) -> HalfSpace {
    HalfSpace { normal: axis.normalize(), offset_mm: offset / axis.length() }
}

/// How far a point is inside a half-space whose normal has length 1.
fn depth_mm(half_space: &HalfSpace, point_mm: DVec3) -> f64 {
    half_space.normal.dot(point_mm) - half_space.offset_mm
}

/// True if nothing of the volume is left, or no more than a part of a plane.
///
/// What is left is a convex polyhedron, so it has corners, each where three of its planes meet. It has a volume if the mean
/// of its corners is inside of all planes.
pub(super) fn leaves_nothing(clip: &Clip, grid: &Grid) -> bool {
    if clip.half_spaces.is_empty() {
        return false;
    }
    let corners = grid.corners_mm();
    let margin_mm = ROUNDING * corners[0].distance(corners[7]);
    let mut planes = of_voxels(&bounds(grid), grid);
    planes.extend(&clip.half_spaces);
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for (i, a) in planes.iter().enumerate() {
        for (j, b) in planes.iter().enumerate().skip(i + 1) {
            for c in &planes[j + 1..] {
                let Some(point) = meeting_point(a, b, c) else { continue };
                if planes.iter().all(|h| depth_mm(h, point) >= -margin_mm) {
                    sum += point;
                    count += 1.0;
                }
            }
        }
    }
    let middle = sum / count;
    // Without corners the middle is no number, and no comparison with it holds.
    !planes.iter().all(|h| depth_mm(h, middle) > margin_mm)
}

fn bounds(grid: &Grid) -> [RangeSpec; 3] {
    let (low, high) = grid.index_bounds();
    std::array::from_fn(|a| RangeSpec { low: Some(low[a]), high: Some(high[a]) })
}

/// Cramer's rule; `None` for planes that are parallel or nearly so.
fn meeting_point(a: &HalfSpace, b: &HalfSpace, c: &HalfSpace) -> Option<DVec3> {
    let determinant = a.normal.dot(b.normal.cross(c.normal));
    let sum = a.offset_mm * b.normal.cross(c.normal)
        + b.offset_mm * c.normal.cross(a.normal)
        + c.offset_mm * a.normal.cross(b.normal);
    (determinant.abs() > 1e-9).then(|| sum / determinant)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3};

    fn sheared() -> Grid {
        let m = DMat3::from_cols(DVec3::new(0.3, 0.1, 0.0), DVec3::new(-0.2, 0.5, 0.3), DVec3::new(0.0, 0.7, -5.0));
        Grid::new([11, 21, 31], DAffine3::from_mat3_translation(m, DVec3::new(70.0, -300.0, 20.0))).unwrap()
    }

    #[test]
    fn a_range_of_voxels_holds_those_between_its_ends_whatever_the_affine() {
        let range = |low, high| RangeSpec { low: Some(low), high: Some(high) };
        let open = RangeSpec { low: None, high: None };
        let grid = sheared();
        let half_spaces = of_voxels(&[range(2.0, 7.0), open, RangeSpec { low: Some(4.5), high: None }], &grid);
        assert_eq!(half_spaces.len(), 3, "an open end clips nothing");
        let clip = Clip { half_spaces };
        for [i, j, k] in
            [[1.999, 3.0, 9.0], [2.001, 3.0, 9.0], [6.999, 20.0, 4.501], [7.001, 20.0, 9.0], [5.0, 3.0, 4.499]]
        {
            let shown = (2.0..=7.0).contains(&i) && k >= 4.5;
            let found = clip.contains(grid.index_to_lps_mm().transform_point3(DVec3::new(i, j, k)));
            assert_eq!(found, shown, "({i}, {j}, {k})");
        }
    }

    #[test]
    fn nothing_is_left_exactly_where_no_volume_is_left() {
        let grid = sheared();
        let towards = DVec3::new(0.48, 0.6, -0.64);
        let farthest = grid.corners_mm().iter().map(|c| towards.dot(*c)).fold(f64::NEG_INFINITY, f64::max);
        let beyond = |mm: f64| HalfSpace { normal: towards, offset_mm: farthest + mm };
        let nothing = |half_spaces: &[HalfSpace]| leaves_nothing(&Clip { half_spaces: half_spaces.to_vec() }, &grid);
        assert!(!nothing(&[beyond(-1e-3)]), "a corner is left");
        assert!(nothing(&[beyond(0.0)]) && nothing(&[beyond(1.0)]), "a point, and nothing at all");
        let middle = towards.dot(grid.center_mm());
        let slab = |width_mm: f64| {
            let front = HalfSpace { normal: towards, offset_mm: middle };
            [front, HalfSpace { normal: -towards, offset_mm: -middle - width_mm }]
        };
        assert!(!nothing(&slab(1e-3)) && nothing(&slab(0.0)) && nothing(&slab(-1.0)), "a slab, a plane, a gap");
    }
}
