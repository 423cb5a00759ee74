//! The chest phantom: its anatomy at named points, what is on which side, its label map, and that it is always the same.

use std::fmt::Write as _;
use std::sync::LazyLock;

use glam::DVec3;
use pellucid::Volume;
use pellucid::synthetic::{BodyPhantom, Region, body, body_labels};

use crate::support::scenes::{digest_on, stored, value_at};

/// The phantom of the default size, without noise.
static CHEST: LazyLock<Volume> = LazyLock::new(|| make(256, 1, 0.0));
/// Its label map.
static LABELS: LazyLock<Volume> = LazyLock::new(|| body_labels(Region::Chest, 256).expect("it can be made"));

fn make(size: usize, seed: u64, noise_hu: f64) -> Volume {
    body(&BodyPhantom { region: Region::Chest, size, seed, noise_hu }).expect("the phantom can be made")
}

/// The name of the structure at a point; empty outside of the body.
fn structure_at(point: [f64; 3]) -> &'static str {
    let number = value_at(&LABELS, point) as u16;
    Region::Chest.structures().find(|&(n, _)| n == number).map_or("", |(_, name)| name)
}

/// The number of a structure in the label map.
fn number_of(structure: &str) -> i16 {
    let found = Region::Chest.structures().find(|&(_, name)| name == structure);
    found.expect("a structure of the chest").0.try_into().expect("few structures")
}

/// Places in mm of the voxels for which something holds of value and label.
fn places(holds: impl Fn(i16, i16) -> bool) -> Vec<DVec3> {
    let grid = CHEST.grid();
    let both = stored(&CHEST).iter().zip(stored(&LABELS)).enumerate();
    both.filter(|&(_, (&hu, &label))| holds(hu, label))
        .map(|(index, _)| grid.index_to_lps_mm().transform_point3(grid.unflatten(index).map(|n| n as f64).into()))
        .collect()
}

fn mean(places: &[DVec3]) -> DVec3 {
    places.iter().sum::<DVec3>() / places.len() as f64
}

#[test]
fn tissues_are_where_the_atlas_has_them() {
    let points: [(&str, [f64; 3], [f64; 2], &str); 32] = [
        ("air before the chest", [0.0, -150.0, 0.0], [-1000.0, -1000.0], ""),
        ("fat of the back", [60.0, 108.0, -60.0], [-105.0, -90.0], "skin"),
        ("pectoral muscle", [60.0, -96.0, 58.0], [45.0, 65.0], "muscle"),
        ("erector of the spine", [27.0, 92.0, -30.0], [45.0, 65.0], "muscle"),
        ("fat behind the breast bone", [4.0, -50.0, 100.0], [-105.0, -90.0], "mediastinum"),
        ("air in the stomach", [60.0, -30.0, -90.0], [-1000.0, -980.0], "abdomen"),
        ("what else is in it", [66.0, 20.0, -90.0], [15.0, 25.0], "abdomen"),
        ("liver", [-62.0, 4.0, -60.0], [60.0, 75.0], "liver"),
        ("left lung", [90.0, 20.0, -10.0], [-900.0, -820.0], "lungs"),
        ("right lung", [-90.0, 20.0, -10.0], [-900.0, -820.0], "lungs"),
        ("windpipe", [-1.0, 0.0, 150.0], [-1000.0, -980.0], "airways"),
        ("right main bronchus", [-28.0, 18.0, 59.0], [-1000.0, -900.0], "airways"),
        ("left main bronchus", [26.0, 21.5, 60.0], [-1000.0, -900.0], "airways"),
        ("ascending aorta", [-14.0, -36.0, 68.0], [340.0, 350.0], "vessels"),
        ("arch of the aorta", [8.0, -6.0, 103.0], [340.0, 350.0], "vessels"),
        ("descending aorta", [27.0, 45.0, 10.0], [340.0, 350.0], "vessels"),
        ("pulmonary trunk", [19.0, -40.0, 60.0], [290.0, 300.0], "vessels"),
        ("superior caval vein", [-38.0, -24.0, 54.0], [255.0, 270.0], "vessels"),
        ("inferior caval vein", [-29.0, 8.0, -75.0], [80.0, 95.0], "vessels"),
        ("left ventricle", [33.0, -24.0, 2.0], [340.0, 350.0], "heart"),
        ("its wall", [63.0, -14.0, 2.0], [100.0, 135.0], "heart"),
        ("the septum", [19.0, -42.0, -6.0], [100.0, 160.0], "heart"),
        ("muscle at the apex", [64.0, -55.0, -24.0], [100.0, 140.0], "heart"),
        ("right ventricle", [0.0, -50.0, -14.0], [260.0, 275.0], "heart"),
        ("right atrium", [-40.0, -24.0, 6.0], [260.0, 275.0], "heart"),
        ("left atrium", [2.0, 12.0, 26.0], [335.0, 350.0], "heart"),
        ("marrow of the eighth vertebra", [0.0, 59.0, 4.5], [200.0, 450.0], "spine"),
        ("spinal cord", [0.0, 82.0, 4.5], [15.0, 40.0], "spine"),
        ("a rib at the left side", [100.0, 60.0, -95.0], [150.0, 800.0], "ribs"),
        ("breast bone", [0.0, -88.0, 30.0], [150.0, 700.0], "sternum"),
        ("left clavicle", [74.0, -62.0, 140.0], [150.0, 700.0], "shoulders"),
        ("left shoulder blade", [92.0, 71.0, 82.0], [150.0, 900.0], "shoulders"),
    ];
    let mut wrong = String::new();
    for (name, point, [low, high], structure) in points {
        let (hu, found) = (value_at(&CHEST, point), structure_at(point));
        if !(low..=high).contains(&hu) || found != structure {
            writeln!(
                wrong,
                "{name} at {point:?}: found {hu} HU in {found:?}, expected {low} to {high} in {structure:?}"
            )
            .unwrap();
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn organs_are_on_their_sides() {
    let (heart, liver) = (number_of("heart"), number_of("liver"));
    let heart_mm = mean(&places(|_, label| label == heart));
    assert!((5.0..25.0).contains(&heart_mm.x), "most of the heart is left of the midline: found it at {heart_mm}");
    let apex = places(|hu, label| label == heart && hu > 80).into_iter().max_by(|a, b| a.x.total_cmp(&b.x)).unwrap();
    assert!(apex.x > 60.0 && apex.y < heart_mm.y, "the apex is on the left and in front: found {apex}");
    let [left, right] =
        [350, 270].map(|hu_of_blood: i16| mean(&places(|hu, label| label == heart && (hu - hu_of_blood).abs() < 6)));
    assert!(left.x > right.x + 20.0, "left chambers at {left}, right ones at {right}");
    assert!(left.y > right.y + 15.0, "the left chambers lie behind the right ones: {left} and {right}");
    let liver_mm = mean(&places(|_, label| label == liver));
    assert!(liver_mm.x < -30.0, "the liver is on the right: found {liver_mm}");
    for z in [60.0, 10.0, -40.0, -90.0] {
        let lower = places(|hu, label| label == number_of("vessels") && hu > 330);
        let section: Vec<DVec3> = lower.into_iter().filter(|p| (p.z - z).abs() < 1.5 && p.y > 15.0).collect();
        let aorta = mean(&section);
        assert!(aorta.x > 15.0, "the aorta descends on the left of the spine: at z = {z} found {aorta}");
    }
    let dome = |side: f64| {
        let below = places(|_, label| label == liver || label == number_of("abdomen"));
        below.into_iter().filter(|p| p.x * side > 30.0).map(|p| p.z).fold(f64::MIN, f64::max)
    };
    let [on_right, on_left] = [dome(-1.0), dome(1.0)];
    assert!(on_right > on_left + 5.0, "the right dome of the diaphragm is higher: {on_right} and {on_left} mm");
}

#[test]
fn organs_are_as_large_as_they_should_be() {
    let voxel_ml = CHEST.grid().spacing_mm().element_product() / 1000.0;
    let ml = |structure: &str| {
        let number = number_of(structure);
        stored(&LABELS).iter().filter(|&&label| label == number).count() as f64 * voxel_ml
    };
    for (structure, expected_ml) in
        [("lungs", 2500.0..4500.0), ("heart", 500.0..800.0), ("liver", 800.0..1500.0), ("airways", 60.0..140.0)]
    {
        let found_ml = ml(structure);
        assert!(expected_ml.contains(&found_ml), "{structure}: found {found_ml:.0} ml, expected {expected_ml:?}");
    }
    let heart = number_of("heart");
    let blood_ml = places(|hu, label| label == heart && hu > 200).len() as f64 * voxel_ml;
    assert!((250.0..450.0).contains(&blood_ml), "blood in the chambers: found {blood_ml:.0} ml");
}

#[test]
fn the_chest_fits_the_field_of_view_and_is_cut_above_and_below_only() {
    let [nx, ny, nz] = CHEST.grid().dims();
    assert_eq!([nx, ny, nz], [256, 256, 171]);
    let low = CHEST.grid().index_to_lps_mm().transform_point3(DVec3::splat(-0.5));
    assert!((low - DVec3::new(-180.0, -178.0, -130.0)).length() < 1e-9, "lower corner: found {low}");
    let voxels = stored(&CHEST);
    let at = |i: usize, j: usize, k: usize| voxels[(k * ny + j) * nx + i];
    for k in 0..nz {
        let around = (0..ny)
            .flat_map(|j| [at(0, j, k), at(nx - 1, j, k)])
            .chain((0..nx).flat_map(|i| [at(i, 0, k), at(i, ny - 1, k)]));
        assert_eq!(around.filter(|&hu| hu > -990).count(), 0, "voxels of tissue in the side walls of slice {k}");
    }
    for k in [0, nz - 1] {
        assert!(voxels[k * nx * ny..(k + 1) * nx * ny].iter().any(|&hu| hu > 0), "slice {k} cuts the body");
    }
}

#[test]
fn all_structures_occur_and_lie_on_the_lattice_of_the_scan() {
    assert_eq!(LABELS.grid(), CHEST.grid());
    let numbers: Vec<u16> = Region::Chest.structures().map(|(number, _)| number).collect();
    for number in numbers {
        let count = stored(&LABELS).iter().filter(|&&label| label as u16 == number).count();
        assert!(count > 100, "structure {number}: found {count} voxels");
    }
}

#[test]
fn one_thread_and_two_make_the_same_bytes_on_every_machine() {
    let digest = |threads| digest_on(threads, || make(64, 7, 5.0));
    let one = digest(1);
    assert_eq!(one, digest(2), "bytes depend on the number of threads");
    assert_eq!(one, SNAPSHOT, "the phantom has changed; if that was meant, take over the new digest");
}

/// Digest of our own output: size 64, seed 7, noise of 5 HU.
const SNAPSHOT: &str = "d30424c65ce7f6b84c36c025416eaf5bcbc8cde0e52cac6a35ccf615cf48ef83";
