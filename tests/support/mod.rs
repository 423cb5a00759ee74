//! What tests share.

pub(crate) mod scenes;

use std::path::PathBuf;

/// A file or folder of the public scans, or `None`, with a note on stderr, where `PELLUCID_DATA` does not name them.
#[allow(dead_code, reason = "used as modules need it")]
#[expect(clippy::print_stderr, reason = "a skipped test says so")]
pub(crate) fn scan_path(name: &str) -> Option<PathBuf> {
    let found = std::env::var_os("PELLUCID_DATA").map(|root| PathBuf::from(root).join(name)).filter(|p| p.exists());
    if found.is_none() {
        eprintln!("skipped: set PELLUCID_DATA to the folder of public scans to test with {name}");
    }
    found
}
