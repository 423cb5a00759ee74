//! NRRD, read and written.
//!
//! Files are made here byte by byte, not by our own writer, except where the round trip is the test.

mod colors;
mod encodings;
mod errors;
mod fields;
mod orientation;
mod public_scans;
mod random_bytes;
mod round_trip;

use std::fs;
use std::path::{Path, PathBuf};

use pellucid::io::Scan;
use pellucid::io::nrrd;

/// A folder of files that goes away with the test.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Folder(tempfile::tempdir().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A file of these bytes.
    fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("the folder is made");
        fs::write(&path, bytes).expect("the file is written");
        path
    }

    /// A file of a header and what follows it.
    fn nrrd(&self, name: &str, header: &str, data: &[u8]) -> PathBuf {
        self.file(name, &[header.as_bytes(), b"\n", data].concat())
    }

    /// Message of the error of reading a volume, with the folder left out.
    fn error(&self, path: &Path) -> String {
        match nrrd::read(path) {
            Ok(_) => "read without an error".to_owned(),
            Err(error) => error.to_string().replace(&format!("{}/", self.0.path().display()), ""),
        }
    }
}

/// All values of a volume, x fastest.
fn values(scan: &Scan) -> Vec<f64> {
    let volume = &scan.volume;
    (0..volume.samples().len()).map(|i| volume.rescale().value(volume.samples().stored(i))).collect()
}

/// The header of a 3 x 2 x 2 volume in LPS with steps of 1 mm; further lines follow.
const SMALL: &str = "NRRD0004\ndimension: 3\nsizes: 3 2 2\nspace: left-posterior-superior\n\
                     space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n";
