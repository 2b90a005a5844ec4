//! `fuzz`: sends hostile frames to the core with the tests' crate.

use anyhow::{Result, ensure};
use std::process::Command;

#[derive(Debug, clap::Args)]
pub(crate) struct FuzzArgs {
    /// Number of frames
    #[arg(long, default_value_t = 10_000_000)]
    count: u64,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

pub(crate) fn run(args: &FuzzArgs) -> Result<()> {
    // The profile `dev` checks for overflow.
    let mut command = Command::new(env!("CARGO"));
    command
        .current_dir(crate::folders::root())
        .args(["run", "--quiet", "--locked"])
        .args(["-p", "mpp-tests", "--bin", "fuzz", "--"])
        .args([args.count.to_string(), args.seed.to_string()]);
    ensure!(command.status()?.success(), "hostile frames did harm");
    Ok(())
}
