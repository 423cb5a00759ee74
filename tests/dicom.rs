//! Tests of dicom.
