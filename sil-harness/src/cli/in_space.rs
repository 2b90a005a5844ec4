//! `fly --preset space` and `campaign --preset space`: the planner in space, over the link, on the plant in six degrees of freedom.
//! Their flags are others than those of the vertical plane, so they are commands of their own behind the same names.

use super::answer::{Failure, data, print_json, talk};
use super::ceiling_in_space::CeilingInSpace;
use super::fly::{connect, exit_code, keep, told};
use super::help::{CAMPAIGN_IN_SPACE, CORE, FLY_IN_SPACE, OUTPUT, PLANNER, RUN, WORLD};
use super::signals::Signals;
use super::space_cell::{SpaceCell, SpaceRow};
use super::stage::Stage;
use super::values::{
    Item, baseline, lidar, mode, number, or_usual, seed, threads, whole, wind, within,
};
use crate::campaign::pool;
use crate::files::{read_log, read_stems, read_terrain, try_directory};
use clap::{Parser, Subcommand};
use mpp_sim::link::Link;
use mpp_sim::log::FlightLog;
use mpp_sim::orders::OrderEntry;
use mpp_sim::outcome::Outcome;
use mpp_sim::space::lidar::LidarName;
use mpp_sim::space::{
    BaselineName, ModeName, SPACE, STACK, SpaceFile, SpacePipe, SpaceScenario, fly_space_again,
};
use rayon::prelude::*;
use std::ffi::OsString;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// The commands of preset `space`.
#[derive(Debug, Parser)]
#[command(name = "sil-harness", version, args_conflicts_with_subcommands = true)]
pub(super) struct SpaceCli {
    #[command(subcommand)]
    command: Option<SpaceCommand>,
    #[command(flatten)]
    fly: FlyInSpace,
}

#[derive(Debug, Subcommand)]
enum SpaceCommand {
    /// Fly once through a world in space
    Fly(FlyInSpace),
    /// Fly many times, in parallel, and give success rates with their intervals
    Campaign(CampaignInSpace),
    /// Tell which forests can be passed at all: blocked by proof, or passable with a flight as witness
    Ceiling(CeilingInSpace),
}

/// What is flown.
#[derive(Clone, Debug, clap::Args)]
struct InSpace {
    #[command(flatten)]
    stage: Stage,
    /// World: a CSV table of trunks with the columns x (ahead), y (right), diameter and perhaps height [m]
    #[arg(long, help_heading = WORLD, value_name = "FILE", conflicts_with_all = ["world", "density"])]
    stems: Option<PathBuf>,
    /// World: an ESRI ASCII grid of heights [m], east ahead, coordinates from the start on
    #[arg(long, help_heading = WORLD, value_name = "FILE", conflicts_with_all = ["world", "density", "stems"])]
    terrain: Option<PathBuf>,
    /// Wanted height over terrain or hills, above the ground at the start [m] [default: 15]
    #[arg(long, help_heading = WORLD, value_name = "M", value_parser = number)]
    altitude: Option<f64>,
    /// Side of the windows of walls [m] [default: 5]
    #[arg(long, help_heading = WORLD, value_name = "M", value_parser = number)]
    window: Option<f64>,
    /// Lidar; of scattered beams those ahead, at most 2,000 a sweep [default: grid-90x16]
    #[arg(long, help_heading = WORLD, value_parser = lidar())]
    lidar: Option<LidarName>,
    /// Greatest range of the lidar [m], as in haze or before dark bark; 5 or more [default: what the lidar has]
    #[arg(long, help_heading = WORLD, value_name = "M", value_parser = number)]
    sight: Option<f64>,
    /// Measurements without errors
    #[arg(long, help_heading = WORLD)]
    exact: bool,
    /// Let beams go through what they hit and return all that is on their way: nothing hides anything
    #[arg(long, help_heading = WORLD)]
    see_through: bool,
    /// What becomes of a plan without a way out, in space that was seen free [default: forest]
    #[arg(long, help_heading = PLANNER, value_parser = mode())]
    mode: Option<ModeName>,
    /// Steady wind ahead, to the right and up [m/s]
    #[arg(long, help_heading = WORLD, value_name = "X,Y,Z", value_parser = wind, allow_hyphen_values = true)]
    wind: Option<[f64; 3]>,
    /// Standard deviation of the vertical gusts [m/s], 0 to 5; those along and across are 1.6 times as strong. Light turbulence of
    /// MIL-F-8785C has 0.77
    #[arg(long, help_heading = WORLD, value_name = "M/S", value_parser = number)]
    gusts: Option<f64>,
    /// Let all beams of a sweep bear the time of its end, and not their own
    #[arg(long, help_heading = WORLD)]
    no_deskew: bool,
    /// Error of the lidar's clock [ms], -20 to 100: beams seem so much older than they are
    #[arg(long, help_heading = WORLD, value_name = "MS", value_parser = number)]
    lidar_clock: Option<f64>,
    /// Candidates of a cycle, the previous plan included [default: 3]; of the baseline paper its paths [default: 25]
    #[arg(long, help_heading = PLANNER, value_name = "N", value_parser = within(0, u8::MAX))]
    candidates: Option<u8>,
    /// Fly the best candidate as it is, without a program
    #[arg(long, help_heading = PLANNER)]
    no_programs: bool,
    /// Fly a simple planner in place of ours, on the same map, estimate, regulator and plant
    #[arg(long, help_heading = PLANNER, value_parser = baseline(), conflicts_with = "no_programs")]
    baseline: Option<BaselineName>,
    /// Replanning rate [Hz], 1 to 10 [default: 10]
    #[arg(long, help_heading = PLANNER, value_parser = number)]
    replan_hz: Option<f64>,
    /// Time from the start of a cycle until its plan is flown [ms], a multiple of 10 [default: 50]
    #[arg(long, help_heading = PLANNER, value_name = "MS", value_parser = whole::<u32>())]
    latency_ms: Option<u32>,
    /// Seed of world and measurements; the next flights of a campaign take the next seeds [default: 1]
    #[arg(long, help_heading = WORLD, value_parser = seed)]
    seed: Option<u64>,
    /// Print one JSON object
    #[arg(long, help_heading = OUTPUT)]
    json: bool,
}

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = FLY_IN_SPACE)]
pub(super) struct FlyInSpace {
    #[command(flatten)]
    flown: InSpace,
    /// Density of the world: trunks/m^2, walls or rows per m, or the spheres' share of the volume
    #[arg(long, help_heading = WORLD, value_name = "DENSITY", value_parser = number)]
    density: Option<f64>,
    /// Place where the core runs: tcp:HOST:PORT, or fifo:DIRECTORY with the FIFOs to-core and to-harness [default: in this process]
    #[arg(long, help_heading = CORE, conflicts_with = "baseline")]
    link: Option<String>,
    /// Log of a flight with the same flags: plants its trunks again, each at its tick
    #[arg(long, help_heading = WORLD, value_name = "LOG")]
    orders: Option<PathBuf>,
    /// Directory for the log and the picture
    #[arg(long, help_heading = OUTPUT, default_value = "out")]
    out: PathBuf,
}

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = CAMPAIGN_IN_SPACE)]
pub(super) struct CampaignInSpace {
    #[command(flatten)]
    flown: InSpace,
    /// Densities of the world, a list: each is a cell
    #[arg(long, help_heading = WORLD, value_delimiter = ',', value_parser = Item(number))]
    density: Vec<f64>,
    /// Number of flights in each cell
    #[arg(long, help_heading = RUN, default_value_t = 100, value_parser = within(1, u32::MAX))]
    trials: u32,
    /// Number of threads, at most 1024 and no more than there is work for; 0 takes every core
    #[arg(long, help_heading = RUN, default_value_t = 0, value_parser = threads())]
    threads: usize,
    /// Row file (JSON lines) to write: one line a flight
    #[arg(long, help_heading = OUTPUT, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Whether these arguments ask for preset `space` of a command that has it.
pub(super) fn is_asked(args: &[OsString]) -> bool {
    let named = args
        .iter()
        .skip(1)
        .find(|arg| !arg.to_string_lossy().starts_with('-'));
    let has = |command: &OsString| {
        ["fly", "campaign", "ceiling", SPACE]
            .iter()
            .any(|it| command == it)
    };
    let pair =
        |pair: &[OsString]| matches!(pair, [flag, value] if flag == "--preset" && value == SPACE);
    let asked = args.windows(2).any(pair) || args.iter().any(|arg| arg == "--preset=space");
    asked && named.is_none_or(has)
}

impl SpaceCli {
    pub(super) fn run(self) -> Result<u8, Failure> {
        let fly = || match &self.command {
            None => fly(&self.fly),
            Some(SpaceCommand::Fly(args)) => fly(args),
            Some(SpaceCommand::Campaign(args)) => campaign(args),
            Some(SpaceCommand::Ceiling(args)) => args.run(),
        };
        let threads = match &self.command {
            Some(SpaceCommand::Campaign(args)) => args.threads,
            Some(SpaceCommand::Ceiling(args)) => args.threads,
            _ => 1,
        };
        let pool = pool(threads, usize::MAX, STACK).map_err(Failure::failed)?;
        pool.install(fly)
    }
}

impl InSpace {
    fn scenario(&self, density: Option<f64>, seed: u64) -> Result<SpaceScenario, Failure> {
        let stems = self.stems.as_ref().map(|path| read_stems(path));
        let terrain = self.terrain.as_ref().map(|path| read_terrain(path));
        let file = SpaceFile {
            density,
            terrain: terrain.transpose().map_err(Failure::usage)?,
            altitude: self.altitude,
            window: self.window,
            lidar: self.lidar.map(|it| it.name().to_owned()),
            sight: self.sight,
            exact: Some(self.exact),
            see_through: Some(self.see_through),
            candidates: self.candidates,
            programs: self.no_programs.then_some(false),
            baseline: self.baseline.map(|it| it.name().to_owned()),
            mode: self.mode.map(|it| it.name().to_owned()),
            wind: self.wind,
            gusts: self.gusts,
            deskew: self.no_deskew.then_some(false),
            lidar_clock: self.lidar_clock,
            replan_hz: self.replan_hz,
            latency_ms: self.latency_ms,
            seed: Some(seed),
            ..self.stage.file()?
        };
        let stems = stems.transpose().map_err(Failure::usage)?;
        file.build(stems.as_deref()).map_err(Failure::usage)
    }
}

fn flown(
    scenario: &SpaceScenario,
    link: Option<&str>,
    orders: &[OrderEntry],
    signals: &Signals,
) -> Result<FlightLog, Failure> {
    let stops = || signals.raised().is_some();
    let mut link: Box<dyn Link> = match link {
        Some(place) => connect(place, None)?,
        None => Box::new(SpacePipe::of(scenario)),
    };
    fly_space_again(scenario, link.as_mut(), orders, stops)
        .map_err(|error| Failure::new(exit_code(&error), error))
}

/// The orders of the log that is flown again.
fn orders(args: &FlyInSpace, scenario: &SpaceScenario) -> Result<Vec<OrderEntry>, Failure> {
    let usage = |why: String| Failure::usage(format!("--orders: {why}"));
    let Some(path) = &args.orders else {
        return Ok(Vec::new());
    };
    let log = read_log(path).map_err(|error| usage(error.to_string()))?;
    if log.header != scenario.header() {
        let why = "the log's flight had other flags: give those that it was flown with";
        return Err(usage(why.to_owned()));
    }
    Ok(log.orders)
}

fn fly(args: &FlyInSpace) -> Result<u8, Failure> {
    let seed = args.flown.seed.unwrap_or(1);
    let scenario = args.flown.scenario(args.density, seed)?;
    let orders = orders(args, &scenario)?;
    let signals = Signals::heed()?;
    try_directory(&args.out)?;
    talk(format_args!(
        "flying seed {seed} through {} bodies, preset {SPACE}, core {}",
        scenario.world.bodies().len(),
        args.link.as_deref().unwrap_or("in this process")
    ));
    let log = flown(&scenario, args.link.as_deref(), &orders, &signals)?;
    let usual = SpaceFile {
        seed: Some(seed),
        ..SpaceFile::default()
    };
    let usual = usual.build(None).map_err(Failure::failed)?;
    let mut name = format!("{SPACE}-seed{seed}");
    if usual.header() != log.header || !log.orders.is_empty() {
        let header = FlightLog {
            orders: log.orders.clone(),
            ..FlightLog::begin(log.header.clone())
        };
        let header = header.hash();
        name += &format!("-{}", &header.map_err(Failure::failed)?[..8]);
    }
    let kept = keep(&args.out, &name, &log)?;
    told(args.flown.json, &log, &kept)?;
    kept.written?;
    let was = log.summary.outcome == Outcome::Interrupted;
    let code = log.summary.outcome.exit_code();
    Ok(signals.raised().filter(|_| was).unwrap_or(code))
}

fn campaign(args: &CampaignInSpace) -> Result<u8, Failure> {
    let first = args.flown.seed.unwrap_or(1);
    let densities = or_usual(&args.density);
    let signals = Signals::heed()?;
    // What cannot be flown is refused before the file is made.
    for density in &densities {
        args.flown.scenario(*density, first)?;
    }
    let file = args.out.as_ref().map(|path| {
        let opened = OpenOptions::new().write(true).create_new(true).open(path);
        opened.map_err(|error| Failure::usage(format!("--out {}: {error}", path.display())))
    });
    let file = Mutex::new(file.transpose()?);
    let mut cells = Vec::new();
    for density in densities {
        let seeds: Vec<u64> = (first..).take(args.trials as usize).collect();
        let rows: Vec<SpaceRow> = seeds
            .par_iter()
            .map(|seed| {
                let row = row(&args.flown.scenario(density, *seed)?, *seed, &signals)?;
                let mut file = file.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some(file) = file.as_mut() {
                    let line = serde_json::to_string(&row).map_err(Failure::failed)?;
                    writeln!(file, "{line}").map_err(Failure::failed)?;
                }
                Ok(row)
            })
            .collect::<Result<_, Failure>>()?;
        let cell = SpaceCell::of(&rows);
        if !args.flown.json {
            data(cell.to_string())?;
        }
        cells.push(cell);
    }
    if args.flown.json {
        print_json(&cells)?;
    }
    Ok(0)
}

fn row(scenario: &SpaceScenario, seed: u64, signals: &Signals) -> Result<SpaceRow, Failure> {
    let log = flown(scenario, None, &[], signals)?;
    if let Some(code) = signals.raised() {
        return Err(Failure::new(
            code,
            "interrupted: the rows so far are written",
        ));
    }
    let log_hash = log.hash().map_err(Failure::failed)?;
    let space = log.header.space.as_ref();
    let over = space.is_some_and(|space| space.terrain.is_some());
    let given = if over { "terrain" } else { "stems" };
    Ok(SpaceRow {
        world: space
            .and_then(|space| space.world.clone())
            .unwrap_or_else(|| given.to_owned()),
        density: space.and_then(|space| space.density),
        seed,
        outcome: log.summary.outcome,
        cause: log.summary.failure.map(|it| it.cause),
        seen_before: log.summary.failure.and_then(|it| it.seen_before),
        t_end: log.summary.t_end,
        x_end: log.summary.x_end,
        min_clearance: log.summary.min_clearance,
        replans: log.summary.replans,
        way_out: log.knows_way_out(),
        log_hash,
    })
}
