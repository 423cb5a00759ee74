//! The shipped presets against labels made by others: what RESULTS.md promises, kept.

use std::path::Path;

use pellucid::io::dicom::SeriesChoice;
use pellucid::io::{load, read_labels};
use pellucid::plan::{Classification, VolumeInfo};
use pellucid::spec::Spec;
use pellucid::tissue::{Comparison, Pair, agreement, bound, classify, clean, confusion, fit, mask_of, picture};
use pellucid::volume::LabelMap;

use super::scans::{SCANS, Scan, positions};
use crate::support::scan_path;

fn pairs(scan: &Scan, labels: &LabelMap, reference: &LabelMap) -> Vec<Pair> {
    let pair = |subject: &super::scans::Subject| Pair {
        tissue: subject.tissue.to_owned(),
        label: labels.position_of(subject.tissue).expect("a tissue of the pipeline"),
        reference: positions(reference, subject.labels),
    };
    scan.subjects.iter().map(pair).collect()
}

#[test]
fn presets_agree_as_promised() {
    for scan in &SCANS {
        let (Some(path), Some(reference)) = (scan_path(scan.scan), scan_path(scan.reference)) else { return };
        let pipeline = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/tissues.yaml");
        let spec = Spec::load(&pipeline, &[]).unwrap();
        let volume = load(&path, &SeriesChoice::Largest, None).unwrap().volume;
        let reference = read_labels(&reference).unwrap();
        let tissues = Classification::new(&spec, &VolumeInfo::from(&volume)).unwrap();
        let labels = classify(&volume, &tissues).unwrap();
        let cleaned = clean(labels.clone(), &volume, &tissues).unwrap();
        for (labels, is_cleaned) in [(&labels, false), (&cleaned, true)] {
            let comparison = Comparison::new(labels, &reference, pairs(scan, labels, &reference)).unwrap();
            for (found, subject) in agreement(&comparison).unwrap().iter().zip(scan.subjects) {
                let promised = if is_cleaned { subject.promised_cleaned } else { subject.promised };
                let dice = found.dice.unwrap_or(0.0);
                assert!(dice >= promised, "{}, cleaned {is_cleaned}: Dice {dice}, promised {promised}", found.tissue);
            }
            let confusion = confusion(&comparison);
            let counted: u64 = confusion.voxels.iter().flatten().sum();
            assert_eq!(counted, labels.voxels().len() as u64, "every voxel is in the confusion table once");
        }
    }
}

/// Known from an independent program (numpy and scipy on the same files), to four digits.
#[test]
fn bounds_and_proposals_are_those_of_another_program() {
    for (scan, tissue, expected) in
        [(&SCANS[0], 0, [0.8056, 0.8109]), (&SCANS[1], 0, [0.8884, 0.9232]), (&SCANS[1], 1, [0.4570, 0.4911])]
    {
        let (Some(path), Some(reference)) = (scan_path(scan.scan), scan_path(scan.reference)) else { return };
        let volume = load(&path, &SeriesChoice::Largest, None).unwrap().volume;
        let reference = read_labels(&reference).unwrap();
        let mask = mask_of(&reference, &positions(&reference, scan.subjects[tissue].labels));
        let found = bound(&volume, &mask).unwrap();
        for (found, expected) in [found.by_value, found.by_value_and_gradient].into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-4, "{tissue} of {}: found {found}, expected {expected}", scan.scan);
        }
        let proposals = fit(&volume, &mask).unwrap();
        let best = proposals.last().expect("at least one").dice;
        let possible = found.by_value_and_gradient + 1e-9;
        assert!(best <= possible && best > 0.98 * found.by_value, "rectangles reach {best} of {possible}");
    }
}

#[test]
fn the_picture_shows_each_kind_of_voxel() {
    let scan = &SCANS[1];
    let (Some(_), Some(reference)) = (scan_path(scan.scan), scan_path(scan.reference)) else { return };
    let reference = read_labels(&reference).unwrap();
    // The same labels, moved by a slice's row: some agree, some are missing, some are too many.
    let width = reference.grid().dims()[0];
    let mut moved = reference.voxels().to_vec();
    moved.rotate_right(2 * width);
    let moved = LabelMap::new(*reference.grid(), reference.segments().to_vec(), moved).unwrap();
    let pair = Pair { tissue: "fat".to_owned(), label: 1, reference: vec![1] };
    let drawn = |labels| picture(&Comparison::new(labels, &reference, vec![pair.clone()]).unwrap(), None);
    let colors = |image: &pellucid::Image| {
        let mut colors: Vec<_> = image.pixels().iter().map(|p| p.map(f32::to_bits)).collect();
        colors.sort_unstable();
        colors.dedup();
        colors.len()
    };
    assert_eq!(colors(&drawn(&moved)), 4, "both, labels only, reference only, neither");
    assert_eq!(colors(&drawn(&reference)), 2, "of the same labels, both or neither");
}
