//! What the documents claim: commands that exist, with their options, and links that lead somewhere.

use std::path::Path;
use std::process::Command;

const README: &str = include_str!("../README.md");
const ARCHITECTURE: &str = include_str!("../ARCHITECTURE.md");
const TESTS_README: &str = include_str!("README.md");
const PIPELINES_README: &str = include_str!("../pipelines/README.md");
const BENCHES_README: &str = include_str!("../benches/README.md");
const PRESETS_README: &str = include_str!("../presets/README.md");

/// The words of each command line that starts pellucid in a document's code blocks, from its sub-command on.
fn commands(document: &str) -> Vec<Vec<&str>> {
    let blocks = document.split("```").skip(1).step_by(2);
    let lines = blocks.flat_map(str::lines).filter_map(|line| {
        let line = line.trim_start().trim_start_matches("$ ");
        line.strip_prefix("cargo run --release -- ").or_else(|| line.strip_prefix("pellucid "))
    });
    let without_comment = lines.map(|line| line.split(" #").next().unwrap_or(line));
    without_comment.map(|line| line.split_whitespace().collect()).collect()
}

/// What is wrong with a command line of a document, or nothing.
fn objection(words: &[&str]) -> Option<String> {
    let names = words.iter().take_while(|w| w.chars().all(|c| c.is_ascii_lowercase()));
    let command = names.take(1).copied().collect::<Vec<_>>();
    let help =
        Command::new(env!("CARGO_BIN_EXE_pellucid")).args(&command).arg("--help").output().expect("the binary runs");
    let text = String::from_utf8_lossy(&help.stdout).into_owned();
    if !help.status.success() {
        return Some(format!("`pellucid {}` is no command", words.join(" ")));
    }
    let options = words.iter().filter(|w| w.starts_with("--")).map(|w| w.split('=').next().unwrap_or(w));
    let known = |option: &str| text.lines().any(|l| l.split([' ', ',', '=']).any(|word| word == option));
    let unknown: Vec<&str> = options.filter(|o| !known(o) && !known_below(&command, words, o)).collect();
    (!unknown.is_empty()).then(|| format!("`pellucid {}` has no option {unknown:?}", words.join(" ")))
}

/// True if the sub-command of a command, such as `phantom head`, has the option.
fn known_below(command: &[&str], words: &[&str], option: &str) -> bool {
    let Some(below) = words.get(command.len()) else { return false };
    let help = Command::new(env!("CARGO_BIN_EXE_pellucid")).args(command).args([below, "--help"]).output();
    let text = help.map(|h| String::from_utf8_lossy(&h.stdout).into_owned()).unwrap_or_default();
    text.split([' ', ',', '=', '\n']).any(|word| word == option)
}

/// Targets of Markdown links that name files of the repository.
fn linked_files(document: &str) -> Vec<&str> {
    let targets = document.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    targets.map(|t| t.split('#').next().unwrap_or(t)).filter(|t| !t.is_empty() && !t.contains("://")).collect()
}

#[test]
fn the_commands_of_the_readme_exist() {
    let found = commands(README);
    assert!(found.len() >= 5, "the README shows how to use the program; found only {found:?}");
    let benches = commands(BENCHES_README);
    assert!(!benches.is_empty(), "benches/README.md shows how its chart is made");
    let objections: Vec<String> = found.iter().chain(&benches).filter_map(|words| objection(words)).collect();
    assert!(objections.is_empty(), "{}", objections.join("\n"));
}

#[test]
fn a_command_that_does_not_exist_is_found_out() {
    let document = "text\n```sh\npellucid rendr x.yaml  # a picture\ncargo run --release -- render --outputt x\n```\n";
    let found = commands(document);
    assert_eq!(found, [vec!["rendr", "x.yaml"], vec!["render", "--outputt", "x"]]);
    for words in found {
        assert!(objection(&words).is_some(), "{words:?} should be objected to");
    }
}

#[test]
fn the_pipelines_that_the_readme_renders_are_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = commands(README).into_iter().flatten().filter(|w| w.ends_with(".yaml") && w.contains("pipelines/"));
    for file in files.collect::<std::collections::BTreeSet<_>>() {
        assert!(root.join(file).is_file(), "README.md renders {file}, which is not there");
    }
}

/// Every key that may be written stands in `pipelines/README.md`.
#[test]
fn the_keys_of_a_pipeline_are_explained() {
    fn keys(schema: &serde_json::Value, found: &mut std::collections::BTreeSet<String>) {
        match schema {
            serde_json::Value::Object(entries) => {
                let properties = entries.get("properties").and_then(serde_json::Value::as_object);
                found.extend(properties.into_iter().flat_map(|p| p.keys().cloned()));
                entries.values().for_each(|value| keys(value, found));
            }
            serde_json::Value::Array(items) => items.iter().for_each(|item| keys(item, found)),
            _ => {}
        }
    }
    let mut found = std::collections::BTreeSet::new();
    keys(&pellucid::spec::pipeline_schema(), &mut found);
    keys(&pellucid::spec::stack_schema(), &mut found);
    let explained =
        |key: &String| PIPELINES_README.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == key);
    let unexplained: Vec<&String> = found.iter().filter(|key| !explained(key)).collect();
    assert!(found.len() > 30, "the schema was not understood: found only {found:?}");
    assert!(unexplained.is_empty(), "pipelines/README.md says nothing of {unexplained:?}");
}

/// Every preset has a row, and a picture unless no scan shows it; a label stands for one tissue.
#[test]
fn the_presets_are_shown() {
    let mut labels = std::collections::BTreeSet::new();
    for (name, _) in pellucid::spec::BUILT_IN_PRESETS {
        let row = PRESETS_README.lines().find(|line| line.contains(&format!("[{name}]({name}.yaml)")));
        let row = row.unwrap_or_else(|| panic!("presets/README.md has no row of {name}"));
        let preset = pellucid::spec::built_in_preset(name).expect("built in").expect("valid").preset;
        assert!(row.contains(&preset.description.unwrap_or_default()), "{name} is described as in its file: {row}");
        assert!(row.contains("pictures/") || row.contains("no public scan"), "{name} has no picture: {row}");
        if let Some(tissue) = preset.tissue {
            assert!(labels.insert(tissue.label), "{name}: label {} is taken", tissue.label);
        }
    }
}

#[test]
fn links_between_documents_lead_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let documents = [
        ("", README),
        ("", ARCHITECTURE),
        ("tests", TESTS_README),
        ("pipelines", PIPELINES_README),
        ("presets", PRESETS_README),
        ("benches", BENCHES_README),
    ];
    for (folder, document) in documents {
        for link in linked_files(document) {
            assert!(
                root.join(folder).join(link).exists(),
                "a document in `{folder}/` links to {link}, which is not there"
            );
        }
    }
}

#[test]
fn the_checks_run_the_test_command_of_the_readme() {
    let ci = include_str!("../.ci/run");
    assert!(README.contains("cargo test --release"), "README.md says how to run the tests");
    assert!(ci.contains("cargo test --release"), ".ci/run runs the tests as README.md says");
}
