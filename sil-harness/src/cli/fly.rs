//! `fly`: flies one flight and writes its log and its picture.

use super::answer::{FAILURE, Failure, LEFT_BAND, LINK, USAGE, data, print_json, talk};
use super::detail::{flown_conditions, told_plans};
use super::file_name::file_name;
use super::ground::GroundArgs;
use super::help::{CORE, OUTPUT, PLANNER, WORLD};
use super::loudness::{Loudness, progress_bar};
use super::scenario::{ScenarioArgs, other, replace};
use super::signals::Signals;
use super::values::{generator, number, place, preset, seconds, seed, whole};
use crate::files::{read_field, try_directory, write_field, write_log, write_whole};
use crate::link::{FifoLink, PATIENCE, TcpLink};
use mpp_analysis::figure::flight_svg;
use mpp_sim::field::FieldFile;
use mpp_sim::flight::{FlyError, fly_with};
use mpp_sim::generator::GeneratorName;
use mpp_sim::link::{Link, LinkError};
use mpp_sim::log::{FlightLog, Header, Summary};
use mpp_sim::outcome::Outcome;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario, ScenarioError};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::FLY)]
pub(super) struct FlyArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Seed of the field, of all noise and of the planner [default: 1]
    #[arg(long, help_heading = WORLD, value_parser = seed)]
    seed: Option<u64>,
    /// Field of obstacles (TOML, as docs/fields.md); it stands alone unless --obstacles is given
    #[arg(long, help_heading = WORLD, value_name = "FILE")]
    field: Option<PathBuf>,
    /// Write all obstacles of the flight as a field, for --field
    #[arg(long, help_heading = WORLD, value_name = "FILE")]
    save_field: Option<PathBuf>,
    /// Generator of random obstacles [default: paper]
    #[arg(long, help_heading = WORLD, value_parser = generator())]
    generator: Option<GeneratorName>,
    /// Number of obstacles between 25 m and 240 m downrange [default: 20]
    #[arg(long, help_heading = WORLD, value_parser = whole::<usize>())]
    obstacles: Option<usize>,
    /// Number of candidate paths of a planning cycle; with 0 the core tracks the shortest path
    /// itself, without refinement [default: 25]
    #[arg(long, help_heading = PLANNER, value_parser = whole::<u16>())]
    paths: Option<u16>,
    /// Preset, which is a set of parameters and rules, or space, which has flags of its own: see `fly --preset space --help`
    /// [default: flight]
    #[arg(long, help_heading = PLANNER, value_parser = preset())]
    preset: Option<Preset>,
    /// Replanning rate [Hz]; 100 must be a whole multiple of it [default: 1]
    #[arg(long, help_heading = PLANNER, value_parser = number)]
    replan_hz: Option<f64>,
    /// Let an oracle fly, which knows the true field and state and replans at 10 Hz of the reference aircraft
    #[arg(long, help_heading = CORE, conflicts_with = "link")]
    oracle: bool,
    /// Place where the core runs: tcp:HOST:PORT, or fifo:DIRECTORY with the FIFOs to-core and
    /// to-harness [default: in this process]
    #[arg(long, help_heading = CORE)]
    link: Option<String>,
    /// Seconds to wait for a silent core over TCP [default: 10]
    #[arg(long, help_heading = CORE, value_name = "SECONDS", value_parser = seconds, requires = "link")]
    patience: Option<Duration>,
    #[command(flatten)]
    ground: GroundArgs,
    /// Fail with exit code 5 if the flight survives and leaves the altitude band of +-11 m
    #[arg(long, help_heading = OUTPUT)]
    strict: bool,
    #[command(flatten)]
    loudness: Loudness,
    /// Print the result as one JSON object
    #[arg(long, help_heading = OUTPUT)]
    json: bool,
    /// Directory for the log and the picture; their names say what differs from the preset's flight
    #[arg(long, help_heading = OUTPUT, default_value = "out")]
    out: PathBuf,
}

impl FlyArgs {
    fn scenario(&self) -> Result<Scenario, Failure> {
        let mut file = self.scenario.file()?;
        replace(&mut file.seed, self.seed);
        if let Some(path) = &self.field {
            file.field = read_field(path)?;
        }
        replace(&mut file.generator.name, self.generator);
        replace(&mut file.obstacles, self.obstacles);
        replace(&mut file.paths, self.paths);
        replace(&mut file.preset, self.preset);
        replace(&mut file.replan_hz, self.replan_hz);
        replace(&mut file.oracle, self.oracle.then_some(true));
        let field = self.field.as_ref().map(|path| path.display().to_string());
        let failed = |error: ScenarioError| Failure::usage(error.of_field(field.as_deref()));
        file.build().map_err(failed)
    }

    /// Whether a field was given that is not that of this scenario.
    fn other_field(&self, flown: &Scenario) -> Result<bool, Failure> {
        let Some(path) = &self.field else {
            return Ok(false);
        };
        let asked = read_field(path)?;
        Ok(asked != FieldFile::of(&flown.placed))
    }

    /// The scenario of a log whose orders are given again.
    fn scenario_of(&self, log: &FlightLog) -> Result<Scenario, Failure> {
        let usage = |why: String| Failure::usage(format!("--orders: {why}"));
        let flown = (log.header.scenario()).map_err(|error| usage(error.to_string()))?;
        let rate = |hz: f64| (hz - flown.replan_hz()).abs() > 1e-9;
        let flags = [
            ("--seed", other(self.seed, flown.seed)),
            ("--field", self.other_field(&flown)?),
            ("--generator", other(self.generator, flown.generator.name)),
            ("--obstacles", other(self.obstacles, flown.obstacles)),
            (
                "--paths",
                other(
                    self.paths.map(|paths| flown.preset.flown_paths(paths)),
                    flown.paths,
                ),
            ),
            ("--preset", other(self.preset, flown.preset)),
            ("--replan-hz", self.replan_hz.is_some_and(rate)),
            ("--oracle", self.oracle && !flown.oracle),
        ];
        let flags = flags.into_iter().chain(self.scenario.other_than(&flown)?);
        let mut other = flags.filter_map(|(flag, other)| other.then_some(flag));
        let file = || self.scenario.has_file() && self.scenario().is_ok_and(|asked| asked != flown);
        if let Some(flag) = other.next().or_else(|| file().then_some("--scenario")) {
            return Err(usage(format!(
                "the log's flight was flown with another {flag}: leave {flag} out"
            )));
        }
        if Header::of(&flown, &flown.field()).field != log.header.field {
            let why = "header.field is not what its seed draws: such a world cannot be flown here";
            return Err(usage(why.to_owned()));
        }
        Ok(flown)
    }

    fn connect(&self, scenario: &Scenario) -> Result<Box<dyn Link>, Failure> {
        match self.link.as_deref() {
            None => Ok(Box::new(PipeLink::of(scenario))),
            Some(text) => connect(text, self.patience),
        }
    }
}

/// Connects to a core that runs elsewhere.
pub(super) fn connect(text: &str, patience: Option<Duration>) -> Result<Box<dyn Link>, Failure> {
    let failed = |error| Failure::new(LINK, error);
    match text.split_once(':') {
        Some(("tcp", address)) if place(address).is_ok() => Ok(Box::new(
            TcpLink::connect(address, patience.unwrap_or(PATIENCE)).map_err(failed)?,
        )),
        Some(("fifo", _)) if patience.is_some() => Err(Failure::usage(
            "--patience: FIFOs wait as long as it takes: leave it out, or give --link tcp:HOST:PORT",
        )),
        Some(("fifo", directory)) => Ok(Box::new(
            FifoLink::open(Path::new(directory)).map_err(failed)?,
        )),
        _ => Err(Failure::usage(
            "--link: give tcp:HOST:PORT or fifo:DIRECTORY",
        )),
    }
}

/// The result line.
#[derive(Serialize)]
struct ResultLine<'a> {
    seed: u64,
    preset: &'a str,
    aircraft: &'a str,
    obstacles: usize,
    paths: usize,
    #[serde(flatten)]
    summary: Summary,
    rejections: usize,
    log_hash: &'a str,
    log: Option<String>,
    figure: Option<String>,
}

pub(super) fn run(args: &FlyArgs) -> Result<u8, Failure> {
    args.loudness.set();
    let recorded = args.ground.recorded()?;
    let scenario = match &recorded {
        Some(log) => args.scenario_of(log)?,
        None => args.scenario()?,
    };
    let signals = Signals::heed()?;
    try_directory(&args.out)?;
    let mut link = args.connect(&scenario)?;
    if let Some(path) = &args.save_field {
        let field = FieldFile::of(&scenario.field().obstacles);
        write_field(path, &field)?;
    }
    let progress = progress_bar(u64::from(scenario.ticks), "ticks");
    let mut crew = args.ground.open(&scenario, recorded, progress, signals)?;
    talk(format_args!(
        "flying seed {} past {} obstacles, preset {}, {} paths, core {}",
        scenario.seed,
        scenario.field().obstacles.len(),
        scenario.preset.name(),
        scenario.most_candidates(),
        match args.link.as_deref() {
            None if scenario.oracle => "an oracle in this process",
            place => place.unwrap_or("in this process"),
        },
    ));
    args.loudness.tell(|| flown_conditions(&scenario));
    let result = fly_with(&scenario, link.as_mut(), &mut crew);
    // The files first: nothing that goes wrong at the end of a link costs the log.
    let kept = result.as_ref().ok().map(|log| {
        let name = file_name(&scenario, &log.orders);
        keep(&args.out, &name, log)
    });
    let interrupted = crew.ground.interrupted();
    let ended = crew.ground.end(&result);
    let log = result.map_err(|error| Failure::new(exit_code(&error), error))?;
    let code = match kept.transpose()? {
        Some(kept) => {
            let code = report(args, &log, &kept)?;
            kept.written?;
            code
        }
        None => FAILURE,
    };
    ended?;
    let was = log.summary.outcome == Outcome::Interrupted;
    Ok(interrupted.filter(|_| was).unwrap_or(code))
}

/// The exit code of a command whose flight has no outcome.
pub(super) fn exit_code(error: &FlyError) -> u8 {
    match error {
        FlyError::Scenario(_) | FlyError::Link(LinkError::Refused(_)) => USAGE,
        FlyError::Link(_) => LINK,
        FlyError::Plant(_) | FlyError::Trim(_) | FlyError::SetUp(_) => FAILURE,
    }
}

/// What a flight left on the disk.
pub(super) struct Kept {
    log: Option<PathBuf>,
    /// None of a flight that ended before its first tick.
    figure: Option<PathBuf>,
    hash: String,
    /// The reason why a file is missing. It does not cost the result.
    pub(super) written: Result<(), Failure>,
}

/// Writes log and picture.
pub(super) fn keep(out: &Path, name: &str, log: &FlightLog) -> Result<Kept, Failure> {
    let mut kept = Kept {
        log: None,
        figure: None,
        hash: log.hash().map_err(Failure::failed)?,
        written: Ok(()),
    };
    kept.written = kept.write(out, name, log);
    Ok(kept)
}

impl Kept {
    fn write(&mut self, out: &Path, name: &str, log: &FlightLog) -> Result<(), Failure> {
        let path = out.join(format!("{name}.json"));
        write_log(&path, log).map_err(Failure::failed)?;
        self.log = Some(path);
        if !log.ticks.t.is_empty() {
            let path = out.join(format!("{name}.svg"));
            let svg = flight_svg(log).map_err(|error| {
                let what = format!("cannot write {}: {error}", path.display());
                Failure::failed(what)
            })?;
            write_whole(&path, svg.as_bytes())?;
            self.figure = Some(path);
        }
        Ok(())
    }
}

/// Prints the result. Returns the exit code.
fn report(args: &FlyArgs, log: &FlightLog, kept: &Kept) -> Result<u8, Failure> {
    told(args.json, log, kept)?;
    args.loudness.tell(|| told_plans(log));
    let left_band = log.summary.outcome == Outcome::Survived && !log.summary.strict;
    if args.strict && left_band {
        return Ok(LEFT_BAND);
    }
    Ok(log.summary.outcome.exit_code())
}

/// Prints the result, as JSON or as a line.
pub(super) fn told(json: bool, log: &FlightLog, kept: &Kept) -> Result<(), Failure> {
    let shown = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
    let line = ResultLine {
        seed: log.header.seed,
        preset: &log.header.preset,
        aircraft: &log.header.aircraft.name,
        obstacles: log.header.obstacles,
        paths: log.header.paths,
        summary: log.summary,
        rejections: log.rejections.len(),
        log_hash: &kept.hash,
        log: shown(&kept.log),
        figure: shown(&kept.figure),
    };
    if json {
        return print_json(&line);
    }
    if let Some(file) = &line.log {
        let figure = line.figure.as_deref().unwrap_or("none: nothing was flown");
        talk(format_args!("log {file}, picture {figure}"));
    }
    data(text_line(&line))
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
