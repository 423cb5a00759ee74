//! Slices made attribute by attribute, in a folder that goes when the test ends.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use dicom_core::value::{PixelFragmentSequence, PrimitiveValue};
use dicom_core::{DataElement, Tag, VR};
use dicom_dictionary_std::{tags, uids};
use dicom_object::{FileMetaTableBuilder, InMemDicomObject};
use pellucid::io::Scan;
use pellucid::io::dicom::{SeriesChoice, read};

/// Columns and rows of a slice, unless a test says otherwise.
pub(super) const COLUMNS: usize = 5;
pub(super) const ROWS: usize = 4;

/// A folder of its own for one test.
pub(super) struct Scratch(PathBuf);

impl Scratch {
    pub(super) fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("pellucid-dicom-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).unwrap();
        Scratch(path)
    }

    pub(super) fn path(&self) -> &Path {
        &self.0
    }

    /// Reads the largest series.
    pub(super) fn read(&self) -> pellucid::Result<Scan> {
        read(self.path(), &SeriesChoice::Largest, None)
    }

    /// The whole message of the error that reading gives, and its fault.
    pub(super) fn refusal(&self) -> (pellucid::Fault, String) {
        let error = self.read().map(|scan| scan.volume.grid().dims()).expect_err("the series should be refused");
        (error.fault(), error.to_string())
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Stored value of a voxel: different for every voxel, so that no two axes can be confused.
pub(super) fn stored(i: usize, j: usize, k: usize) -> i16 {
    (100 * k + 10 * j + i) as i16 - 300
}

/// One CT slice in the making.
pub(super) struct SliceFile {
    object: InMemDicomObject,
    syntax: &'static str,
}

impl SliceFile {
    /// An axial slice of [`stored`] at z = 2 k mm, pixels of 0.5 mm across and 0.8 mm down, slope 1 and intercept -24.
    pub(super) fn axial(k: usize) -> Self {
        let slice = SliceFile { object: InMemDicomObject::new_empty(), syntax: uids::EXPLICIT_VR_LITTLE_ENDIAN };
        let values = (0..ROWS * COLUMNS).map(|n| stored(n % COLUMNS, n / COLUMNS, k).cast_unsigned()).collect();
        slice
            .text(tags::SOP_CLASS_UID, VR::UI, uids::CT_IMAGE_STORAGE)
            .text(tags::SOP_INSTANCE_UID, VR::UI, &format!("1.2.3.{k}"))
            .text(tags::SERIES_INSTANCE_UID, VR::UI, "1.2.3")
            .text(tags::FRAME_OF_REFERENCE_UID, VR::UI, "1.2.4")
            .text(tags::PATIENT_NAME, VR::PN, "SECRET^NAME")
            .text(tags::PATIENT_ID, VR::LO, "SECRET-ID")
            .text(tags::MODALITY, VR::CS, "CT")
            .text(tags::IMAGE_TYPE, VR::CS, "ORIGINAL\\PRIMARY\\AXIAL")
            .text(tags::SERIES_NUMBER, VR::IS, "3")
            .text(tags::SERIES_DESCRIPTION, VR::LO, "Head 2.0 bone")
            .at_mm([-10.0, 20.0, 2.0 * k as f64])
            .text(tags::IMAGE_ORIENTATION_PATIENT, VR::DS, "1\\0\\0\\0\\1\\0")
            .text(tags::PIXEL_SPACING, VR::DS, "0.8\\0.5")
            .text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME2")
            .number(tags::SAMPLES_PER_PIXEL, 1)
            .bits(16, 16, true)
            .rescale("1", "-24")
            .words(COLUMNS, ROWS, values)
    }

    /// Slices 0 to n - 1.
    pub(super) fn stack(n: usize) -> Vec<Self> {
        (0..n).map(SliceFile::axial).collect()
    }

    pub(super) fn text(mut self, tag: Tag, vr: VR, value: &str) -> Self {
        self.object.put(DataElement::new(tag, vr, value));
        self
    }

    pub(super) fn number(mut self, tag: Tag, value: u16) -> Self {
        self.object.put(DataElement::new(tag, VR::US, PrimitiveValue::from(value)));
        self
    }

    pub(super) fn without(mut self, tag: Tag) -> Self {
        self.object.remove_element(tag);
        self
    }

    /// A sequence of items.
    pub(super) fn sequence(mut self, tag: Tag, items: Vec<InMemDicomObject>) -> Self {
        self.object.put(DataElement::new(tag, VR::SQ, dicom_core::value::DataSetSequence::from(items)));
        self
    }

    pub(super) fn at_mm(self, [x, y, z]: [f64; 3]) -> Self {
        self.text(tags::IMAGE_POSITION_PATIENT, VR::DS, &format!("{x}\\{y}\\{z}"))
    }

    pub(super) fn rescale(self, slope: &str, intercept: &str) -> Self {
        self.text(tags::RESCALE_SLOPE, VR::DS, slope).text(tags::RESCALE_INTERCEPT, VR::DS, intercept)
    }

    pub(super) fn bits(self, allocated: u16, stored: u16, signed: bool) -> Self {
        self.number(tags::BITS_ALLOCATED, allocated)
            .number(tags::BITS_STORED, stored)
            .number(tags::HIGH_BIT, stored - 1)
            .number(tags::PIXEL_REPRESENTATION, u16::from(signed))
    }

    /// 16-bit cells.
    pub(super) fn words(mut self, columns: usize, rows: usize, cells: Vec<u16>) -> Self {
        self.object.put(DataElement::new(tags::PIXEL_DATA, VR::OW, PrimitiveValue::U16(cells.into())));
        self.size(columns, rows)
    }

    /// 8-bit cells, padded to an even length.
    pub(super) fn bytes(mut self, columns: usize, rows: usize, mut cells: Vec<u8>) -> Self {
        if cells.len() % 2 == 1 {
            cells.push(0);
        }
        self.object.put(DataElement::new(tags::PIXEL_DATA, VR::OB, PrimitiveValue::U8(cells.into())));
        self.size(columns, rows)
    }

    /// One compressed frame.
    pub(super) fn compressed(
        mut self,
        syntax: &'static str,
        columns: usize,
        rows: usize,
        mut fragment: Vec<u8>,
    ) -> Self {
        if fragment.len() % 2 == 1 {
            fragment.push(0);
        }
        let fragments = PixelFragmentSequence::new_fragments(vec![fragment]);
        self.object.put(DataElement::new(tags::PIXEL_DATA, VR::OB, fragments));
        self.syntax(syntax).size(columns, rows)
    }

    pub(super) fn syntax(mut self, syntax: &'static str) -> Self {
        self.syntax = syntax;
        self
    }

    fn size(self, columns: usize, rows: usize) -> Self {
        self.number(tags::COLUMNS, columns as u16).number(tags::ROWS, rows as u16)
    }

    pub(super) fn write(self, path: PathBuf) {
        let meta = FileMetaTableBuilder::new()
            .media_storage_sop_class_uid(uids::CT_IMAGE_STORAGE)
            .media_storage_sop_instance_uid("1.2.3.9")
            .transfer_syntax(self.syntax);
        self.object.with_meta(meta).unwrap().write_to_file(path).unwrap();
    }
}

/// Writes slices as `s00.dcm`, `s01.dcm`, … into a folder of their own.
pub(super) fn folder_of(slices: Vec<SliceFile>) -> Scratch {
    let scratch = Scratch::new();
    for (n, slice) in slices.into_iter().enumerate() {
        slice.write(scratch.path().join(format!("s{n:02}.dcm")));
    }
    scratch
}

/// Asserts the value of every voxel of a stack of [`SliceFile::axial`] slices.
pub(super) fn assert_values(scan: &Scan, expected: impl Fn(usize, usize, usize) -> f64) {
    let [nx, ny, nz] = scan.volume.grid().dims();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let (found, expected) = (scan.volume.value([i, j, k]), expected(i, j, k));
                assert_eq!(found, expected, "voxel ({i}, {j}, {k})");
            }
        }
    }
}
