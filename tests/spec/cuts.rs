//! Clipping as written: its forms, and what is wrong with others.

use pellucid::spec::{ClipBoxSpec, RangeSpec};

use super::mistakes::check_after;
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
