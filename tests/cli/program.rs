//! Runs the program and keeps what it said.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What a run of the program printed and how it ended.
#[derive(Debug)]
pub(super) struct Run {
    pub(super) arguments: String,
    pub(super) code: Option<i32>,
    pub(super) stdout: String,
    pub(super) stderr: String,
}

/// Runs the program with these arguments.
pub(super) fn pellucid(arguments: &[&str]) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_pellucid")).args(arguments).output().expect("the binary runs");
    Run {
        arguments: arguments.join(" "),
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).expect("stdout is UTF-8"),
        stderr: String::from_utf8(output.stderr).expect("stderr is UTF-8"),
    }
}

impl Run {
    /// Holds it to have succeeded.
    #[track_caller]
    pub(super) fn success(self) -> Self {
        assert_eq!(self.code, Some(0), "pellucid {} failed:\n{}", self.arguments, self.stderr);
        self
    }

    /// Holds it to have failed with this exit code, an error on stderr and nothing on stdout.
    #[track_caller]
    pub(super) fn failure(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "pellucid {}:\n{}", self.arguments, self.stderr);
        assert!(self.stderr.starts_with("error: "), "pellucid {}: found on stderr:\n{}", self.arguments, self.stderr);
        assert_eq!(self.stdout, "", "pellucid {}: a failure prints no result", self.arguments);
        self
    }

    /// Holds stderr to contain all of these.
    #[track_caller]
    pub(super) fn says(self, parts: &[&str]) -> Self {
        for part in parts {
            assert!(self.stderr.contains(part), "expected {part:?} in:\n{}", self.stderr);
        }
        self
    }
}

/// A folder of a test's own, empty at its start.
pub(super) struct Folder(PathBuf);

impl Folder {
    /// The folder of the test of this name.
    pub(super) fn new(test: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli").join(test);
        if path.exists() {
            fs::remove_dir_all(&path).expect("the last run's folder can be removed");
        }
        fs::create_dir_all(&path).expect("a folder can be made");
        Folder(path)
    }

    /// The path of a file in it.
    pub(super) fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().expect("UTF-8").to_string()
    }

    /// Writes a file and gives its path.
    pub(super) fn write(&self, name: &str, text: &str) -> String {
        fs::write(self.0.join(name), text).expect("the folder is writable");
        self.path(name)
    }

    /// A small pipeline of the head phantom.
    pub(super) fn pipeline(&self) -> String {
        self.write("head.yaml", SMALL_HEAD)
    }

    /// The names of all files in it, those whose names begin with a dot too, sorted.
    pub(super) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("the folder is readable");
        let mut names: Vec<String> =
            entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// Renders in a fraction of a second.
const SMALL_HEAD: &str = "\
version: 1
volume: { phantom: { head: { size: 32 } } }
transfer_function:
  - preset: skin
  - preset: bone
effects:
  shading: {}
camera: { view: anterior, azimuth: 30 }
integrate: { exact: { tolerance: 1/255 } }
image: { size: [40, 30] }
output: head.png
";
