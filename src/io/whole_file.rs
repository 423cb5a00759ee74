//! Files that appear whole or not at all.
//!
//! A file is written under a temporary name in its own folder, flushed to the disk, and then renamed, which replaces an
//! older file in one step. If anything fails, or the thread panics, the temporary file is removed and the older one is
//! as it was.

use std::error::Error as StdError;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, TempPath};

use crate::error::{Error, Fault, Result};

/// Writes the file at `path` by `body`, whole or not at all.
///
/// # Errors
/// `Fault::Output`, with what the system or `body` says as its cause. The folder must exist, and a path that leads to
/// something other than a file, such as a device, is refused, because renaming would replace it.
pub fn write<E>(path: &Path, body: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>) -> Result<()>
where
    E: Into<Box<dyn StdError + Send + Sync>>,
{
    let failed = |cause: Box<dyn StdError + Send + Sync>| {
        Error::new(Fault::Output, "the file could not be written").at(path).caused_by(cause)
    };
    // A link stays a link: what it leads to is replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    if target.exists() && !target.is_file() {
        return Err(Error::new(Fault::Output, "the path leads to something that is not a file")
            .at(path)
            .remedy("give the name of a file"));
    }
    // From here on, a failure drops the temporary file, which removes it.
    let (mut writer, temporary) = temporary_beside(&target).map_err(|error| failed(error.into()))?;
    body(&mut writer).map_err(|error| failed(error.into()))?;
    finish(writer, temporary, &target).map_err(|error| failed(error.into()))
}

/// Flushes to the disk, closes, and gives the file its name.
fn finish(mut writer: BufWriter<File>, temporary: TempPath, target: &Path) -> io::Result<()> {
    writer.flush()?;
    writer.get_ref().sync_all()?;
    drop(writer);
    temporary.persist(target)?;
    // The new name is on the disk once its folder is. Not every system can do that, and the file is whole either way.
    if let Ok(folder) = File::open(folder_of(target)) {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// A new file in the folder of `target`.
fn temporary_beside(target: &Path) -> io::Result<(BufWriter<File>, TempPath)> {
    let name = target.file_name().ok_or_else(|| io::Error::other("the path does not name a file"))?;
    let prefix = format!(".{}.", name.to_string_lossy());
    // Made here, since what the library makes is for its owner alone.
    let make = |path: &Path| File::options().write(true).create_new(true).open(path);
    let (file, path) = Builder::new().prefix(&prefix).suffix(".partial").make_in(folder_of(target), make)?.into_parts();
    Ok((BufWriter::new(file), path))
}

/// The folder that a path lies in.
pub(super) fn folder_of(path: &Path) -> PathBuf {
    let folder = path.parent().unwrap_or(path);
    if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_path_buf() }
}
