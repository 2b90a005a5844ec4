//! The command line: data on stdout, messages on stderr.
//!
//! Exit codes: 0 the end was reached, 1 failure, 2 usage, 3 collision, 4 extreme state, 6 link,
//! 5 left the altitude band (`fly --strict`), 8 terminated from the ground, 130 and 143 interrupted.

mod aircraft;
mod answer;
mod bench;
mod campaign;
mod ceiling;
mod ceiling_in_space;
mod check;
mod core;
mod courses;
mod detail;
mod export;
mod fault_campaign;
mod figures;
mod file_name;
mod fly;
mod ground;
mod help;
mod in_space;
mod loudness;
mod manual;
mod params;
mod pdf;
mod replay;
mod scenario;
mod signals;
mod space;
mod space_cell;
mod stage;
mod values;
mod worlds;

use answer::{Failure, complain};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::process::ExitCode;

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
    /// Tell which fields can be passed at all: blocked by proof, or passable with a flight as witness
    Ceiling(ceiling::CeilingArgs),
    /// Tell what follows from an aircraft file: trim, modes, what the planner makes of it; with --flights, how
    /// well it flies
    Aircraft(aircraft::AircraftArgs),
    /// Hold a bank for 20 s in six degrees of freedom, by the lateral regulator, in wind and gusts
    Space(space::SpaceArgs),
    /// Draw counterparts of the paper's figures
    Figures(figures::FiguresArgs),
    /// Serve the flight core to harnesses over TCP
    Core(core::CoreArgs),
    /// Measure our parts and others in one run
    Bench(bench::BenchArgs),
    /// Make a page from a recorded flight, with which a browser can step through the flight
    Replay(replay::ReplayArgs),
    /// Print the parameters of a preset, as a file that `fly --params` and ground stations read
    Params(params::ParamsArgs),
    /// Check core and plant against data recorded from the authors' code
    CheckReference(check::CheckArgs),
    /// Make CSV, MCAP or Parquet of a flight's log or a campaign's rows
    Export(export::ExportArgs),
    /// Print the completions of a shell
    Completions(manual::CompletionsArgs),
    /// Print the manual page, or write those of all commands
    Man(manual::ManArgs),
}

fn command(cli: Cli) -> Result<u8, Failure> {
    match cli.command {
        None => fly::run(&cli.fly),
        Some(Command::Fly(args)) => fly::run(&args),
        Some(Command::Campaign(args)) if args.faults.is_empty() => campaign::run(&args),
        Some(Command::Campaign(args)) => fault_campaign::run(&args),
        Some(Command::Ceiling(args)) => ceiling::run(&args),
        Some(Command::Aircraft(args)) => aircraft::run(&args),
        Some(Command::Space(args)) => space::run(&args),
        Some(Command::Figures(args)) => figures::run(&args),
        Some(Command::Core(args)) => core::run(&args),
        Some(Command::Bench(args)) => bench::run(&args),
        Some(Command::Replay(args)) => replay::run(&args),
        Some(Command::Params(args)) => params::run(&args),
        Some(Command::CheckReference(args)) => check::run(&args),
        Some(Command::Export(args)) => export::run(&args),
        Some(Command::Completions(args)) => manual::completions(&args, Cli::command()),
        Some(Command::Man(args)) => manual::man(&args, Cli::command()),
    }
}

/// The command line, where a negative number is a value, so that its flag tells what to give. A wrong one ends the program.
fn parsed<T: CommandFactory + FromArgMatches>(args: Vec<std::ffi::OsString>) -> T {
    let matches = with_negative_numbers(T::command()).get_matches_from(args);
    T::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())
}

fn with_negative_numbers(command: clap::Command) -> clap::Command {
    let takes_values = |arg: &clap::Arg| arg.get_action().takes_values();
    command
        .mut_args(|arg| match takes_values(&arg) {
            true => arg.allow_negative_numbers(true),
            false => arg,
        })
        .mut_subcommands(with_negative_numbers)
}

/// Parses the command line and does what it says.
#[must_use]
pub fn run() -> ExitCode {
    let args: Vec<_> = std::env::args_os().collect();
    let result = if in_space::is_asked(&args) {
        parsed::<in_space::SpaceCli>(args).run()
    } else {
        command(parsed(args))
    };
    match result {
        Ok(code) => ExitCode::from(code),
        Err(failure) => {
            complain(format_args!("error: {}", failure.message));
            ExitCode::from(failure.code)
        }
    }
}

#[cfg(test)]
mod tests;
