//! Cleaning, from the pipeline to the labels.

use pellucid::tissue::{classify, clean};

use super::{numbers, tissues, volume};

#[test]
fn steps_are_those_of_the_tissue_and_the_denser_tissue_has_what_both_claim() {
    // A shell of bone around fat, and a speck of bone outside.
    let volume = volume([11, 11, 11], |at| {
        let reach = at.iter().map(|i| i.abs_diff(5)).max().unwrap();
        match (reach, at) {
            (_, [0, 0, 0]) => 800,
            (3, _) => 800,
            (..=2, _) => -90,
            _ => -1000,
        }
    });
    let layers = |clean: &str| {
        let wide = "{ widgets: [{ trapezoid: { hu: [-150, -100, -80, -30] }, opacity_per_mm: 0.1, color: red }] }";
        format!("transfer_function: [{{ preset: bone }}, {wide}]\n{clean}")
    };
    let count = |clean_map: &str| {
        let tissues = tissues(&layers(clean_map), &volume).unwrap();
        let labels = clean(classify(&volume, &tissues).unwrap(), &volume, &tissues).unwrap();
        let numbers = numbers(&labels);
        [1, 2].map(|label| numbers.iter().filter(|n| **n == label).count())
    };
    let (ball, shell) = (5 * 5 * 5, 7 * 7 * 7 - 5 * 5 * 5);
    assert_eq!(count(""), [shell + 1, ball], "nothing is cleaned unless asked for");
    assert_eq!(count("clean: { bone: [largest-part] }"), [shell, ball]);
    assert_eq!(count("clean: { bone: [largest-part, fill-holes] }"), [shell + ball, 0], "bone takes what it encloses");
    assert_eq!(count("clean: { all: [{ smallest_part_ml: 0.01 }] }"), [shell, ball], "ten voxels at least");
    let own = "clean: { all: [{ smallest_part_ml: 0.2 }], bone: [{ smallest_part_ml: 0.001 }] }";
    assert_eq!(count(own), [shell + 1, 0], "a list of its own takes the place of that for all");
}
