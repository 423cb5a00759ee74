//! What becomes of the files of a folder, and which series is read.

use dicom_core::VR;
use dicom_dictionary_std::tags;
use pellucid::Fault;
use pellucid::io::FileFate;
use pellucid::io::dicom::{SeriesChoice, Verdict, read, scan_folder};

use super::slices::{SliceFile, folder_of};

fn fate<'a>(files: &'a [FileFate], name: &str) -> &'a FileFate {
    files.iter().find(|fate| fate.path.ends_with(name)).unwrap_or_else(|| panic!("{name} has no fate in {files:?}"))
}

/// Three slices of the usual series, a localizer within it, two slices of another series, and files of other kinds.
fn mixed_folder() -> super::slices::Scratch {
    let mut slices = SliceFile::stack(3);
    slices.push(SliceFile::axial(0).text(tags::IMAGE_TYPE, VR::CS, "ORIGINAL\\PRIMARY\\LOCALIZER").text(
        tags::IMAGE_ORIENTATION_PATIENT,
        VR::DS,
        "1\\0\\0\\0\\0\\-1",
    ));
    for k in 0..2 {
        slices.push(
            SliceFile::axial(k)
                .text(tags::SERIES_INSTANCE_UID, VR::UI, "1.2.77")
                .text(tags::SERIES_NUMBER, VR::IS, "12")
                .text(tags::SERIES_DESCRIPTION, VR::LO, "Head 2.0 brain"),
        );
    }
    let scratch = folder_of(slices);
    std::fs::create_dir(scratch.path().join("deeper")).unwrap();
    std::fs::write(scratch.path().join("deeper/notes.txt"), "not a slice").unwrap();
    SliceFile::axial(0)
        .without(tags::ROWS)
        .text(tags::MODALITY, VR::CS, "RTSTRUCT")
        .write(scratch.path().join("deeper/contours.dcm"));
    scratch
}

#[test]
fn every_file_has_a_fate_and_the_localizer_stays_apart() {
    let folder = mixed_folder();
    let scan = folder.read().unwrap();
    assert_eq!(scan.volume.grid().dims()[2], 3, "slices of the largest series");
    assert_eq!(scan.files.len(), 8, "found {:?}", scan.files);
    let expected = [
        ("s00.dcm", true, "a slice of the series"),
        ("s03.dcm", false, "a localizer"),
        ("s04.dcm", false, "of another series: number 12, 'Head 2.0 brain'"),
        ("notes.txt", false, "not a DICOM file"),
        ("contours.dcm", false, "not an image (modality 'RTSTRUCT')"),
    ];
    for (name, used, reason) in expected {
        let found = fate(&scan.files, name);
        assert_eq!(found.used, used, "{name}: {}", found.reason);
        assert!(found.reason.contains(reason), "{name}: found '{}', expected '{reason}'", found.reason);
    }
}

#[test]
fn a_folder_lists_its_series_with_verdicts() {
    let folder = mixed_folder();
    let found = scan_folder(folder.path()).unwrap();
    let summary: Vec<_> =
        found.series.iter().map(|s| (s.number, s.dims[2], s.verdict == Verdict::Renderable)).collect();
    assert_eq!(summary, [(Some(3), 3, true), (Some(12), 2, true), (Some(3), 1, false)]);
    let first = &found.series[0];
    assert_eq!(first.spacing_mm, Some([0.5, 0.8, 2.0]), "between columns, rows, slices");
    assert_eq!(first.position_range_mm, Some([0.0, 4.0]));
    assert_eq!(first.transfer_syntax, "Explicit VR Little Endian (1.2.840.10008.1.2.1)");
    assert!(first.decodable, "little endian is decoded");
    assert_eq!(first.files().len(), 3);
    assert_eq!(found.others.len(), 2, "found {:?}", found.others);
}

#[test]
fn nothing_of_the_patient_is_kept() {
    let folder = mixed_folder();
    let text = format!("{:?} {:?}", scan_folder(folder.path()).unwrap(), folder.read().unwrap());
    assert!(!text.contains("SECRET"), "a patient's name or ID is in what was read");
}

#[test]
fn series_are_chosen_by_uid_number_or_description() {
    let folder = mixed_folder();
    let slices = |name: &str| {
        read(folder.path(), &SeriesChoice::Named(name.to_owned()), None).map(|scan| scan.volume.grid().dims()[2])
    };
    for name in ["1.2.77", "12", "head 2.0 BRAIN", "brain"] {
        assert_eq!(slices(name).ok(), Some(2), "'{name}' is the brain series");
    }
    // The localizer has this UID, number and description too; its slices are meant.
    for name in ["1.2.3", "3", "bone"] {
        assert_eq!(slices(name).ok(), Some(3), "'{name}' is the bone series");
    }
    for (name, part) in [("head", "several series are called 'head'"), ("liver", "no series is called 'liver'")] {
        let error = slices(name).unwrap_err();
        assert_eq!(error.fault(), Fault::Input);
        let message = error.to_string();
        assert!(message.contains(part), "expected '{part}' in: {message}");
        for listed in ["number 12, 'Head 2.0 brain'", "number 3, 'Head 2.0 bone'", "1.2.77"] {
            assert!(message.contains(listed), "expected '{listed}' in: {message}");
        }
    }
}

#[test]
fn damaged_images_are_warned_of_and_named() {
    let folder = folder_of(SliceFile::stack(3));
    let whole = std::fs::read(folder.path().join("s02.dcm")).unwrap();
    std::fs::write(folder.path().join("t.dcm"), &whole[..500]).unwrap();
    SliceFile::axial(3).without(tags::BITS_STORED).write(folder.path().join("u.dcm"));
    let scan = folder.read().unwrap();
    assert_eq!(scan.warnings, ["2 files may be images but could not be read; see the list of files"]);
    let cases = [("t.dcm", "the header cannot be read"), ("u.dcm", "BitsStored (0028,0101) is missing")];
    for (name, reason) in cases {
        let found = fate(&scan.files, name);
        assert!(!found.used && found.reason.contains(reason), "{name}: found '{}', expected '{reason}'", found.reason);
    }
}

#[test]
fn equally_large_series_must_be_chosen_by_name() {
    let mut slices = SliceFile::stack(2);
    slices.extend(SliceFile::stack(2).into_iter().map(|s| s.text(tags::SERIES_INSTANCE_UID, VR::UI, "1.2.77")));
    let (fault, message) = folder_of(slices).refusal();
    assert_eq!(fault, Fault::Input);
    assert!(message.contains("several series are equally large"), "found: {message}");
}

#[test]
fn slices_of_another_geometry_are_set_apart_with_a_warning() {
    for (tag, value) in [(tags::IMAGE_ORIENTATION_PATIENT, "1\\0\\0\\0\\0\\-1"), (tags::PIXEL_SPACING, "0.8\\0.6")] {
        let mut slices = SliceFile::stack(3);
        slices.push(SliceFile::axial(3).text(tag, VR::DS, value));
        let scan = folder_of(slices).read().unwrap();
        assert_eq!(scan.volume.grid().dims()[2], 3);
        let warning = "1 images of the same series have another geometry";
        assert!(scan.warnings.iter().any(|w| w.contains(warning)), "found {:?}", scan.warnings);
        assert_eq!(fate(&scan.files, "s03.dcm").reason, "of the same series, with another geometry");
    }
}

#[test]
fn folders_without_images_and_paths_that_are_not_there_say_so() {
    let folder = folder_of(Vec::new());
    std::fs::write(folder.path().join("a.txt"), "text").unwrap();
    let (fault, message) = folder.refusal();
    assert_eq!(fault, Fault::Input);
    assert!(
        message.contains("no DICOM image found") && message.contains("a.txt: not a DICOM file"),
        "found: {message}"
    );
    let error = scan_folder(&folder.path().join("nowhere")).unwrap_err();
    assert_eq!(error.fault(), Fault::Input, "{error}");
}

#[test]
fn a_single_file_is_a_series_of_one_slice() {
    let folder = folder_of(SliceFile::stack(2));
    let scan = read(&folder.path().join("s01.dcm"), &SeriesChoice::Largest, None).unwrap();
    assert_eq!(scan.volume.grid().dims()[2], 1);
}

#[test]
fn a_limit_on_memory_is_held_before_anything_is_decoded() {
    let folder = folder_of(SliceFile::stack(3));
    let unlimited = read(folder.path(), &SeriesChoice::Largest, None).unwrap();
    let bytes = unlimited.reading_bytes;
    assert!(bytes >= 2 * 3 * 20, "at least the volume: found {bytes}");
    assert!(read(folder.path(), &SeriesChoice::Largest, Some(bytes)).is_ok(), "{bytes} bytes suffice");
    let error = read(folder.path(), &SeriesChoice::Largest, Some(bytes - 1)).unwrap_err();
    assert_eq!(error.fault(), Fault::Limit, "{error}");
    let expected = format!("found {bytes} bytes, expected at most {} bytes", bytes - 1);
    assert!(error.to_string().contains(&expected), "found: {error}");
}
