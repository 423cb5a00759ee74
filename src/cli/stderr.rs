//! Logs and summaries on stderr.

use std::io::{IsTerminal, Write};

use tracing::Level;

/// Sends the log to stderr: errors only if `quiet`, warnings by default, more with `verbose`.
pub(super) fn start_log(quiet: bool, verbose: u8) {
    let level = match (quiet, verbose) {
        (true, _) => Level::ERROR,
        (false, 0) => Level::WARN,
        (false, 1) => Level::INFO,
        (false, 2) => Level::DEBUG,
        (false, _) => Level::TRACE,
    };
    // A second subscriber in one process is refused; there is only this one.
    let _ = tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .with_ansi(wants_color())
        .with_target(false)
        .without_time()
        .try_init();
}

/// True for a terminal whose user has not asked for plain text by `NO_COLOR` (any value but the empty one).
pub(super) fn wants_color() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}

/// Writes lines for people. What cannot be written there has nobody to read it, and stops nothing.
pub(super) fn say(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}
