//! The public scans that have labels, and which of those labels make up a tissue.

use std::ops::RangeInclusive;

use pellucid::volume::LabelMap;

/// A scan with its reference.
pub(crate) struct Scan {
    pub(crate) scan: &'static str,
    pub(crate) reference: &'static str,
    pub(crate) subjects: &'static [Subject],
}

/// A tissue of `pipelines/tissues.yaml`, its labels in the reference, and the Dice promised of it.
pub(crate) struct Subject {
    pub(crate) tissue: &'static str,
    pub(crate) labels: &'static [RangeInclusive<u16>],
    /// Voxel by voxel.
    pub(crate) promised: f64,
    /// With the cleaning of the pipeline.
    pub(crate) promised_cleaned: f64,
}

/// An organ that no preset is made for.
#[allow(dead_code, reason = "for the table, not for the tests")]
pub(crate) struct Organ {
    pub(crate) name: &'static str,
    pub(crate) labels: &'static [RangeInclusive<u16>],
}

pub(crate) const SCANS: [Scan; 2] = [
    Scan {
        scan: "abdomen/ct.nrrd",
        reference: "abdomen/labels.nrrd",
        subjects: &[
            // Vertebrae and sacrum, femora and hips, ribs.
            Subject { tissue: "bone", labels: &[25..=50, 75..=78, 92..=115], promised: 0.79, promised_cleaned: 0.85 },
            // Nothing is promised of the few slices of lung that this scan has.
            Subject { tissue: "lung", labels: &[10..=14], promised: 0.0, promised_cleaned: 0.0 },
        ],
    },
    Scan {
        scan: "abdomen/ct-slab.nrrd",
        reference: "abdomen/tissue-slab.nrrd",
        subjects: &[
            Subject { tissue: "fat", labels: &[1..=2], promised: 0.905, promised_cleaned: 0.925 },
            Subject { tissue: "muscle", labels: &[3..=3], promised: 0.47, promised_cleaned: 0.54 },
        ],
    },
];

#[allow(dead_code, reason = "for the table, not for the tests")]
pub(crate) const ORGANS: [Organ; 10] = [
    Organ { name: "liver", labels: &[5..=5] },
    Organ { name: "spleen", labels: &[1..=1] },
    Organ { name: "kidneys", labels: &[2..=3] },
    Organ { name: "stomach", labels: &[6..=6] },
    Organ { name: "small bowel, duodenum", labels: &[18..=19] },
    Organ { name: "colon", labels: &[20..=20] },
    Organ { name: "bladder", labels: &[21..=21] },
    Organ { name: "aorta, iliac arteries", labels: &[52..=52, 65..=66] },
    Organ { name: "veins", labels: &[63..=64, 67..=68] },
    Organ { name: "gluteal muscles, psoas, autochthonous back muscles", labels: &[80..=89] },
];

/// Positions in a reference of these labels.
pub(crate) fn positions(reference: &LabelMap, labels: &[RangeInclusive<u16>]) -> Vec<u8> {
    let wanted = |label: u16| labels.iter().any(|range| range.contains(&label));
    let segments = reference.segments().iter().zip(1_u8..=255);
    segments.filter(|(segment, _)| wanted(segment.label)).map(|(_, position)| position).collect()
}
