//! Results on stdout.

use std::io::{ErrorKind, Write};

use pellucid::{Error, Fault, Result};

/// Writes a result to stdout, with a line end after it if it has none.
///
/// # Errors
/// `Fault::Output` if it cannot be written. A reader that has read enough and closed the pipe is no error: that is how
/// `pellucid … | head` ends.
pub(super) fn print(text: &str) -> Result<()> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    let mut stdout = std::io::stdout().lock();
    let written = stdout.write_all(text.as_bytes()).and_then(|()| stdout.write_all(end.as_bytes()));
    match written.and_then(|()| stdout.flush()) {
        Err(cause) if cause.kind() != ErrorKind::BrokenPipe => {
            Err(Error::new(Fault::Output, "the result could not be printed").element("stdout").caused_by(cause))
        }
        _ => Ok(()),
    }
}

/// Prints a value as JSON, indented.
///
/// # Errors
/// As [`print`].
pub(super) fn print_json(value: &impl serde::Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|cause| Error::new(Fault::Internal, "the result has no JSON form").caused_by(cause))?;
    print(&text)
}
