//! Clipping and masks as written: their forms, and what is wrong with others.

use pellucid::spec::{ClipBoxSpec, LabelSpec, RangeSpec};

use super::mistakes::{check, check_after};
use super::{SHORT, read};

#[test]
fn ends_may_be_open_and_an_axis_too() {
    let text = format!("{SHORT}effects: {{ clip: {{ box: {{ voxels: [[2, open], open, [open, 1/2]] }} }} }}\n");
    let spec = read(&text).unwrap_or_else(|error| panic!("{error}"));
    let clip = spec.pipeline.effects.as_ref().and_then(|e| e.clip.as_ref()).expect("it is written");
    let range = |low, high| RangeSpec { low, high };
    let expected = [range(Some(2.0), None), range(None, None), range(None, Some(0.5))];
    assert_eq!(clip.within, Some(ClipBoxSpec::Voxels(expected)));
    let again = read(&serde_json::to_string(&spec.pipeline).unwrap()).unwrap();
    assert_eq!(again.pipeline, spec.pipeline, "the sidecar's form reads back");
}

#[test]
fn a_box_that_means_nothing_is_refused() {
    check_after(
        "effects: { clip: { box: { voxels: [«[9, 2]», open, open] } } }\n",
        "a value is out of range (effects.clip.box.voxels.0): found a list of 2, expected [lowest, highest], the lower \
         first",
    );
    check_after(
        "effects: { clip: { box: { mm: [open, [0, «far»], open] } } }\n",
        "a value cannot be used (effects.clip.box.mm.1.1): found \"far\", expected a number, or open",
    );
    check_after(
        "effects: { clip: { box: { mm: [open, «3», open] } } }\n",
        "a value is of the wrong kind (effects.clip.box.mm.1): found 3, expected [low, high], either of which may be \
         open, or open for both",
    );
    check_after(
        "effects: { clip: { box: { voxels: «[[0, 1], [0, 1]]» } } }\n",
        "a value is of the wrong kind (effects.clip.box.voxels): found a list of 2, expected a list of 3",
    );
    check_after(
        "effects: { clip: { box: «{ voxels: [open, open, open], mm: [open, open, open] }» } }\n",
        "a value is of the wrong kind (effects.clip.box): found a mapping with the keys voxels and 1 more, expected one \
         of voxels, mm, trim_mm",
    );
    check_after(
        "effects: { clip: { box: { trim_mm: { «top»: 3 } } } }\n",
        "there is no such key (effects.clip.box.trim_mm.top): found top, expected one of left, right, anterior, \
         posterior, superior, inferior",
    );
    check_after(
        "effects: { clip: { box: { trim_mm: { left: «-3» } } } }\n",
        "a value is out of range (effects.clip.box.trim_mm.left): found -3, expected at least 0",
    );
    check_after(
        "effects: { clip: { box: { trim_mm: «{}» } } }\n",
        "a key is missing (effects.clip.box.trim_mm): expected left, right, anterior, posterior, superior or inferior",
    );
    check_after("effects: { clip: «{}» }\n", "a key is missing (effects.clip): expected box, planes or both");
}

#[test]
fn a_plane_needs_a_direction_and_one_place() {
    check_after(
        "effects: { clip: { planes: [{ normal: «[0, 0, 0]», offset_mm: 3 }] } }\n",
        "a value is out of range (effects.clip.planes.0.normal): found a list of 3, expected a direction of any length \
         but 0",
    );
    check_after(
        "effects: { clip: { planes: [«{ normal: [0, 0, 1] }»] } }\n",
        "a key is missing (effects.clip.planes.0): expected exactly one of point_mm, offset_mm",
    );
    check_after(
        "effects: { clip: { planes: [{ normal: [0, 0, 1], point_mm: [0, 0, 1], offset_mm: «2» }] } }\n",
        "two keys exclude each other (effects.clip.planes.0.offset_mm): found point_mm and offset_mm, expected exactly \
         one of point_mm, offset_mm",
    );
    check_after(
        "effects: { clip: { planes: «[]» } }\n",
        "a value is out of range (effects.clip.planes): found a list of 0, expected 1 to 64 planes",
    );
}

#[test]
fn labels_hide_show_or_have_a_layer_of_their_own() {
    let labels = "{ 1: hide, 2: show, left kidney: { preset: bone, color: red } }";
    let text = format!("{SHORT}effects: {{ mask: {{ source: a.nrrd, default: hide, labels: {labels} }} }}\n");
    let spec = read(&text).unwrap_or_else(|error| panic!("{error}"));
    let mask = spec.pipeline.effects.as_ref().and_then(|e| e.mask.as_ref()).expect("it is written");
    assert_eq!((&mask.labels["1"], &mask.labels["2"]), (&LabelSpec::Hide, &LabelSpec::Show));
    let LabelSpec::Own(layer) = &mask.labels["left kidney"] else { panic!("found {mask:?}") };
    assert_eq!(layer.preset.as_deref(), Some("bone"));
    assert_eq!(spec.label_preset("left kidney").map(|p| p.preset.name.as_str()), Some("bone"));
    let again = read(&serde_json::to_string(&spec.pipeline).unwrap()).unwrap();
    assert_eq!(again.pipeline, spec.pipeline, "the sidecar's form reads back");
}

#[test]
fn a_mask_that_means_nothing_is_refused() {
    check_after(
        "effects: { mask: «{ labels: { 1: hide } }» }\n",
        "a key is missing (effects.mask): expected exactly one of source, phantom",
    );
    check_after(
        "effects: { mask: «{ source: a.nrrd }» }\n",
        "a key is missing (effects.mask.labels): expected labels, such as { 1: hide }",
    );
    check_after(
        "effects: { mask: { source: a.nrrd, labels: { 1: «hidden» } } }\n",
        "a value cannot be used (effects.mask.labels.1): found \"hidden\", expected hide, show, or a layer such as \
         { preset: bone }",
    );
    check_after(
        "effects: { mask: { source: a.nrrd, labels: { 70000: «hide» } } }\n",
        "a value is out of range (effects.mask.labels.70000): found \"hide\", expected a label from 0 to 65535, or a name",
    );
    check_after(
        "effects: { mask: { source: a.nrrd, labels: { 1: { preset: bone, opacity_scale: «-1» } } } }\n",
        "a value is out of range (effects.mask.labels.1.opacity_scale): found -1, expected at least 0",
    );
    check_after(
        "effects: { mask: { source: a.nrrd, default: «hidden», labels: { 1: hide } } }\n",
        "there is no such choice (effects.mask.default): found hidden, expected one of show, hide\n  remedy: did you mean \
         hide?",
    );
    let projected = "version: 1\nvolume: { source: a.nrrd }\neffects: { project: { show: maximum }, mask: MASK }\n";
    check(
        &projected.replace("MASK", "{ source: b.nrrd, labels: { 1: «{ preset: bone }» } }"),
        "nothing would read this key: effects.project and effects.surfaces show values, whatever their look \
         (effects.mask.labels.1)\n  remedy: remove the key",
    );
    check(
        &projected.replace("MASK", "{ phantom: «structures», labels: { 1: hide } }"),
        "nothing would read this key: the volume is a scan, not a phantom (effects.mask.phantom)\n  remedy: remove the key",
    );
}
