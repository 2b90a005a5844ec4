//! `fly`: one flight, its log and its picture.

use super::ground::GroundArgs;
use super::scenario::{ScenarioArgs, replace};
use super::{FAILURE, Failure, LINK, USAGE, data, talk};
use crate::figure::flight_svg;
use crate::link::{FifoLink, Link, LinkError, PATIENCE, PipeLink, TcpLink};
use crate::log::{FlightLog, Summary};
use crate::outcome::Outcome;
use crate::run::{FlyError, fly_with};
use crate::scenario::{Preset, Scenario};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Clone, Debug, clap::Args)]
pub(super) struct FlyArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Seed of the field, of all noise and of the planner [default: 1]
    #[arg(long)]
    seed: Option<u64>,
    /// Obstacles between 25 m and 240 m downrange [default: 20]
    #[arg(long)]
    obstacles: Option<usize>,
    /// Candidate paths of a planning cycle; 0 tracks the shortest path itself, unrefined
    /// [default: 25]
    #[arg(long)]
    paths: Option<u16>,
    /// Parameters and rules [default: flight]
    #[arg(long, value_enum)]
    preset: Option<Preset>,
    /// Replanning rate [Hz]; 100 must be a whole multiple of it [default: 1]
    #[arg(long)]
    replan_hz: Option<f64>,
    /// Let an oracle fly: the true field and state, at 10 Hz
    #[arg(long, conflicts_with = "link")]
    oracle: bool,
    /// Where the core runs: tcp:HOST:PORT, or fifo:DIRECTORY with the FIFOs to-core and to-harness
    /// [default: in this process]
    #[arg(long)]
    link: Option<String>,
    /// Seconds that a silent core is waited for over TCP
    #[arg(long, default_value_t = PATIENCE.as_secs(), value_parser = clap::value_parser!(u64).range(1..))]
    patience: u64,
    #[command(flatten)]
    ground: GroundArgs,
    /// Print the result as one JSON object
    #[arg(long)]
    json: bool,
    /// Directory for the log and the picture
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

impl FlyArgs {
    fn scenario(&self) -> Result<Scenario, Failure> {
        let mut file = self.scenario.file()?;
        replace(&mut file.seed, self.seed);
        replace(&mut file.obstacles, self.obstacles);
        replace(&mut file.paths, self.paths);
        replace(&mut file.preset, self.preset);
        replace(&mut file.replan_hz, self.replan_hz);
        replace(&mut file.oracle, self.oracle.then_some(true));
        file.build().map_err(|error| Failure::new(USAGE, error))
    }

    fn connect(&self, scenario: &Scenario) -> Result<Box<dyn Link>, Failure> {
        match self.link.as_deref() {
            None => Ok(Box::new(PipeLink::of(scenario))),
            Some(text) => connect(text, Duration::from_secs(self.patience)),
        }
    }
}

/// A core that runs elsewhere.
fn connect(text: &str, patience: Duration) -> Result<Box<dyn Link>, Failure> {
    let failed = |error| Failure::new(LINK, error);
    match text.split_once(':') {
        Some(("tcp", address)) => Ok(Box::new(
            TcpLink::connect(address, patience).map_err(failed)?,
        )),
        Some(("fifo", directory)) => Ok(Box::new(
            FifoLink::open(Path::new(directory)).map_err(failed)?,
        )),
        _ => Err(Failure::new(
            USAGE,
            "--link: give tcp:HOST:PORT or fifo:DIRECTORY",
        )),
    }
}

/// The result line.
#[derive(Serialize)]
struct ResultLine<'a> {
    seed: u64,
    preset: &'a str,
    airframe: &'a str,
    obstacles: usize,
    paths: usize,
    #[serde(flatten)]
    summary: Summary,
    rejections: usize,
    log_hash: &'a str,
    log: String,
    figure: String,
}

pub(super) fn run(args: &FlyArgs) -> Result<u8, Failure> {
    let scenario = args.scenario()?;
    let mut link = args.connect(&scenario)?;
    talk(format_args!(
        "flying seed {} past {} obstacles, preset {}, {} paths, core {}",
        scenario.seed,
        scenario.field().obstacles.len(),
        scenario.preset.name(),
        scenario.paths,
        match args.link.as_deref() {
            None if scenario.oracle => "an oracle in this process",
            place => place.unwrap_or("in this process"),
        },
    ));
    let progress = progress_bar(u64::from(scenario.ticks));
    let mut crew = args.ground.open(&scenario, progress)?;
    let result = fly_with(&scenario, link.as_mut(), &mut crew);
    crew.ground.end(&result)?;
    let log = result.map_err(|error| Failure::new(exit_code(&error), error))?;
    report(args, &log)
}

/// Drawn on a terminal only.
fn progress_bar(ticks: u64) -> ProgressBar {
    let bar = ProgressBar::new(ticks);
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} ticks, {per_sec}, {eta} left");
    if let Ok(style) = style {
        bar.set_style(style);
    }
    bar
}

fn exit_code(error: &FlyError) -> u8 {
    match error {
        FlyError::Link(LinkError::Refused(_)) => USAGE,
        FlyError::Link(_) => LINK,
        FlyError::Plant(_) | FlyError::Trim(_) | FlyError::SetUp(_) => FAILURE,
    }
}

/// Writes log and picture, and prints the result.
fn report(args: &FlyArgs, log: &FlightLog) -> Result<u8, Failure> {
    let failed = |what: &Path, why: String| {
        Failure::new(FAILURE, format!("cannot write {}: {why}", what.display()))
    };
    std::fs::create_dir_all(&args.out).map_err(|error| failed(&args.out, error.to_string()))?;
    let name = format!("{}-seed{}", log.header.preset, log.header.seed);
    let log_path = args.out.join(format!("{name}.json"));
    let figure_path = args.out.join(format!("{name}.svg"));
    log.write_json(&log_path)
        .map_err(|error| failed(&log_path, error.to_string()))?;
    let svg = flight_svg(log).map_err(|error| failed(&figure_path, error.to_string()))?;
    std::fs::write(&figure_path, svg).map_err(|error| failed(&figure_path, error.to_string()))?;
    let hash = log
        .hash()
        .map_err(|error| failed(&log_path, error.to_string()))?;

    let line = ResultLine {
        seed: log.header.seed,
        preset: &log.header.preset,
        airframe: &log.header.airframe,
        obstacles: log.header.obstacles,
        paths: log.header.paths,
        summary: log.summary,
        rejections: log.rejections.len(),
        log_hash: &hash,
        log: log_path.display().to_string(),
        figure: figure_path.display().to_string(),
    };
    if args.json {
        let text = serde_json::to_string(&line).map_err(|error| Failure::new(FAILURE, error))?;
        data(text);
    } else {
        talk(format_args!("log {}, picture {}", line.log, line.figure));
        data(text_line(&line));
    }
    Ok(log.summary.outcome.exit_code())
}

fn text_line(line: &ResultLine<'_>) -> String {
    let Summary {
        outcome,
        strict,
        t_end,
        min_clearance,
        replans,
        candidates,
        feasible,
        ..
    } = line.summary;
    let strict = match (outcome, strict) {
        (Outcome::Survived, true) => " (strict)",
        (Outcome::Survived, false) => " (left the altitude band)",
        _ => "",
    };
    let clearance = match min_clearance {
        Some(clearance) => format!("{clearance:.2} m"),
        None => "none".to_owned(),
    };
    format!(
        "result: seed {}, {outcome}{strict} after {t_end:.2} s, clearance {clearance}, {replans} \
         replans, {candidates} candidates, {feasible} feasible, {} rejections, log {}",
        line.seed, line.rejections, line.log_hash
    )
}
