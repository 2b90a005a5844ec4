//! `golden`: flies the golden flights with the tests' crate.

use anyhow::{Result, ensure};
use std::process::Command;

#[derive(Debug, clap::Args)]
pub(crate) struct GoldenArgs {
    /// Write the table to tests/golden/table.txt; use it only when a flight is meant to change
    #[arg(long)]
    save: bool,
}

pub(crate) fn run(args: &GoldenArgs) -> Result<()> {
    let mut command = Command::new(env!("CARGO"));
    command
        .current_dir(crate::folders::root())
        .args(["run", "--quiet", "--release", "--locked"])
        .args(["-p", "mpp-tests", "--bin", "golden", "--"])
        .args(args.save.then_some("--save"));
    ensure!(
        command.status()?.success(),
        "the golden flights were not flown"
    );
    Ok(())
}
