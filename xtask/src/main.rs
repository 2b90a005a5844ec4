//! Everything that is not plain cargo: the ARM images (build, fly, measure, check), the simulation
//! for browsers, the golden flights, the tables of ranges, and the figures of docs/validation.
//!
//! The commands use rustup's targets if they are installed. Otherwise they use Debian's compiler
//! and library sources, which they install as root.

mod aarch64;
mod budget;
mod budget_table;
mod c;
mod contents;
mod counts;
mod deb;
mod faults;
mod firmware;
mod flight;
mod folders;
mod fuzz;
mod golden;
mod identity;
mod limits;
mod nucleo;
mod numbers;
mod pil;
mod qemu;
mod release;
mod reproduce;
mod stack;
mod talk;
mod toolchain;
mod validation;
mod wasm;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

#[derive(Debug, Parser)]
#[command(
    about = "The flight core on ARM and for browsers: build, fly, measure, check; and the golden flights"
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Build the firmware, whose linking proves that nothing can panic; check the libraries for a bare 64-bit ARM
    Build,
    /// Processor in the loop: fly the firmware in the emulator and compare the log hashes with the
    /// host
    Pil(pil::PilArgs),
    /// Run tests and a flight of the 64-bit ARM build in the emulator
    Aarch64(aarch64::Aarch64Args),
    /// Measure flash, RAM, stack and instructions; check them against docs/budgets.toml
    Budget(budget::BudgetArgs),
    /// Let the planner or the step hang or trap, damage the image, let the timer run, and check that the aircraft flies on
    Faults(faults::FaultsArgs),
    /// Build the simulation for browsers, which uses no file, socket, thread or clock
    Wasm,
    /// Build the pages that fly in the browser: each is one file, which needs nothing else
    Web,
    /// Fly the example of the C interface under sanitizers, and on an emulated Cortex-M7
    C(c::CArgs),
    /// Fly the same seeds on this machine, a Cortex-M7, aarch64, WebAssembly and from Python, and compare the hashes
    Identity(identity::IdentityArgs),
    /// Build the image for the board Nucleo-H743ZI, which nobody has run yet, and say what it takes
    Nucleo,
    /// Build the firmware in two folders and compare the images, byte for byte
    Reproduce,
    /// Make what a release holds, in target/release-VERSION, and try each part in a clean folder
    Release(release::ReleaseArgs),
    /// Send random and damaged frames to the flight core and the MAVLink parts, with overflow checks
    Fuzz(fuzz::FuzzArgs),
    /// Fly the golden flights on the host and print their table; --save makes it the expected one
    Golden(golden::GoldenArgs),
    /// Say how old the figures of docs/validation are; --page runs the commands that print them again
    Validation(validation::ValidationArgs),
    /// Print docs/aircraft.md with the ranges of the code; --save writes it
    Numbers(numbers::NumbersArgs),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Build => firmware::build_all(),
        Command::Pil(args) => pil::run(&args),
        Command::Aarch64(args) => aarch64::run(&args),
        Command::Budget(args) => budget::run(&args),
        Command::Faults(args) => faults::run(&args),
        Command::Wasm => wasm::build(false).map(|path| println!("{}", path.display())),
        Command::Web => wasm::pages().map(|_| ()),
        Command::C(args) => c::run(&args),
        Command::Identity(args) => identity::run(&args),
        Command::Nucleo => nucleo::run(),
        Command::Reproduce => reproduce::run(),
        Command::Release(args) => release::run(&args),
        Command::Fuzz(args) => fuzz::run(&args),
        Command::Golden(args) => golden::run(&args),
        Command::Validation(args) => validation::run(&args),
        Command::Numbers(args) => numbers::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
