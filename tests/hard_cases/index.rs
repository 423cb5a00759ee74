//! The index of hard cases is true.

use std::collections::BTreeSet;

use super::INDEX;
use crate::layering::files_below;

/// Names of all functions that follow `#[test]`, in the library and in the tests.
fn tests() -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for (_, text) in files_below("src", "rs").into_iter().chain(files_below("tests", "rs")) {
        for after in text.split("#[test]\n").skip(1) {
            let name = after.trim_start().strip_prefix("fn ").and_then(|rest| rest.split('(').next());
            found.extend(name.map(String::from));
        }
    }
    found
}

#[test]
fn every_test_of_the_index_exists() {
    let tests = tests();
    assert!(tests.len() > 150, "the tests were looked for in the wrong place: found only {}", tests.len());
    for (number, case, names) in INDEX {
        let missing: Vec<_> = names.iter().filter(|name| !tests.contains(**name)).collect();
        assert!(missing.is_empty(), "case {number}, {case}: there is no test {missing:?}");
    }
}

#[test]
fn every_case_stands_in_the_index_once() {
    let numbers: Vec<u32> = INDEX.iter().map(|(number, ..)| *number).collect();
    assert_eq!(numbers, (1..=31).collect::<Vec<_>>());
    let without_test: Vec<u32> = INDEX.iter().filter(|(.., names)| names.is_empty()).map(|(n, ..)| *n).collect();
    assert!(without_test.is_empty(), "cases without a test: {without_test:?}");
}
