//! Where voxels are: sform, qform or spacing alone, from RAS to LPS.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use nifti::NiftiHeader;

use crate::error::{Error, Fault, Result};
use crate::volume::Grid;

/// How far corners may be apart by sform and qform, as a share of a voxel, before they contradict each other.
const SAME_PLACE: f64 = 0.05;

/// The lattice of a header.
pub(super) fn grid(header: &NiftiHeader, dims: [usize; 3], warnings: &mut Vec<String>) -> Result<Grid> {
    let mm = mm_per_unit(header, warnings);
    let sform = (header.sform_code > 0).then(|| sform(header)).map(|ras| to_lps(ras, mm));
    let qform = if header.qform_code > 0 { Some(to_lps(qform(header)?, mm)) } else { None };
    let lattice = |affine: DAffine3| Grid::new(dims, affine);
    match (sform, qform) {
        (Some(sform), qform) => {
            let grid = lattice(sform)?;
            if let Some(other) = qform.map(lattice).transpose()? {
                let apart = grid.corners_mm().into_iter().zip(other.corners_mm()).map(|(a, b)| a.distance(b));
                let apart = apart.fold(0.0, f64::max);
                if apart > SAME_PLACE * grid.spacing_mm().min_element() {
                    warnings.push(format!("sform and qform differ by up to {apart:.2} mm: the sform is taken"));
                }
            }
            Ok(grid)
        }
        (None, Some(qform)) => lattice(qform),
        (None, None) => {
            warnings.push(
                "there is neither sform nor qform: x is assumed to go to the patient's right, y to the front, z to the \
                 head, from the first voxel"
                    .to_owned(),
            );
            lattice(to_lps(DAffine3::from_scale(spacing(header)?), mm))
        }
    }
}

fn to_lps(ras: DAffine3, mm: f64) -> DAffine3 {
    DAffine3::from_scale(DVec3::new(-mm, -mm, mm)) * ras
}

fn sform(header: &NiftiHeader) -> DAffine3 {
    let rows = [header.srow_x, header.srow_y, header.srow_z].map(|row| row.map(f64::from));
    let column = |n: usize| DVec3::new(rows[0][n], rows[1][n], rows[2][n]);
    DAffine3::from_mat3_translation(DMat3::from_cols(column(0), column(1), column(2)), column(3))
}

/// A rotation by a quaternion whose real part is not stored, after a scale that may mirror k.
fn qform(header: &NiftiHeader) -> Result<DAffine3> {
    let imaginary = [header.quatern_b, header.quatern_c, header.quatern_d].map(f64::from);
    let square: f64 = imaginary.iter().map(|x| x * x).sum();
    // Rounding in the file may put a unit quaternion a little beyond 1.
    if !square.is_finite() || square > 1.0 + 1e-4 {
        return Err(Error::new(Fault::Geometry, "the qform is no rotation")
            .element("quatern_b, quatern_c, quatern_d")
            .found(format!("{imaginary:?}")));
    }
    let [b, c, d] = imaginary;
    let rotation = DQuat::from_xyzw(b, c, d, (1.0 - square).max(0.0).sqrt()).normalize();
    let handedness = if header.pixdim[0] < 0.0 { -1.0 } else { 1.0 };
    let scale = spacing(header)? * DVec3::new(1.0, 1.0, handedness);
    let origin = [header.quatern_x, header.quatern_y, header.quatern_z].map(f64::from);
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation, DVec3::from_array(origin)))
}

fn spacing(header: &NiftiHeader) -> Result<DVec3> {
    let [_, x, y, z, ..] = header.pixdim.map(f64::from);
    if [x, y, z].iter().all(|s| s.is_finite() && *s > 0.0) {
        return Ok(DVec3::new(x, y, z));
    }
    Err(Error::new(Fault::Geometry, "an axis of the volume has no spacing")
        .element("pixdim")
        .found(format!("{x} {y} {z}"))
        .expected("three numbers above 0"))
}

fn mm_per_unit(header: &NiftiHeader, warnings: &mut Vec<String>) -> f64 {
    // The lowest three bits are the unit of length.
    match header.xyzt_units & 7 {
        1 => 1000.0,
        2 => 1.0,
        3 => 1e-3,
        _ => {
            warnings.push("the file does not say its unit of length: millimetres are assumed".to_owned());
            1.0
        }
    }
}
