//! A file is whole or not there.

use std::fs;
use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};

use pellucid::Fault;
use pellucid::io::whole_file;

/// Names in a folder.
fn names(folder: &std::path::Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    let mut names: Vec<_> = entries.collect();
    names.sort();
    names
}

#[test]
fn a_file_appears_under_its_name_only() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    for text in ["first", "second"] {
        whole_file::write(&path, |file| {
            file.write_all(text.as_bytes())?;
            assert!(fs::read(&path).map_or(true, |old| old != text.as_bytes()), "not there before it is whole");
            io::Result::Ok(())
        })
        .unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
        assert_eq!(names(folder.path()), ["a.txt"]);
    }
}

#[test]
fn an_older_file_survives_every_failure() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    fs::write(&path, "old").unwrap();
    let error = whole_file::write(&path, |file| {
        file.write_all(b"half")?;
        Err::<(), _>(io::Error::other("no more"))
    })
    .unwrap_err();
    assert_eq!(error.fault(), Fault::Output);
    assert!(error.to_string().ends_with("a.txt: the file could not be written\n  cause: no more"), "{error}");

    let panicked = catch_unwind(AssertUnwindSafe(|| {
        let _ = whole_file::write(&path, |_| -> io::Result<()> { panic!("in the middle") });
    }));
    assert!(panicked.is_err());
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(names(folder.path()), ["a.txt"], "nothing is left behind");
}

#[test]
fn what_is_not_a_file_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("folder");
    fs::create_dir(&inner).unwrap();
    let write = |path: &std::path::Path| whole_file::write(path, |file| file.write_all(b"x"));
    assert_eq!(write(&inner).unwrap_err().what(), "the path leads to something that is not a file");
    assert_eq!(write(&folder.path().join("none/a.txt")).unwrap_err().fault(), Fault::Output, "no such folder");
    assert_eq!(names(folder.path()), ["folder"]);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link() {
    let folder = tempfile::tempdir().unwrap();
    let (path, link) = (folder.path().join("a.txt"), folder.path().join("link.txt"));
    fs::write(&path, "old").unwrap();
    std::os::unix::fs::symlink(&path, &link).unwrap();
    whole_file::write(&link, |file| file.write_all(b"new")).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
}
