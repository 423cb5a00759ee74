//! Label masks, resolved against the labels of a volume.

use pellucid::Error;
use pellucid::plan::{LabelInfo, Plan, VolumeInfo, explain};
use pellucid::scene::Class;

use super::{plan, spec, volume};

/// Labels 0 to 3, of which 2 is the skull, and a liver, 9, that no voxel has.
fn labelled() -> VolumeInfo {
    let names = [("skull", 2), ("liver", 9)].map(|(name, label)| (name.to_owned(), label));
    let counts = [(0, 90_000), (1, 300), (2, 40), (3, 11_036)];
    VolumeInfo { labels: Some(LabelInfo { counts: counts.into(), names: names.into() }), ..volume() }
}

fn try_masked(mask: &str) -> Result<Plan, Error> {
    let text = format!("effects: {{ mask: {{ source: labels.nrrd, {mask} }} }}\n");
    Plan::new(&spec(&text), &labelled(), None)
}

fn masked(mask: &str) -> Plan {
    try_masked(mask).unwrap_or_else(|error| panic!("{mask}: {error}"))
}

fn message(mask: &str) -> String {
    try_masked(mask).expect_err(mask).to_string()
}

#[test]
fn labels_by_number_and_by_name_become_classes() {
    let plan = masked("labels: { 1: hide, skull: { preset: bone }, 3: show }");
    let classes = plan.label_classes.as_ref().expect("a mask");
    let mask = plan.scene.effects.mask.as_ref().expect("a mask");
    let look = |label| mask.classes[usize::from(classes.class(label))].clone();
    assert_eq!([0, 1, 3].map(look), [Class::Shown, Class::Hidden, Class::Shown]);
    let Class::Own(own) = look(2) else { panic!("the skull has a look of its own") };
    let alone = super::plan("transfer_function: [{ preset: bone }]\n").scene.transfer_function;
    assert_eq!(own, alone, "as the preset alone");
    let others = masked("default: hide, labels: { skull: show }");
    let classes = others.label_classes.expect("a mask");
    assert!(classes.class(2) != classes.class(0) && classes.class(0) == classes.class(65_535), "all others are hidden");
}

#[test]
fn a_mask_that_shows_all_labels_that_occur_is_none_and_the_plan_says_so() {
    let why = |plan: &Plan| plan.not_computed.iter().find(|o| o.what == "mask").map(|o| o.why.clone());
    for mask in [
        "labels: { 1: show }",
        "labels: { liver: hide }",
        "default: hide, labels: { 0: show, 1: show, 2: show, 3: show }",
    ] {
        let found = masked(mask);
        assert_eq!(found.scene, plan("").scene, "{mask}");
        assert!(found.label_classes.is_none() && found.memory_bytes() == plan("").memory_bytes(), "{mask}");
        assert_eq!(
            why(&found).as_deref(),
            Some("all labels that occur show what the transfer function says"),
            "{mask}"
        );
    }
    assert_eq!(why(&plan("")).as_deref(), Some("the pipeline does not name it"));
}

#[test]
fn a_mask_takes_a_byte_per_voxel_and_the_plan_tells_what_it_hides() {
    let plan = masked("default: show, labels: { 1: hide, skull: { preset: bone } }");
    let stage = plan.stages.iter().find(|stage| stage.name == "mask").expect("a stage");
    assert_eq!(
        (stage.bytes, stage.what.as_str()),
        (101_376, "a class for each voxel; hidden: 1; skull as bone; all else shown")
    );
    let text = explain(&plan);
    assert!(text.contains("exact/i16/tf2d-masked/unlit"), "found\n{text}");
    assert!(text.contains("1 layer and 1 of labels"), "found\n{text}");
    assert!(plan.demand.gradient_magnitude, "the label's preset reads it");
}

#[test]
fn a_label_that_is_not_there_is_refused_with_those_that_are() {
    assert_eq!(
        message("labels: { 7: hide }"),
        "pipelines/scene.yaml:6:54: there is no such label in the label volume (effects.mask.labels.7): found 7, expected \
         one of 0, 1, 3, 9 (liver), 2 (skull)"
    );
    assert!(message("labels: { skul: hide }").contains("found skul, expected one of 0, 1, 3, 9 (liver), 2 (skull)"));
    assert!(
        message("labels: { 2: hide, skull: show }")
            .contains("a label is listed twice (effects.mask.labels.skull): found skull, which is label 2")
    );
    let unread = Plan::new(&spec("effects: { mask: { source: labels.nrrd, labels: { 1: hide } } }\n"), &volume(), None);
    assert!(unread.expect_err("no labels").to_string().contains("the labels of the mask were not read"));
}

#[test]
fn what_a_mask_leaves_nothing_of_is_warned_of() {
    let warned = |mask: &str, text: &str| masked(mask).warnings.iter().any(|w| w.contains(text));
    let nothing = "the picture will show the background alone";
    assert!(warned("default: hide", nothing), "all is hidden");
    assert!(!warned("default: hide, labels: { 1: show }", nothing), "one label is left");
    let dark = "default: hide, labels: { 1: { widgets: [{ rectangle: { hu: [2500, 2600] }, color: red, opacity_per_mm: 1 }] } }";
    assert!(warned(dark, nothing), "a look that shows none of the volume's values");
    assert!(warned("labels: { liver: hide, 1: hide }", "no voxel has the label liver"), "named, and not there");
    let mip = "transfer_function: []\neffects: { project: { show: maximum }, mask: { source: labels.nrrd, default: hide } }\n";
    let found = Plan::new(&spec(mip), &labelled(), None).unwrap_or_else(|error| panic!("{error}")).warnings;
    assert!(found.iter().any(|w| w.contains(nothing)), "found {found:?}");
    let mip = "transfer_function: []\neffects: { project: { show: maximum } }\n";
    assert_eq!(plan(mip).warnings, [""; 0], "a projection needs no transfer function");
}
