//! The command line of pellucid.

fn main() {}
