//! `pellucid completions`: completion scripts for shells.

use clap::CommandFactory;
use clap_complete::Shell;
use pellucid::Result;

use super::{Arguments, stdout};

/// Arguments of `pellucid completions`.
#[derive(Debug, clap::Args)]
pub(super) struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    /// Prints the script.
    pub(super) fn run(&self) -> Result<()> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Arguments::command(), "pellucid", &mut script);
        stdout::print(&String::from_utf8_lossy(&script))
    }
}
