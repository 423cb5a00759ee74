//! Writes labels as NIfTI-1, little-endian, in RAS.

use std::io::Write;
use std::path::Path;

use flate2::write::GzEncoder;
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::error::{Error, Fault, Result};
use crate::io::whole_file;
use crate::volume::{Grid, LabelMap};

/// How far from a rotation a matrix may be and still be written as one.
const ROTATION_TOLERANCE: f64 = 1e-5;
/// `NIFTI_XFORM_SCANNER_ANAT`: coordinates of the scanner, as LPS in DICOM.
const SCANNER: i16 = 1;
/// `NIFTI_INTENT_LABEL`.
const LABEL: i16 = 1002;

/// Writes a label map, packed if the name ends in `.gz`; labels as 8-bit numbers if they fit, as 16-bit numbers if not. Names
/// and colours have no place in NIfTI.
///
/// # Errors
/// `Fault::Output` if the file cannot be written, `Fault::Limit` for more than 32767 voxels along an axis.
pub fn write_label_map(path: &Path, labels: &LabelMap) -> Result<()> {
    let wide = labels.segments().iter().any(|segment| segment.label > 255);
    let header = header(labels.grid(), wide).map_err(|error| error.at(path))?;
    let packed = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    whole_file::write(path, |file| {
        if packed {
            let mut packer = GzEncoder::new(file, flate2::Compression::default());
            write(&mut packer, &header, labels, wide)?;
            packer.finish().map(drop)
        } else {
            write(file, &header, labels, wide)
        }
    })
}

fn write(file: &mut impl Write, header: &[u8], labels: &LabelMap, wide: bool) -> std::io::Result<()> {
    file.write_all(header)?;
    for row in labels.voxels().chunks(labels.grid().dims()[0]) {
        let numbers = row.iter().map(|voxel| labels.label_of(*voxel));
        let bytes: Vec<u8> = match wide {
            true => numbers.flat_map(u16::to_le_bytes).collect(),
            false => numbers.map(|label| label as u8).collect(),
        };
        file.write_all(&bytes)?;
    }
    Ok(())
}

/// The 348 bytes of a header, and four that say that no extension follows.
fn header(grid: &Grid, wide: bool) -> Result<Vec<u8>> {
    let mut dims = [0_i16; 3];
    for (short, long) in dims.iter_mut().zip(grid.dims()) {
        *short = i16::try_from(long).map_err(|_| {
            Error::new(Fault::Limit, "NIfTI-1 has at most 32767 voxels along an axis").found(long.to_string())
        })?;
    }
    let ras = DAffine3::from_scale(DVec3::new(-1.0, -1.0, 1.0)) * grid.index_to_lps_mm();
    let rotation = rotation(ras.matrix3);
    let spacing = grid.spacing_mm();
    let mut bytes = vec![0; 352];
    let mut put = |at: usize, field: &[u8]| bytes[at..at + field.len()].copy_from_slice(field);
    put(0, &348_i32.to_le_bytes());
    for (n, size) in [3, dims[0], dims[1], dims[2], 1, 1, 1, 1].into_iter().enumerate() {
        put(40 + 2 * n, &size.to_le_bytes());
    }
    put(68, &LABEL.to_le_bytes());
    // DT_UINT8 and DT_UINT16.
    let (data_type, bits) = if wide { (512_i16, 16_i16) } else { (2, 8) };
    put(70, &data_type.to_le_bytes());
    put(72, &bits.to_le_bytes());
    let handedness = rotation.map_or(1.0, |(_, handedness)| handedness);
    for (n, step) in [handedness, spacing.x, spacing.y, spacing.z].into_iter().enumerate() {
        put(76 + 4 * n, &(step as f32).to_le_bytes());
    }
    put(108, &352_f32.to_le_bytes());
    put(112, &1_f32.to_le_bytes());
    // Millimetres, no time.
    put(123, &[2]);
    if let Some((rotation, _)) = rotation {
        put(252, &SCANNER.to_le_bytes());
        let DVec3 { x, y, z } = ras.translation;
        for (n, number) in [rotation.x, rotation.y, rotation.z, x, y, z].into_iter().enumerate() {
            put(256 + 4 * n, &(number as f32).to_le_bytes());
        }
    }
    put(254, &SCANNER.to_le_bytes());
    for row in 0..3 {
        let m = ras.matrix3;
        let numbers = [m.x_axis[row], m.y_axis[row], m.z_axis[row], ras.translation[row]];
        for (n, number) in numbers.into_iter().enumerate() {
            put(280 + 16 * row + 4 * n, &(number as f32).to_le_bytes());
        }
    }
    put(344, b"n+1\0");
    Ok(bytes)
}

/// The rotation of a matrix, its real part at least 0, and -1 if k is mirrored; `None` for a sheared matrix, which has no
/// qform.
fn rotation(matrix: DMat3) -> Option<(DQuat, f64)> {
    let mut axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::normalize);
    let handedness = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
    axes[2] *= handedness;
    let rotation = DMat3::from_cols(axes[0], axes[1], axes[2]);
    if !(rotation.transpose() * rotation).abs_diff_eq(DMat3::IDENTITY, ROTATION_TOLERANCE) {
        return None;
    }
    let quaternion = DQuat::from_mat3(&rotation).normalize();
    Some((if quaternion.w < 0.0 { -quaternion } else { quaternion }, handedness))
}
