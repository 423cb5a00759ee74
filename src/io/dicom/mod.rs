//! DICOM CT series: a folder of slices to a volume, and a volume to a series.
