//! `bench`: measures our parts and others in one run.

mod authors;

use super::answer::{Failure, print, talk};
use super::scenario::{ScenarioArgs, replace};
use super::values::{number, preset, seed, whole, within};
use crate::files::{read_instances, write_instances};
use indicatif::ProgressBar;
use mpp_analysis::bench::{CycleBench, DENSE, SPARSE, generate, run_cycle};
use mpp_analysis::instance::Instance;
use mpp_sim::scenario::Preset;
use std::path::PathBuf;

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::BENCH)]
pub(super) struct BenchArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Clone, Debug, clap::Subcommand)]
enum What {
    /// Compare the QP solver with Clarabel on the same programs; one thread, best of several runs. It
    /// needs a build with the cargo feature `clarabel`, except to export the programs
    Qp(QpArgs),
    /// Compare a planning cycle of preset flight with one of reference, stage by stage, on the same
    /// recorded cycles; one thread, best of several runs
    Cycle(CycleArgs),
}

#[derive(Clone, Debug, clap::Args)]
struct CycleArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Number of random obstacles in the recorded flights [default: the scenario's, else 40]
    #[arg(long)]
    obstacles: Option<usize>,
    /// Number of candidate paths of a cycle [default: 25]
    #[arg(long, value_parser = whole::<u16>())]
    paths: Option<u16>,
    /// Replanning rate [Hz] [default: 1]
    #[arg(long, value_parser = number)]
    replan_hz: Option<f64>,
    /// Number of flights to record
    #[arg(long, default_value_t = 20, value_parser = within(1, u32::MAX))]
    flights: u32,
    /// Seed of the first flight; the next flights take the next seeds [default: 1]
    #[arg(long, value_parser = seed)]
    seed: Option<u64>,
    /// Number of times that each cycle is planned; the fastest counts
    #[arg(long, default_value_t = 5, value_parser = within(1, u32::MAX))]
    runs: u32,
    /// Plan with the authors' own code too, five flights from the same seed: the Python of the environment
    /// that bench/authors/README.md sets up. The command then runs in the root of the repository
    #[arg(long, value_name = "PYTHON")]
    authors: Option<PathBuf>,
    /// Print the report as one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Debug, clap::Args)]
struct QpArgs {
    /// Programs to solve: a recorded case_*.json, a directory of them, or a file that --export
    /// wrote
    #[arg(long)]
    instances: Option<PathBuf>,
    /// Number of programs to generate from flights
    #[arg(long, value_parser = within(1_u32, 1_000_000))]
    generate: Option<u32>,
    /// Generate them from flights past 120 to 240 obstacles, and not 20 to 60
    #[arg(long, requires = "generate")]
    dense: bool,
    /// Seed of the first flight from which programs are generated
    #[arg(long, default_value_t = 1, value_parser = seed)]
    seed: u64,
    /// Preset of those flights; `flight` has soft rows
    #[arg(long, value_parser = preset(), default_value_t = Preset::Reference)]
    preset: Preset,
    /// Write the programs to a file, one JSON object per line, and do not solve them
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
    replace(&mut file.obstacles, args.obstacles);
    // A scene or a field of the scenario stands alone, as in a flight.
    if file.scene.is_none() && file.field.is_empty() {
        file.obstacles.get_or_insert(40);
    }
    replace(&mut file.paths, args.paths);
    replace(&mut file.replan_hz, args.replan_hz);
    replace(&mut file.seed, args.seed);
    let bench = CycleBench {
        scenario: file.build().map_err(Failure::usage)?,
        flights: args.flights,
        runs: args.runs,
    };
    let progress = ProgressBar::new(u64::from(args.flights));
    let report = run_cycle(&bench, || progress.inc(1));
    progress.finish_and_clear();
    let report = report.map_err(Failure::failed)?;
    let Some(python) = &args.authors else {
        print(&report, args.json)?;
        return Ok(0);
    };
    print(&authors::compare(python, report)?, args.json)?;
    Ok(0)
}

fn run_qp_bench(args: &QpArgs) -> Result<u8, Failure> {
    if args.export.is_none() && cfg!(not(feature = "clarabel")) {
        let why = "bench qp: this program was built without Clarabel: build it with `--features clarabel`, \
                   or write the programs to a file with --export";
        return Err(Failure::usage(why));
    }
    let instances = instances(args)?;
    if let Some(path) = &args.export {
        write_instances(path, &instances)?;
        talk(format_args!(
            "{} programs in {}",
            instances.len(),
            path.display()
        ));
        return Ok(0);
    }
    compare(&instances, args.json)?;
    Ok(0)
}

#[cfg(feature = "clarabel")]
fn compare(instances: &[Instance], json: bool) -> Result<(), Failure> {
    let progress = ProgressBar::new(instances.len() as u64);
    let report = mpp_analysis::bench::run_qp(instances, || progress.inc(1));
    progress.finish_and_clear();
    print(&report.map_err(Failure::failed)?, json)
}

#[cfg(not(feature = "clarabel"))]
fn compare(_: &[Instance], _: bool) -> Result<(), Failure> {
    // Refused above, before the programs are made.
    Ok(())
}

fn instances(args: &QpArgs) -> Result<Vec<Instance>, Failure> {
    let mut instances = Vec::new();
    if let Some(path) = &args.instances {
        instances.extend(read_instances(path)?);
    }
    if let Some(count) = args.generate {
        let obstacles = if args.dense { DENSE } else { SPARSE };
        let generated = generate(args.preset, obstacles, count as usize, args.seed);
        instances.extend(generated.map_err(Failure::failed)?);
    }
    if instances.is_empty() {
        let why = "bench qp: give --instances FILE_OR_DIR, --generate N, or both";
        return Err(Failure::usage(why));
    }
    Ok(instances)
}
