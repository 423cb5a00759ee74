//! Files that appear whole or not at all.
//!
//! A file is written under a temporary name in its own folder, flushed to the disk, and then renamed, which replaces an
//! older file in one step. If anything fails, or the thread panics, the temporary file is removed and the older one is
//! as it was.

use std::error::Error as StdError;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use crate::error::{Error, Fault, Result};

/// Distinguishes the temporary files of one process.
static COUNTER: AtomicU32 = AtomicU32::new(0);

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
    let (mut writer, mut temporary) = Temporary::create(&target).map_err(|error| failed(error.into()))?;
    body(&mut writer).map_err(|error| failed(error.into()))?;
    finish(writer, &mut temporary, &target).map_err(|error| failed(error.into()))
}

/// Flushes to the disk, closes, and gives the file its name.
fn finish(mut writer: BufWriter<File>, temporary: &mut Temporary, target: &Path) -> io::Result<()> {
    writer.flush()?;
    writer.get_ref().sync_all()?;
    drop(writer);
    fs::rename(&temporary.path, target)?;
    temporary.renamed = true;
    // The new name is on the disk once its folder is. Not every system can do that, and the file is whole either way.
    if let Some(Ok(folder)) = folder_of(target).map(File::open) {
        let _ = folder.sync_all();
    }
    Ok(())
}

fn folder_of(path: &Path) -> Option<&Path> {
    path.parent().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
}

/// A file under its temporary name; removed unless it was renamed.
struct Temporary {
    path: PathBuf,
    renamed: bool,
}

impl Temporary {
    fn create(target: &Path) -> io::Result<(BufWriter<File>, Self)> {
        let name = target.file_name().ok_or_else(|| io::Error::other("the path does not name a file"))?;
        loop {
            let number = COUNTER.fetch_add(1, Ordering::Relaxed);
            let own = format!(".{}.{}-{number}.partial", name.to_string_lossy(), std::process::id());
            let path = target.with_file_name(own);
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((BufWriter::new(file), Temporary { path, renamed: false })),
                // Left behind by a process of the same number that was killed.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.renamed {
            // Nothing better can be done if this fails too; the name says what the file is.
            let _ = fs::remove_file(&self.path);
        }
    }
}
