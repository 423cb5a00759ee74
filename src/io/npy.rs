//! Arrays for numpy, in its format 1.0 (`numpy.lib.format`).

use std::io::{self, Write};
use std::path::Path;

use crate::error::{Error, Fault, Result};
use crate::io::whole_file;

/// Writes an array of f32, the last axis fastest.
///
/// # Errors
/// `Fault::Output` if the file cannot be written. Panics if the number of values is not that of the shape.
pub fn write(path: &Path, shape: &[usize], values: &[f32]) -> Result<()> {
    assert_eq!(values.len(), shape.iter().product::<usize>(), "values of an array of {shape:?}");
    whole_file::write(path, |file| -> io::Result<()> {
        file.write_all(&header(shape))?;
        for chunk in values.chunks(1 << 14) {
            let bytes: Vec<u8> = chunk.iter().flat_map(|v| v.to_le_bytes()).collect();
            file.write_all(&bytes)?;
        }
        Ok(())
    })
}

/// Magic, version, length, and a Python dictionary padded so that the values begin at a multiple of 64 bytes.
fn header(shape: &[usize]) -> Vec<u8> {
    let axes: String = shape.iter().map(|n| format!("{n}, ")).collect();
    let mut dictionary = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({axes}), }}");
    let before = 10;
    let padding = 64 - (before + dictionary.len() + 1) % 64;
    dictionary.push_str(&" ".repeat(padding % 64));
    dictionary.push('\n');
    let length = u16::try_from(dictionary.len()).unwrap_or(u16::MAX);
    [b"\x93NUMPY\x01\x00".as_slice(), &length.to_le_bytes(), dictionary.as_bytes()].concat()
}

/// Reads an array of f32 as [`write()`] makes it: its shape and its values.
///
/// # Errors
/// `Fault::Input` for a file that is missing, cut short or of another kind of number.
pub fn read(path: &Path) -> Result<(Vec<usize>, Vec<f32>)> {
    let damaged = |what: &str| Error::new(Fault::Input, format!("the array cannot be read: {what}")).at(path);
    let bytes = std::fs::read(path).map_err(|cause| damaged("it cannot be opened").caused_by(cause))?;
    let length = match bytes.get(..10) {
        Some([0x93, b'N', b'U', b'M', b'P', b'Y', 1, _, low, high]) => usize::from(u16::from_le_bytes([*low, *high])),
        _ => return Err(damaged("it is not in numpy's format 1.0")),
    };
    let dictionary = bytes.get(10..10 + length).ok_or_else(|| damaged("it ends within its header"))?;
    let dictionary = String::from_utf8_lossy(dictionary).replace(' ', "");
    if !dictionary.contains("'descr':'<f4'") || !dictionary.contains("'fortran_order':False") {
        return Err(damaged("it is not of 32-bit floats, last axis fastest").found(dictionary));
    }
    let axes = dictionary.split_once("'shape':(").and_then(|(_, rest)| rest.split_once(')')).map(|(axes, _)| axes);
    let axes = axes.ok_or_else(|| damaged("it has no shape"))?.split(',').filter(|axis| !axis.is_empty());
    let shape: Option<Vec<usize>> = axes.map(|axis| axis.parse().ok()).collect();
    let shape = shape.ok_or_else(|| damaged("its shape is not of numbers"))?;
    let values: Vec<f32> = bytes[10 + length..].as_chunks::<4>().0.iter().map(|v| f32::from_le_bytes(*v)).collect();
    let count = shape.iter().try_fold(1usize, |count, &n| count.checked_mul(n));
    if count != Some(values.len()) {
        return Err(damaged("it is cut short").found(format!("{} values for a shape of {shape:?}", values.len())));
    }
    Ok((shape, values))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_numpys_own() {
        // numpy.save of a 2 x 3 array of f32 begins with these bytes.
        let header = header(&[2, 3]);
        assert_eq!(header.len() % 64, 0, "values are aligned");
        assert_eq!(&header[..10], b"\x93NUMPY\x01\x00\x76\x00");
        assert!(header[10..].starts_with(b"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, ), }"));
        assert_eq!(header.last(), Some(&b'\n'));
    }

    #[test]
    fn what_is_written_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npy");
        let values = [1.0, -2.5, 3.25, 0.0, 1e-30, 7.0];
        write(&path, &[3, 2], &values).unwrap();
        assert_eq!(read(&path).unwrap(), (vec![3, 2], values.to_vec()));
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() - 4]).unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("cut short"), "a value is missing");
    }
}
