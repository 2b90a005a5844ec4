//! `bench`: our parts beside others, in one run.

use super::scenario::{ScenarioArgs, replace};
use super::{FAILURE, Failure, USAGE, data, talk};
use crate::bench::{
    CycleBench, Instance, generate, read_instances, run_cycle, run_qp, write_instances,
};
use crate::scenario::Preset;
use indicatif::ProgressBar;
use serde::Serialize;
use std::fmt::Display;
use std::path::PathBuf;

#[derive(Clone, Debug, clap::Args)]
pub(super) struct BenchArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Clone, Debug, clap::Subcommand)]
enum What {
    /// The QP solver beside Clarabel, on the same programs, one thread, best of several runs
    Qp(QpArgs),
    /// A planning cycle of preset flight beside one of reference, by stage, on the same recorded
    /// cycles, one thread, best of several runs
    Cycle(CycleArgs),
}

#[derive(Clone, Debug, clap::Args)]
struct CycleArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Obstacles of the recorded flights
    #[arg(long, default_value_t = 40)]
    obstacles: usize,
    /// Candidate paths of a cycle [default: 25]
    #[arg(long)]
    paths: Option<u16>,
    /// Replanning rate [Hz] [default: 1]
    #[arg(long)]
    replan_hz: Option<f64>,
    /// Flights to record
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    flights: u32,
    /// Seed of the first; the others follow [default: 1]
    #[arg(long)]
    seed: Option<u64>,
    /// How often each cycle is planned; the fastest counts
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    runs: u32,
    /// Print the report as one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Debug, clap::Args)]
struct QpArgs {
    /// Programs: recorded cases (a case_*.json or a directory of them) or a file of --export
    #[arg(long)]
    instances: Option<PathBuf>,
    /// Programs to generate from flights
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    generate: Option<u32>,
    /// Seed of the first flight that programs are generated from
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Preset of those flights; `flight` has soft rows
    #[arg(long, value_enum, default_value_t = Preset::Reference)]
    preset: Preset,
    /// Write the programs to a file, a JSON object a line, and do not solve them
    #[arg(long)]
    export: Option<PathBuf>,
    /// Print the report as one JSON object
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &BenchArgs) -> Result<u8, Failure> {
    match &args.what {
        What::Qp(args) => run_qp_bench(args),
        What::Cycle(args) => run_cycle_bench(args),
    }
}

fn run_cycle_bench(args: &CycleArgs) -> Result<u8, Failure> {
    let mut file = args.scenario.file()?;
    file.obstacles = Some(args.obstacles);
    replace(&mut file.paths, args.paths);
    replace(&mut file.replan_hz, args.replan_hz);
    replace(&mut file.seed, args.seed);
    let bench = CycleBench {
        scenario: file.build().map_err(|error| Failure::new(USAGE, error))?,
        flights: args.flights,
        runs: args.runs,
    };
    let progress = ProgressBar::new(u64::from(args.flights));
    let report = run_cycle(&bench, || progress.inc(1));
    progress.finish_and_clear();
    print(
        &report.map_err(|error| Failure::new(FAILURE, error))?,
        args.json,
    )
}

fn print(report: &(impl Serialize + Display), json: bool) -> Result<u8, Failure> {
    if json {
        data(serde_json::to_string(report).map_err(|error| Failure::new(FAILURE, error))?);
    } else {
        data(report.to_string().trim_end());
    }
    Ok(0)
}

fn run_qp_bench(args: &QpArgs) -> Result<u8, Failure> {
    let instances = instances(args)?;
    if let Some(path) = &args.export {
        write_instances(path, &instances).map_err(|error| Failure::new(FAILURE, error))?;
        talk(format_args!(
            "{} programs in {}",
            instances.len(),
            path.display()
        ));
        return Ok(0);
    }
    let progress = ProgressBar::new(instances.len() as u64);
    let report = run_qp(&instances, || progress.inc(1));
    progress.finish_and_clear();
    print(
        &report.map_err(|error| Failure::new(FAILURE, error))?,
        args.json,
    )
}

fn instances(args: &QpArgs) -> Result<Vec<Instance>, Failure> {
    let mut instances = Vec::new();
    if let Some(path) = &args.instances {
        instances.extend(read_instances(path).map_err(|error| Failure::new(USAGE, error))?);
    }
    if let Some(count) = args.generate {
        let generated = generate(args.preset, count as usize, args.seed);
        instances.extend(generated.map_err(|error| Failure::new(FAILURE, error))?);
    }
    if instances.is_empty() {
        let why = "bench qp: give --instances FILE_OR_DIR, --generate N, or both";
        return Err(Failure::new(USAGE, why));
    }
    Ok(instances)
}
