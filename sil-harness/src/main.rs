//! The command line. The library does all of its work.

use std::process::ExitCode;

fn main() -> ExitCode {
    sil_harness::cli::run()
}
