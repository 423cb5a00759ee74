//! Label volumes: a segmentation of a scan, on its lattice.
//!
//! Labels are whole numbers from 0 to 65535, one per voxel. A label volume must lie where its scan does: as many voxels, and
//! no corner farther than a hundredth of a voxel from that of the scan. Nothing is resampled, since a label halfway between
//! two others means nothing.
//!
//! Names come from the key/value pairs by which 3D Slicer describes segments (`Segment0_Name`, `Segment0_LabelValue`).

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;

use super::load::{Format, format_of};
use super::nrrd;
use crate::error::{Error, Fault, Result};
use crate::volume::{Grid, Volume};

/// How far a corner of the labels' lattice may be from the scan's, voxels.
const TOLERANCE_VOXELS: f64 = 0.01;

/// The labels of a scan's voxels.
#[derive(Debug, Clone, PartialEq)]
pub struct Labels {
    volume: Volume,
    names: BTreeMap<String, u16>,
    counts: BTreeMap<u16, u64>,
}

impl Labels {
    /// The labels that a volume holds as its values, with names.
    ///
    /// # Errors
    /// `Fault::Input` for a value that is no whole number from 0 to 65535.
    pub fn new(volume: Volume, names: impl IntoIterator<Item = (String, u16)>) -> Result<Self> {
        let mut counts = vec![0_u64; 1 << 16];
        for index in 0..volume.samples().len() {
            let value = volume.rescale().value(volume.samples().stored(index));
            if value.fract() != 0.0 || !(0.0..=65535.0).contains(&value) {
                let [i, j, k] = volume.grid().unflatten(index);
                return Err(Error::new(Fault::Input, "a voxel of the label volume holds no label")
                    .element(format!("voxel ({i}, {j}, {k})"))
                    .found(value.to_string())
                    .expected("a whole number from 0 to 65535"));
            }
            counts[value as usize] += 1;
        }
        let counts = counts.into_iter().zip(0..=u16::MAX).filter(|(count, _)| *count > 0);
        Ok(Labels {
            names: names.into_iter().collect(),
            counts: counts.map(|(count, label)| (label, count)).collect(),
            volume,
        })
    }

    /// Labels by their names, where the file names them.
    pub fn names(&self) -> &BTreeMap<String, u16> {
        &self.names
    }

    /// How many voxels have each label that occurs.
    pub fn counts(&self) -> &BTreeMap<u16, u64> {
        &self.counts
    }

    /// As [`Volume::values_sha256`].
    pub fn values_sha256(&self) -> String {
        self.volume.values_sha256()
    }

    /// A class for each voxel, x fastest, by its label.
    pub fn classes(&self, class_of: impl Fn(u16) -> u8) -> Vec<u8> {
        let table: Vec<u8> = (0..=u16::MAX).map(class_of).collect();
        let (samples, rescale) = (self.volume.samples(), self.volume.rescale());
        (0..samples.len()).map(|index| table[rescale.value(samples.stored(index)) as usize]).collect()
    }
}

/// Reads the labels of a scan on this lattice from a NRRD file.
///
/// # Errors
/// Those of [`nrrd::read`]; `Fault::Unsupported` for another format, `Fault::Geometry` for labels that do not lie where the
/// scan does, `Fault::Input` for values that are no labels.
pub fn read(path: &Path, scan: &Grid) -> Result<Labels> {
    if format_of(path)? != Format::Nrrd {
        return Err(Error::new(Fault::Unsupported, "labels are read from NRRD only")
            .at(path)
            .expected("a .nrrd or .nhdr file")
            .remedy("convert it with a program that keeps the geometry, such as 3D Slicer or SimpleITK"));
    }
    let (header, _) = nrrd::read_header(path)?;
    let volume = nrrd::read(path)?.volume;
    refuse_elsewhere(volume.grid(), scan).map_err(|error| error.at(path))?;
    Labels::new(volume, names(&header.key_values)).map_err(|error| error.at(path))
}

fn refuse_elsewhere(labels: &Grid, scan: &Grid) -> Result<()> {
    let remedy =
        "write the labels on the scan's own lattice, for example as a label map with the scan as its reference";
    let shape = |grid: &Grid| grid.dims().map(|n| n.to_string()).join(" x ");
    if labels.dims() != scan.dims() {
        return Err(Error::new(Fault::Geometry, "the labels are not on the scan's lattice")
            .found(format!("{} voxels", shape(labels)))
            .expected(format!("{}, as the scan", shape(scan)))
            .remedy(remedy));
    }
    let (low, high) = scan.index_bounds();
    let corners = (0..8).map(|c| DVec3::from_array([0, 1, 2].map(|a| if c >> a & 1 == 1 { high[a] } else { low[a] })));
    let apart = |corner: DVec3| {
        let there = scan.lps_mm_to_index().transform_point3(labels.index_to_lps_mm().transform_point3(corner));
        (there - corner).abs().max_element()
    };
    let farthest = corners.map(apart).fold(0.0, f64::max);
    if farthest <= TOLERANCE_VOXELS {
        return Ok(());
    }
    Err(Error::new(Fault::Geometry, "the labels do not lie where the scan does")
        .found(format!("corners up to {farthest:.3} voxels from the scan's"))
        .expected(format!("at most {TOLERANCE_VOXELS}"))
        .remedy(remedy))
}

/// The key/value pairs that name segments by number.
pub fn segments<'a>(names: impl IntoIterator<Item = (u16, &'a str)>) -> Vec<(String, String)> {
    let pairs = names.into_iter().enumerate().flat_map(|(n, (label, name))| {
        [
            ("ID", name.to_owned()),
            ("Name", name.to_owned()),
            ("LabelValue", label.to_string()),
            ("Layer", "0".to_owned()),
        ]
        .map(|(key, value)| (format!("Segment{n}_{key}"), value))
    });
    pairs.collect()
}

fn names(key_values: &[(String, String)]) -> Vec<(String, u16)> {
    let value_of = |key: &str| key_values.iter().find(|(k, _)| k == key).map(|(_, value)| value.as_str());
    let named = (0..).map_while(|n| {
        let name = value_of(&format!("Segment{n}_Name"))?;
        Some((name.to_owned(), value_of(&format!("Segment{n}_LabelValue"))?.trim().parse().ok()?))
    });
    named.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Quantity, Rescale, Samples};

    fn grid() -> Grid {
        Grid::axis_aligned([3, 2, 1], DVec3::new(0.5, 1.0, 2.0)).expect("a valid grid")
    }

    fn labels(samples: Samples, rescale: Rescale) -> Result<Labels> {
        let volume = Volume::new(grid(), samples, rescale, Quantity::Arbitrary).expect("a valid volume");
        Labels::new(volume, [("liver".to_owned(), 2)])
    }

    #[test]
    fn labels_are_counted_and_mapped_to_classes_whatever_their_storage() {
        let shifted = Rescale { slope: 1.0, intercept: 32768.0 };
        for (samples, rescale) in [
            (Samples::I16(vec![0, 2, 2, 7, 0, 2]), Rescale::IDENTITY),
            (Samples::I16([0, 2, 2, 7, 0, 2].map(|x: i32| (x - 32768) as i16).to_vec()), shifted),
            (Samples::F32(vec![0.0, 2.0, 2.0, 7.0, 0.0, 2.0]), Rescale::IDENTITY),
        ] {
            let labels = labels(samples, rescale).expect("whole numbers");
            assert_eq!(labels.counts().iter().map(|(l, n)| (*l, *n)).collect::<Vec<_>>(), [(0, 2), (2, 3), (7, 1)]);
            assert_eq!(labels.classes(|label| if label == 2 { 1 } else { 0 }), [0, 1, 1, 0, 0, 1]);
        }
    }

    #[test]
    fn what_is_no_label_is_refused_with_its_voxel() {
        for (value, text) in [(-1.0, "-1"), (0.5, "0.5"), (65536.0, "65536")] {
            let error = labels(Samples::F32(vec![0.0, 1.0, 2.0, 3.0, value, 5.0]), Rescale::IDENTITY).expect_err(text);
            let expected = format!("voxel (1, 1, 0)): found {text}, expected a whole number from 0 to 65535");
            assert!(error.to_string().ends_with(&expected), "found {error}");
        }
    }

    #[test]
    fn names_are_written_as_they_are_read() {
        let pairs = segments([(1, "skull"), (40, "left kidney")]);
        assert_eq!(names(&pairs), [("skull".to_owned(), 1), ("left kidney".to_owned(), 40)]);
        assert_eq!(names(&[]), []);
    }

    #[test]
    fn a_lattice_that_is_shifted_by_more_than_a_hundredth_of_a_voxel_is_refused() {
        let shifted = |mm: f64| {
            let mut affine = grid().index_to_lps_mm();
            affine.translation.x += mm;
            Grid::new([3, 2, 1], affine).expect("a valid grid")
        };
        assert!(refuse_elsewhere(&shifted(0.004), &grid()).is_ok(), "0.008 of a voxel");
        let error = refuse_elsewhere(&shifted(0.006), &grid()).expect_err("0.012 of a voxel");
        assert!(error.to_string().contains("up to 0.012 voxels"), "found {error}");
        let larger = Grid::axis_aligned([3, 2, 2], DVec3::new(0.5, 1.0, 2.0)).expect("a valid grid");
        let error = refuse_elsewhere(&larger, &grid()).expect_err("another size");
        assert!(error.to_string().contains("found 3 x 2 x 2 voxels, expected 3 x 2 x 1"), "found {error}");
    }
}
