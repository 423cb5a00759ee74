//! The program from outside: what it prints, how it ends, what it leaves behind.

mod compare;
mod failures;
mod histograms;
mod interchange;
mod labels;
mod masks;
mod pictures;
mod program;
mod scans;
mod stacks;
mod study;

use program::pellucid;

/// Texts that people and scripts read, as snapshots: `TRYCMD=overwrite cargo test --release cli` accepts new ones.
#[test]
fn texts_are_as_they_were() {
    let cases = trycmd::TestCases::new();
    cases.register_bin("pellucid", std::path::Path::new(env!("CARGO_BIN_EXE_pellucid")));
    cases.case("tests/cli/*.trycmd");
}

#[test]
fn every_shell_gets_a_completion_script() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = pellucid(&["completions", shell]).success().stdout;
        assert!(script.contains("pellucid") && script.contains("render"), "{shell}: found {script:.200}");
    }
}

#[test]
fn the_schemas_are_json() {
    for kind in ["pipeline", "preset", "stack"] {
        let schema: serde_json::Value =
            serde_json::from_str(&pellucid(&["schema", kind]).success().stdout).expect("valid JSON");
        assert_eq!(schema["title"], format!("pellucid {kind}"), "names what it describes");
    }
}

#[test]
fn a_preset_is_printed_as_its_file() {
    let shown = pellucid(&["presets", "show", "bone"]).success().stdout;
    assert_eq!(shown, include_str!("../presets/bone.yaml"));
    let list = pellucid(&["presets", "list"]).success().stdout;
    assert!(list.lines().any(|line| line.starts_with("bone ")), "found:\n{list}");
}

/// `pellucid schema | head -1` ends well: whoever closes the pipe has read enough.
#[test]
fn a_closed_pipe_is_no_error() {
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_pellucid"))
        .arg("schema")
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the binary runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && stderr.is_empty(), "found {:?} and {stderr:?}", output.status);
}
