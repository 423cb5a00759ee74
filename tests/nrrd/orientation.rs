//! Where the voxels lie in the patient, LPS mm.

use glam::{DAffine3, DVec3};
use pellucid::Fault;
use pellucid::io::{Scan, nrrd};

use super::Folder;

/// A 3 x 2 x 2 volume of bytes with these lines in its header.
fn read(lines: &str) -> pellucid::Result<Scan> {
    let folder = Folder::new();
    let bytes: Vec<u8> = (0..12).collect();
    let header = format!("NRRD0005\ntype: uint8\nencoding: raw\ndimension: 3\nsizes: 3 2 2\n{lines}");
    nrrd::read(&folder.nrrd("a.nrrd", &header, &bytes))
}

fn affine(lines: &str) -> DAffine3 {
    read(lines).unwrap_or_else(|e| panic!("{lines}: {e}")).volume.grid().index_to_lps_mm()
}

fn warnings(lines: &str) -> Vec<String> {
    read(lines).unwrap_or_else(|e| panic!("{lines}: {e}")).warnings
}

fn error(lines: &str) -> (Fault, String) {
    let error = read(lines).map(|_| ()).unwrap_err();
    (error.fault(), error.to_string().split_once("a.nrrd: ").map(|(_, text)| text.to_owned()).unwrap_or_default())
}

#[test]
fn a_mark_at_the_patients_left_stays_there_in_every_space() {
    // One and the same lattice, in each of the spaces: voxel (2, 1, 0) lies 20 mm to the left, 30 to the back, 40 up.
    let mark = DVec3::new(20.0, 30.0, 40.0);
    for (space, directions, origin) in [
        ("left-posterior-superior", "(5,0,0) (0,3,0) (0,0,2)", "(10,27,40)"),
        ("right-anterior-superior", "(-5,0,0) (0,-3,0) (0,0,2)", "(-10,-27,40)"),
        ("left-anterior-superior", "(5,0,0) (0,-3,0) (0,0,2)", "(10,-27,40)"),
        ("LPS", "(5,0,0) (0,3,0) (0,0,2)", "(10,27,40)"),
        ("RAST", "(-5,0,0,0) (0,-3,0,0) (0,0,2,0)", "(-10,-27,40,3)"),
        // Not the patient's axes; read as left, back and feet.
        ("3D-left-handed", "(5,0,0) (0,3,0) (0,0,-2)", "(10,27,-40)"),
    ] {
        let found = affine(&format!("space: {space}\nspace directions: {directions}\nspace origin: {origin}\n"));
        let at = found.transform_point3(DVec3::new(2.0, 1.0, 0.0));
        assert!((at - mark).length() < 1e-12, "{space}: found {at}, expected {mark}");
        let steps = found.matrix3;
        assert_eq!(
            (steps.x_axis, steps.y_axis, steps.z_axis),
            (5.0 * DVec3::X, 3.0 * DVec3::Y, 2.0 * DVec3::Z),
            "{space}"
        );
    }
}

#[test]
fn a_space_taken_for_another_moves_the_mark() {
    // The test above would not fail if every space were read as LPS but for this.
    let place = |space| affine(&format!("space: {space}\nspace directions: (5,0,0) (0,3,0) (0,0,2)\n")).matrix3.x_axis;
    assert_eq!(place("LPS"), DVec3::new(5.0, 0.0, 0.0));
    assert_eq!(place("RAS"), DVec3::new(-5.0, 0.0, 0.0));
}

#[test]
fn shear_and_reflection_are_kept() {
    let lines = "space: LPS\nspace directions: (0.5,0,0) (0,0.5,0.1) (0,-0.7,-3)\nspace origin: (1,2,3)\n";
    let found = affine(lines);
    assert_eq!(found.matrix3.y_axis, DVec3::new(0.0, 0.5, 0.1));
    assert_eq!(found.matrix3.z_axis, DVec3::new(0.0, -0.7, -3.0));
    assert!(found.matrix3.determinant() < 0.0, "a left-handed lattice stays one");
    assert_eq!(warnings(lines), Vec::<String>::new());
}

#[test]
fn what_is_assumed_is_said() {
    let directions = "space directions: (1,0,0) (0,1,0) (0,0,1)\n";
    let origin = "space origin: (0,0,0)\n";
    let lps = "x is assumed to go to the patient's left, y to the back, z to the head";
    for (lines, expected) in [
        (format!("space: LPS\n{directions}"), vec!["there is no `space origin`: the first voxel is put at the origin".to_owned()]),
        (format!("space dimension: 3\n{directions}{origin}"), vec![format!("there is no `space`: {lps}")]),
        (
            "spacings: 1 1 1\n".to_owned(),
            vec![
                "there are no `space directions`: the axes are assumed to be those of the space".to_owned(),
                format!("there is no `space`: {lps}"),
            ],
        ),
        (
            format!("space: scanner-xyz\n{directions}{origin}"),
            vec![format!("the space `scanner-xyz` does not say how the patient lies: {lps}")],
        ),
        (
            format!("space: 3D-left-handed\n{directions}{origin}"),
            vec![
                "the space `3D-left-handed` does not say how the patient lies: x is assumed to go to the patient's left, \
                 y to the back, z to the feet"
                    .to_owned(),
            ],
        ),
        (
            format!("space: LPS\n{directions}{origin}space units: \"mm\" \"furlong\" \"\"\n"),
            vec!["the unit \"furlong\" in `space units` is not known: millimetres are assumed".to_owned()],
        ),
    ] {
        assert_eq!(warnings(&lines), expected, "{lines}");
    }
}

#[test]
fn lengths_in_other_units_become_millimetres() {
    for (unit, mm) in [("m", 1000.0), ("cm", 10.0), ("mm", 1.0), ("um", 1e-3), ("µm", 1e-3), ("nm", 1e-6)] {
        let world = "space: RAS\nspace directions: (2,0,0) (0,2,0) (0,0,2)\nspace origin: (3,3,3)\n";
        let found = affine(&format!("{world}space units: \"{unit}\" \"{unit}\" \"{unit}\"\n"));
        assert_eq!(found.matrix3.z_axis, DVec3::new(0.0, 0.0, 2.0 * mm), "{unit}");
        assert_eq!(found.translation, DVec3::new(-3.0, -3.0, 3.0) * mm, "{unit}");
        let found = affine(&format!("spacings: 2 3 4\nunits: \"{unit}\" \"{unit}\" \"{unit}\"\n"));
        assert_eq!(found.matrix3.y_axis, DVec3::new(0.0, 3.0 * mm, 0.0), "{unit}");
    }
}

#[test]
fn axes_with_ends_have_a_spacing_and_a_place() {
    let ends = "axis mins: 10 10 10\naxis maxs: 16 14 12\n";
    let cells = affine(&format!("{ends}centers: cell cell cell\n"));
    assert_eq!(
        cells,
        DAffine3::from_scale_rotation_translation(
            DVec3::new(2.0, 2.0, 1.0),
            Default::default(),
            DVec3::new(11.0, 11.0, 10.5)
        )
    );
    let nodes = affine(&format!("{ends}centers: node node node\n"));
    assert_eq!(
        nodes,
        DAffine3::from_scale_rotation_translation(DVec3::new(3.0, 4.0, 2.0), Default::default(), DVec3::splat(10.0))
    );
    assert_eq!(error(ends).0, Fault::Geometry, "ends of what is not said");
}

#[test]
fn an_axis_without_a_usable_spacing_is_refused() {
    let remedy = "\n  remedy: add `spacings` or `space directions` to the header";
    for (lines, found) in
        [("", "none"), ("spacings: 1 nan 1\n", "none"), ("spacings: 1 1 0\n", "0"), ("spacings: -1 1 1\n", "-1")]
    {
        let expected = format!(
            "an axis of the volume has no spacing (spacings): found {found}, expected a number above 0, in mm{remedy}"
        );
        assert_eq!(error(lines), (Fault::Geometry, expected), "{lines:?}");
    }
    let (fault, text) = error("space: LPS\nspace directions: (1,0,0) (0,1,0) (1,1,0)\n");
    assert_eq!(fault, Fault::Geometry, "{text}");
    assert!(text.starts_with("the voxel axes do not span space"), "{text}");
}

#[test]
fn spacing_and_direction_must_agree() {
    let directions = "space: LPS\nspace directions: (2,0,0) (0,0,3) (0,4,0)\n";
    assert_eq!(affine(&format!("{directions}spacings: 2 3 4\n")).matrix3.y_axis, 3.0 * DVec3::Z);
    assert_eq!(affine(&format!("{directions}spacings: nan nan nan\n")).matrix3.y_axis, 3.0 * DVec3::Z);
    let (fault, text) = error(&format!("{directions}spacings: 2 3 5\n"));
    assert_eq!(fault, Fault::Geometry);
    assert_eq!(
        text,
        "spacing and direction of an axis contradict each other (spacings): found 5, expected 4, the length of the \
         direction, or `nan`"
    );
}

#[test]
fn one_volume_of_scalars_is_read_from_arrays_with_more_axes() {
    let folder = Folder::new();
    let space = "space: LPS\nspace origin: (0,0,0)\n";
    let steps = "(1,0,0) (0,1,0) (0,0,1)";
    let ok = |size: &str, lines: &str| {
        let header = format!("NRRD0005\ntype: uint8\nencoding: raw\ndimension: 4\nsizes: {size}\n{lines}");
        let data = vec![3; size.split(' ').map(|n| n.parse::<usize>().unwrap()).product()];
        nrrd::read(&folder.nrrd("a.nrrd", &header, &data)).map(|scan| scan.volume.grid().dims())
    };
    let dims = |size: &str, lines: &str| ok(size, lines).unwrap_or_else(|e| panic!("{size} {lines}: {e}"));
    let refused = |size: &str, lines: &str| ok(size, lines).map(|d| format!("{d:?}")).unwrap_or_else(|e| e.to_string());

    assert_eq!(dims("1 3 2 2", &format!("{space}space directions: none {steps}\n")), [3, 2, 2]);
    assert_eq!(
        dims("3 2 2 1", &format!("{space}space directions: {steps} none\nkinds: domain domain domain list\n")),
        [3, 2, 2]
    );
    assert_eq!(dims("1 3 2 2", "kinds: vector domain domain domain\nspacings: nan 1 1 1\n"), [3, 2, 2]);
    assert_eq!(dims("3 2 2 1", "spacings: 1 1 1 nan\n"), [3, 2, 2]);
    let time =
        "space: LPST\nspace directions: (1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,1)\nkinds: space space space time\n";
    assert_eq!(dims("3 2 2 1", time), [3, 2, 2]);

    let one = "the array is not one volume of scalars (sizes, kinds, space directions): found ";
    for (size, lines, expected) in [
        ("3 2 2 5", time.to_owned(), "3 x 2 x 2 x 5 (time), expected one value at each point"),
        ("3 2 2 2", "spacings: 1 1 1 1\n".to_owned(), "3 x 2 x 2 x 2, expected three spatial axes"),
        (
            "3 2 2 1",
            format!("{space}space directions: (1,0,0) (0,1,0) none none\n"),
            "3 x 2 x 2 x 1, expected three spatial axes",
        ),
    ] {
        let found = refused(size, &lines);
        assert!(found.ends_with(&format!("{one}{expected}")), "{size} {lines}: found {found}");
    }
}
