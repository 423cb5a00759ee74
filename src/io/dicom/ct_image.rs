//! The CT Image IOD: PS3.3 §A.3, with every attribute of type 1 and 2.

use dicom_core::value::PrimitiveValue;
use dicom_core::{DataElement, Tag, VR};
use dicom_dictionary_std::{tags, uids};
use dicom_object::mem::InMemElement;
use dicom_object::{FileDicomObject, FileMetaTableBuilder, InMemDicomObject, WithMetaError};

use super::decimal_string::nearest;
use super::uid::{Seed, implementation_class};

/// What the slices of one series have in common.
pub(super) struct SeriesAttributes {
    pub(super) seed: Seed,
    pub(super) description: String,
    pub(super) rows: u16,
    pub(super) columns: u16,
    /// Row direction, then column direction.
    pub(super) cosines: [f64; 6],
    /// Between rows, then between columns.
    pub(super) pixel_spacing_mm: [f64; 2],
    /// Between slices, along the normal; `None` if it is not the same everywhere.
    pub(super) slice_spacing_mm: Option<f64>,
    /// Slope and intercept, as DS.
    pub(super) rescale: [String; 2],
    /// HU, or US for "unspecified" (PS3.3 §C.11.1.1.2).
    pub(super) rescale_type: &'static str,
}

impl SeriesAttributes {
    /// The file of slice `k`, whose first pixel lies at `position_mm`.
    pub(super) fn image(
        &self,
        k: usize,
        position_mm: [f64; 3],
        pixels: Vec<u16>,
    ) -> Result<FileDicomObject<InMemDicomObject>, WithMetaError> {
        let instance_uid = self.seed.uid("image", k as u64);
        let mut elements = self.patient_study_and_series();
        elements.extend(self.equipment_and_plane(k, position_mm));
        elements.extend(self.pixels(pixels));
        elements.extend([
            element(tags::SOP_CLASS_UID, VR::UI, uids::CT_IMAGE_STORAGE),
            element(tags::SOP_INSTANCE_UID, VR::UI, instance_uid.as_str()),
        ]);
        InMemDicomObject::from_element_iter(elements).with_meta(
            FileMetaTableBuilder::new()
                .media_storage_sop_class_uid(uids::CT_IMAGE_STORAGE)
                .media_storage_sop_instance_uid(instance_uid)
                .transfer_syntax(uids::EXPLICIT_VR_LITTLE_ENDIAN)
                .implementation_class_uid(implementation_class())
                .implementation_version_name("PELLUCID"),
        )
    }

    /// Patient, General Study, General Series, Frame of Reference: §C.7.1.1, §C.7.2.1, §C.7.3.1, §C.7.4.1.
    fn patient_study_and_series(&self) -> Vec<InMemElement> {
        let mut elements: Vec<InMemElement> = [
            (tags::PATIENT_NAME, VR::PN, "PHANTOM"),
            (tags::PATIENT_ID, VR::LO, "PHANTOM"),
            (tags::PATIENT_SEX, VR::CS, "O"),
            (tags::STUDY_ID, VR::SH, "1"),
            (tags::SERIES_NUMBER, VR::IS, "1"),
            (tags::MODALITY, VR::CS, "CT"),
            (tags::PATIENT_POSITION, VR::CS, "HFS"),
            (tags::SPECIFIC_CHARACTER_SET, VR::CS, "ISO_IR 192"),
            (tags::SERIES_DESCRIPTION, VR::LO, self.description.as_str()),
        ]
        .map(|(tag, vr, value)| element(tag, vr, value))
        .into();
        elements.extend(
            [
                (tags::STUDY_INSTANCE_UID, "study"),
                (tags::SERIES_INSTANCE_UID, "series"),
                (tags::FRAME_OF_REFERENCE_UID, "frame of reference"),
            ]
            .map(|(tag, what)| element(tag, VR::UI, self.seed.uid(what, 0))),
        );
        // Type 2: there, and empty.
        let unknown = [
            (tags::PATIENT_BIRTH_DATE, VR::DA),
            (tags::STUDY_DATE, VR::DA),
            (tags::STUDY_TIME, VR::TM),
            (tags::REFERRING_PHYSICIAN_NAME, VR::PN),
            (tags::ACCESSION_NUMBER, VR::SH),
            (tags::POSITION_REFERENCE_INDICATOR, VR::LO),
            (tags::KVP, VR::DS),
            (tags::ACQUISITION_NUMBER, VR::IS),
        ];
        elements.extend(unknown.map(|(tag, vr)| DataElement::new(tag, vr, PrimitiveValue::Empty)));
        elements
    }

    /// General Equipment, General Image, Image Plane: §C.7.5.1, §C.7.6.1, §C.7.6.2.
    fn equipment_and_plane(&self, k: usize, position_mm: [f64; 3]) -> Vec<InMemElement> {
        let list = |numbers: &[f64]| numbers.iter().map(|&number| nearest(number)).collect::<Vec<_>>().join("\\");
        let spacing = self.slice_spacing_mm.map(nearest);
        let mut elements = vec![
            element(tags::MANUFACTURER, VR::LO, "pellucid"),
            element(tags::IMAGE_TYPE, VR::CS, "DERIVED\\SECONDARY\\AXIAL"),
            element(tags::INSTANCE_NUMBER, VR::IS, (k + 1).to_string()),
            element(tags::PIXEL_SPACING, VR::DS, list(&self.pixel_spacing_mm)),
            element(tags::IMAGE_ORIENTATION_PATIENT, VR::DS, list(&self.cosines)),
            element(tags::IMAGE_POSITION_PATIENT, VR::DS, list(&position_mm)),
            // Type 2: empty where there is none to tell.
            element(tags::SLICE_THICKNESS, VR::DS, spacing.clone().unwrap_or_default()),
        ];
        elements.extend(spacing.map(|mm| element(tags::SPACING_BETWEEN_SLICES, VR::DS, mm)));
        elements
    }

    /// Image Pixel, CT Image: §C.7.6.3, §C.8.2.1.
    fn pixels(&self, pixels: Vec<u16>) -> Vec<InMemElement> {
        let number = |tag, value: u16| DataElement::new(tag, VR::US, PrimitiveValue::from(value));
        let [slope, intercept] = &self.rescale;
        vec![
            number(tags::SAMPLES_PER_PIXEL, 1),
            element(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME2"),
            number(tags::ROWS, self.rows),
            number(tags::COLUMNS, self.columns),
            number(tags::BITS_ALLOCATED, 16),
            number(tags::BITS_STORED, 16),
            number(tags::HIGH_BIT, 15),
            number(tags::PIXEL_REPRESENTATION, 1),
            element(tags::RESCALE_SLOPE, VR::DS, slope.as_str()),
            element(tags::RESCALE_INTERCEPT, VR::DS, intercept.as_str()),
            element(tags::RESCALE_TYPE, VR::LO, self.rescale_type),
            DataElement::new(tags::PIXEL_DATA, VR::OW, PrimitiveValue::U16(pixels.into())),
        ]
    }
}

fn element(tag: Tag, vr: VR, value: impl Into<PrimitiveValue>) -> InMemElement {
    DataElement::new(tag, vr, value.into())
}
