//! NIfTI-1 as it is read: known numbers at known places, and the ways in which a file can lie.
//!
//! Headers are made here byte by byte, not by our own writer.

use std::io::Write;

use glam::DVec3;
use pellucid::io::{Scan, nifti};
use pellucid::{Fault, Result};

/// A 3 x 2 x 2 volume of int16, with an sform that turns and shifts.
struct File {
    bytes: Vec<u8>,
}

impl File {
    fn new() -> Self {
        let mut file = File { bytes: vec![0; 352] };
        file.put(0, &348_i32.to_le_bytes());
        for (n, size) in [3_i16, 3, 2, 2, 1, 1, 1, 1].iter().enumerate() {
            file.put(40 + 2 * n, &size.to_le_bytes());
        }
        file.put(70, &4_i16.to_le_bytes());
        file.put(72, &16_i16.to_le_bytes());
        file.floats(76, &[1.0, 2.0, 3.0, 4.0]);
        file.floats(108, &[352.0]);
        file.put(123, &[2]);
        file.put(254, &1_i16.to_le_bytes());
        // i goes to the front, j to the left, k to the head.
        file.floats(280, &[0.0, -3.0, 0.0, 10.0, 2.0, 0.0, 0.0, 20.0, 0.0, 0.0, 4.0, 30.0]);
        file.put(344, b"n+1\0");
        for number in 0..12_i16 {
            file.bytes.extend((number * 100 - 500).to_le_bytes());
        }
        file
    }

    fn put(&mut self, at: usize, field: &[u8]) -> &mut Self {
        self.bytes[at..at + field.len()].copy_from_slice(field);
        self
    }

    fn floats(&mut self, at: usize, numbers: &[f32]) -> &mut Self {
        for (n, number) in numbers.iter().enumerate() {
            self.put(at + 4 * n, &number.to_le_bytes());
        }
        self
    }

    fn read_as(&self, name: &str) -> Result<Scan> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join(name);
        let mut file = std::fs::File::create(&path).expect("made");
        if name.ends_with(".gz") {
            let mut packer = flate2::write::GzEncoder::new(file, flate2::Compression::default());
            packer.write_all(&self.bytes).and_then(|()| packer.finish().map(drop)).expect("written");
        } else {
            file.write_all(&self.bytes).expect("written");
        }
        nifti::read(&path, None)
    }

    fn read(&self) -> Result<Scan> {
        self.read_as("x.nii")
    }
}

fn place(scan: &Scan, index: [f64; 3]) -> DVec3 {
    scan.volume.grid().index_to_lps_mm().transform_point3(DVec3::from_array(index))
}

#[test]
fn values_are_where_they_belong() {
    for name in ["x.nii", "x.nii.gz"] {
        let scan = File::new().read_as(name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scan.volume.value([2, 1, 1]), 600.0, "{name}: the last voxel");
        // RAS (10 - 3j, 20 + 2i, 30 + 4k) is LPS with the first two turned around.
        assert_eq!(place(&scan, [2.0, 1.0, 1.0]), DVec3::new(-7.0, -24.0, 34.0), "{name}");
        assert!(scan.warnings.is_empty(), "{name}: nothing is assumed, found {:?}", scan.warnings);
    }
}

#[test]
fn a_slope_is_applied_and_a_slope_of_0_is_none() {
    let value = |slope, intercept| File::new().floats(112, &[slope, intercept]).read().unwrap().volume.value([1, 0, 0]);
    assert_eq!(value(2.0, 7.0), -400.0 * 2.0 + 7.0);
    assert_eq!(value(0.0, 7.0), -400.0);
}

#[test]
fn a_qform_is_a_rotation_with_a_handedness() {
    let mut file = File::new();
    file.put(254, &0_i16.to_le_bytes()).put(252, &1_i16.to_le_bytes());
    // Half a turn about z, and k mirrored.
    file.floats(76, &[-1.0]).floats(256, &[0.0, 0.0, 1.0, 5.0, 6.0, 7.0]);
    let scan = file.read().unwrap();
    let apart = place(&scan, [1.0, 1.0, 1.0]).distance(DVec3::new(2.0 - 5.0, 3.0 - 6.0, 7.0 - 4.0));
    assert!(apart < 1e-5, "found {:?}", place(&scan, [1.0, 1.0, 1.0]));
    let contradiction = file.put(254, &1_i16.to_le_bytes()).read().unwrap();
    assert!(
        contradiction.warnings.iter().any(|w| w.contains("sform and qform differ")),
        "{:?}",
        contradiction.warnings
    );
    let neither = File::new().put(254, &0_i16.to_le_bytes()).read().unwrap();
    assert!(neither.warnings.iter().any(|w| w.contains("neither sform nor qform")), "{:?}", neither.warnings);
}

#[test]
fn units_of_length_are_understood() {
    let metres = File::new().put(123, &[1]).read().unwrap();
    assert_eq!(metres.volume.grid().spacing_mm(), DVec3::new(2000.0, 3000.0, 4000.0));
    let unknown = File::new().put(123, &[0]).read().unwrap();
    assert!(unknown.warnings.iter().any(|w| w.contains("millimetres are assumed")), "{:?}", unknown.warnings);
}

#[test]
fn lies_are_refused() {
    let mut short = File::new();
    short.bytes.truncate(352 + 20);
    let mut cut = File::new();
    cut.bytes.truncate(200);
    let changed = |at: usize, field: &[u8]| {
        let mut file = File::new();
        file.put(at, field);
        file
    };
    let flat = {
        let mut file = File::new();
        file.floats(280, &[0.0; 12]);
        file
    };
    for (file, fault, says) in [
        (short, Fault::Input, "the data ends too early"),
        (cut, Fault::Input, "cut off"),
        (changed(42, &i16::MAX.to_le_bytes()), Fault::Input, "the data ends too early"),
        (changed(344, b"ni1\0"), Fault::Unsupported, "another file"),
        (changed(344, b"nope"), Fault::Input, "damaged or not NIfTI-1"),
        (changed(0, &540_i32.to_le_bytes()), Fault::Unsupported, "NIfTI-2"),
        (changed(70, &128_i16.to_le_bytes()), Fault::Input, "contradict"),
        (changed(72, &8_i16.to_le_bytes()), Fault::Input, "contradict"),
        (changed(108, &100_f32.to_le_bytes()), Fault::Input, "vox_offset"),
        (changed(108, &f32::NAN.to_le_bytes()), Fault::Input, "vox_offset"),
        (flat, Fault::Geometry, "do not span space"),
    ] {
        let error = file.read().expect_err(says);
        assert!(error.fault() == fault && error.to_string().contains(says), "expected {says}: found {error}");
        assert!(error.to_string().contains("x.nii"), "names the file: {error}");
    }
    for (at, size, what) in [(40, 4, "a fourth axis of one entry"), (48, 2, "the size of an axis beyond the last")] {
        let scan = changed(at, &i16::to_le_bytes(size)).read().unwrap_or_else(|error| panic!("{what}: {error}"));
        assert_eq!(scan.volume.grid().dims(), [3, 2, 2], "{what} is no lie");
    }
}
