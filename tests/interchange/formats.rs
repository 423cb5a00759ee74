//! The formats: what they hold comes through, and what is broken says where.

use std::fs;

use pellucid::interchange::presets::{Function, Node, Phong, VolumeProperty, write_paraview, write_vp, write_vp_json};

use super::{difference, file, imported, read_text, slab, slab_of_srgb, transfer_function};

fn property() -> VolumeProperty {
    let opacity = [(-100.5, 0.0), (20.0, 0.125), (20.0, 0.5), (300.25, 1.0)].map(|(x, y)| Node::linear(x, [y]));
    let color = [(-50.0, [1.0, 0.5, 0.0]), (310.0, [0.25, 0.125, 1.0])].map(|(x, y)| Node::linear(x, y));
    VolumeProperty {
        name: "A look".to_owned(),
        scalar_opacity: Function::new(opacity.to_vec()).expect("points"),
        gradient_opacity: Some(Function::new(vec![Node::linear(0.0, [1.0])]).expect("points")),
        color: Function::new(color.to_vec()).expect("points"),
        unit_distance_mm: Some(2.5),
        shading: Some(Phong { ambient: 0.2, diffuse: 0.7, specular: 0.3, shininess: 12.0 }),
    }
}

#[test]
fn what_is_written_is_read() {
    let look = property();
    let [vp] = read_text("written.vp", &write_vp(&look).unwrap()).unwrap().try_into().expect("one");
    assert_eq!(vp, VolumeProperty { name: "written".to_owned(), unit_distance_mm: None, ..look.clone() });
    let [json] = read_text("written.vp.json", &write_vp_json(&look).unwrap()).unwrap().try_into().expect("one");
    assert_eq!(json, VolumeProperty { name: "written".to_owned(), ..look.clone() });
    let [map] = read_text("written.json", &write_paraview(&look).unwrap()).unwrap().try_into().expect("one");
    let bare = VolumeProperty { unit_distance_mm: None, gradient_opacity: None, shading: None, ..look };
    assert_eq!(map, bare, "a colour map has a name of its own, and neither shading nor gradient opacity");
}

#[test]
fn the_unit_distance_of_the_file_counts() {
    let imported = imported(&property(), 1e-3);
    assert_eq!(imported.unit_distance_mm, 2.5);
    let found = slab(transfer_function(&imported.preset).evaluate(160.125, 0.0), 2.5);
    let share = (160.125 + 50.0) / 360.0;
    let color = [1.0 - 0.75 * share, 0.5 - 0.375 * share, share];
    let off = difference(found, slab_of_srgb(0.75, &color));
    assert!(off < 1e-3, "half way up from 0.5 to 1: found {found:?}, off by {off}");
}

#[test]
fn a_jump_stays_one_and_full_opacity_stays_finite() {
    let function = transfer_function(&imported(&property(), 1e-3).preset);
    let [below, above] = [19.999, 20.0].map(|hu| slab(function.evaluate(hu, 0.0), 2.5)[0]);
    assert!((below - 0.125).abs() < 2e-3 && (above - 0.5).abs() < 2e-3, "found {below} and {above}");
    let opaque = function.evaluate(400.0, 0.0).extinction_per_mm;
    let expected = 24.0 * std::f64::consts::LN_2 / 2.5;
    assert!((opaque - expected).abs() < 1e-4, "1 - 2^-24 of 2.5 mm is {expected}/mm: found {opaque}");
}

#[test]
fn midpoints_and_sharpness_are_followed() {
    let nodes = vec![Node { x: 0.0, y: [0.1], midpoint: 0.3, sharpness: 0.4 }, Node::linear(100.0, [0.9])];
    let look = VolumeProperty { scalar_opacity: Function::new(nodes).unwrap(), unit_distance_mm: None, ..property() };
    let [read] = read_text("sharp.vp.json", &write_vp_json(&look).unwrap()).unwrap().try_into().expect("one");
    let function = transfer_function(&imported(&read, 1e-3).preset);
    for tenth in 0..=1000 {
        let value = f64::from(tenth) / 10.0;
        let [expected] = read.scalar_opacity.at(value, pellucid::transfer::Side::Right);
        let found = slab(function.evaluate(value, 0.0), 1.0)[0];
        assert!((found - expected).abs() <= 1e-3, "at {value}: found {found}, expected {expected}");
    }
    let error = write_vp(&look).expect_err("a .vp file has no place for them").to_string();
    assert!(error.contains("straight lines"), "found {error}");
}

/// Each file broken in one place, and what the message must hold: the place and what is wrong.
#[test]
fn a_broken_file_says_where() {
    let vp = fs::read_to_string(file("slicer/ct-bone.vp")).expect("the file is there");
    let xml = fs::read_to_string(file("slicer/presets.xml")).expect("the file is there");
    let json = write_vp_json(&property()).unwrap();
    let map = write_paraview(&property()).unwrap();
    let cases: [(&str, &str, &str, &str, &[&str]); 13] = [
        (
            "short.vp",
            &vp,
            "8 -3024 0 -16.4458",
            "8 -3024 -16.4458",
            &["short.vp:7", "scalarOpacity", "found 7 numbers"],
        ),
        ("word.vp", &vp, "641.385 0.7", "641,385 0.7", &["word.vp:7", "scalarOpacity", "found 641,385"]),
        ("range.vp", &vp, "0.729412", "7.29412", &["range.vp:9", "colorTransfer", "point 2", "7.29412"]),
        ("order.vp", &vp, "-3024 0 0 0 -16", "24 0 0 0 -16", &["order.vp:9", "point 2", "at least 24"]),
        ("lines.vp", &vp, "0.9\n", "", &["lines.vp", "8 lines", "expected 9"]),
        ("shade.vp", &vp, "1\n1\n", "1\nyes\n", &["shade.vp:2", "shade", "found yes"]),
        ("cut.xml", &xml, "</MRML>", "", &["cut.xml", "not valid XML"]),
        ("count.xml", &xml, "8 -3024 0 -16.4458", "8 -3024 -16.4458", &["count.xml:16", "CT-Bone", "scalarOpacity"]),
        ("none.xml", &xml, "VolumeProperty", "Property", &["none.xml", "no volume property"]),
        ("comma.vp.json", &json, "\"shade\"", "shade\"", &["comma.vp.json:", "not of the form"]),
        ("opacity.vp.json", &json, "0.125,", "1.125,", &["scalarOpacity.points", "point 2", "1.125"]),
        ("lab.json", &map, "\"RGB\"", "\"Lab\"", &["lab.json", "A look", "ColorSpace Lab"]),
        ("points.json", &map, "\"Points\"", "\"Pints\"", &["points.json", "expected Points"]),
    ];
    for (name, good, right, wrong, parts) in cases {
        let broken = good.replace(right, wrong);
        assert_ne!(broken, good, "{name}: the case breaks something");
        let error = read_text(name, &broken).expect_err(name).to_string();
        for part in parts {
            assert!(error.contains(part), "{name}: expected {part:?} in {error:?}");
        }
    }
    let error = read_text("preset.txt", "").expect_err("no suffix of a format").to_string();
    assert!(error.contains(".vp.json"), "found {error}");
}
