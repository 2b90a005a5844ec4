//! `check-reference`: checks our core and plant against recorded data.

use super::answer::{FAILURE, Failure, print};
use crate::files::check_directory;
use std::path::PathBuf;

#[derive(Clone, Debug, clap::Args)]
pub(super) struct CheckArgs {
    /// Directory of the recorded JSON files
    directory: PathBuf,
    /// Print the report as one JSON object
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &CheckArgs) -> Result<u8, Failure> {
    let report = check_directory(&args.directory)?;
    print(&report, args.json)?;
    Ok(if report.passed() { 0 } else { FAILURE })
}
