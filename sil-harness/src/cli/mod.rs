//! The command line: data on stdout, talk on stderr.
//!
//! Exit codes: 0 the end was reached, 1 failure, 2 usage, 3 collision, 4 extreme state, 6 link,
//! 8 terminated from the ground.

mod bench;
mod campaign;
mod check;
mod core;
mod figures;
mod fly;
mod ground;
mod params;
mod replay;
mod scenario;

use clap::{Parser, Subcommand};
use std::io::Write;
use std::process::ExitCode;

/// What the harness cannot do, or found wrong.
const FAILURE: u8 = 1;
/// The command line asks for something that makes no sense.
const USAGE: u8 = 2;
/// The link to the core failed.
const LINK: u8 = 6;

/// Software in the loop for Model Predictive Planning: flies the flight core through obstacle
/// fields. Without a command it flies once.
#[derive(Debug, Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    fly: fly::FlyArgs,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Fly once through a field of obstacles (the default)
    Fly(fly::FlyArgs),
    /// Fly many times over a grid, in parallel, and give success rates with their intervals
    Campaign(campaign::CampaignArgs),
    /// Draw counterparts of the paper's figures
    Figures(figures::FiguresArgs),
    /// Serve the flight core to harnesses over TCP
    Core(core::CoreArgs),
    /// Measure our parts beside others, in one run
    Bench(bench::BenchArgs),
    /// Make a page of a recorded flight, to step through in a browser
    Replay(replay::ReplayArgs),
    /// Print the parameters of a preset, as a file that `fly --params` and ground stations read
    Params(params::ParamsArgs),
    /// Check core and plant against data recorded from the authors' code
    CheckReference(check::CheckArgs),
}

/// Parses the command line and does what it says.
#[must_use]
pub fn run() -> ExitCode {
    let cli = Cli::parse();
    let result = match cli.command {
        None => fly::run(&cli.fly),
        Some(Command::Fly(args)) => fly::run(&args),
        Some(Command::Campaign(args)) => campaign::run(&args),
        Some(Command::Figures(args)) => figures::run(&args),
        Some(Command::Core(args)) => core::run(&args),
        Some(Command::Bench(args)) => bench::run(&args),
        Some(Command::Replay(args)) => replay::run(&args),
        Some(Command::Params(args)) => params::run(&args),
        Some(Command::CheckReference(args)) => check::run(&args),
    };
    match result {
        Ok(code) => ExitCode::from(code),
        Err(failure) => {
            talk(format_args!("error: {}", failure.message));
            ExitCode::from(failure.code)
        }
    }
}

/// A line for people. Whether anybody reads it is none of a flight's business, so a closed pipe is
/// not an error (`eprintln!` would panic).
fn talk(line: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// A line of data.
fn data(line: impl std::fmt::Display) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

/// Why a command did not do what it was asked.
struct Failure {
    code: u8,
    message: String,
}

impl Failure {
    fn new(code: u8, message: impl std::fmt::Display) -> Self {
        Self {
            code,
            message: message.to_string(),
        }
    }
}

#[cfg(test)]
mod tests;
