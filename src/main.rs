//! The `pellucid` program: `pellucid --help` says what it does, README.md how to begin.

mod cli;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let arguments = cli::Arguments::parse();
    match cli::run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            cli::report::print(&error);
            ExitCode::from(error.fault().exit_code())
        }
    }
}
