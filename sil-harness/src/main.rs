//! The command line; everything it does stands in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    sil_harness::cli::run()
}
