//! Everything about the ARM images that is not plain cargo: build, fly, measure, check.
//!
//! Works with rustup's targets if they are installed, else with Debian's compiler and library
//! sources, which it installs as root.

mod aarch64;
mod budget;
mod counts;
mod faults;
mod firmware;
mod flight;
mod pil;
mod qemu;
mod readme;
mod stack;
mod toolchain;

use anyhow::Result;
use clap::{Parser, Subcommand};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Parser)]
#[command(about = "The flight core on ARM: build, fly, measure, check")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Build the firmware and the bare-metal libraries; linking proves that nothing can panic
    Build,
    /// Processor in the loop: fly the firmware in the emulator, compare log hashes with the host
    Pil(pil::PilArgs),
    /// Run tests and a flight of the 64-bit ARM build in the emulator
    Aarch64(aarch64::Aarch64Args),
    /// Measure flash, RAM, stack and instructions; check them against docs/budgets.toml
    Budget(budget::BudgetArgs),
    /// Hang the planner, hang the step, let the timer run: the aircraft flies on
    Faults(faults::FaultsArgs),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Build => firmware::build_all(),
        Command::Pil(args) => pil::run(&args),
        Command::Aarch64(args) => aarch64::run(&args),
        Command::Budget(args) => budget::run(&args),
        Command::Faults(args) => faults::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// The top of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A folder for what a command makes.
fn work(name: &str) -> Result<PathBuf> {
    let path = root()
        .canonicalize()?
        .join("target")
        .join("cross")
        .join(name);
    std::fs::create_dir_all(&path)?;
    Ok(path)
}
