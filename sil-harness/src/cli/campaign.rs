//! `campaign`: flies many flights over a grid, in parallel; a stopped campaign can be continued.

use super::answer::{FAILURE, Failure, USAGE, data, print_json, talk};
use super::fly::exit_code;
use super::help::{OUTPUT, PLANNER, RUN};
use super::loudness::{Loudness, progress_bar};
use super::scenario::{FieldArgs, ScenarioArgs, replace};
use super::signals::Signals;
use super::values::{Item, number, preset, seed, threads, whole, width, within};
use crate::campaign::{CampaignError, Extras, RowFile, decide_all, header, read, run as fly_all};
use clap::builder::StringValueParser;
use mpp_analysis::campaign::{
    Campaign, Cell, CellReport, Lists, Report, Row, Sequential, Shard, Taxonomy, merge,
};
use mpp_analysis::rows::Header;
use mpp_sim::scenario::{Preset, ScenarioFile};
use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// The flags that say what is flown, and how it is kept; the first two are all flags of their groups. Row files say it
/// themselves.
const FLOWN: [&str; 14] = [
    "ScenarioArgs",
    "FieldArgs",
    "paths",
    "preset",
    "replan_hz",
    "oracle",
    "trials",
    "until_width",
    "seed",
    "shard",
    "timing",
    "out",
    "faults",
    "pairs",
];

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::CAMPAIGN)]
pub(super) struct CampaignArgs {
    #[command(flatten)]
    pub(super) scenario: ScenarioArgs,
    #[command(flatten)]
    field: FieldArgs,
    /// Numbers of candidate paths of a planning cycle, a list [default: the scenario's]
    #[arg(long, help_heading = PLANNER, value_delimiter = ',', value_parser = Item(whole::<u16>()))]
    pub(super) paths: Vec<u16>,
    /// Presets, a list, or space, which has flags of its own: see `campaign --preset space --help` [default: the scenario's]
    #[arg(long, help_heading = PLANNER, value_delimiter = ',', value_parser = Item(preset()))]
    pub(super) preset: Vec<Preset>,
    /// Replanning rates [Hz], a list [default: the scenario's]
    #[arg(long, help_heading = PLANNER, value_delimiter = ',', value_parser = Item(number))]
    replan_hz: Vec<f64>,
    /// Let an oracle fly the same fields too, and give success as a share of the fields that it
    /// flies. With --faults it flies with the faults
    #[arg(long, help_heading = RUN)]
    oracle: bool,
    /// Also tell which of the fields can be passed at all, as `ceiling` does without a margin, and give success as a
    /// share of these
    #[arg(long, help_heading = RUN)]
    ceiling: bool,
    /// Fly pairs of flights without and with faults instead: the named faults, a list, or all. The cells are
    /// 20 obstacles at 1 Hz and 40 obstacles at 4 Hz, unless flags or scenario name obstacles, a rate, a scene or
    /// a field. Such a campaign keeps no row file
    #[arg(
        long,
        help_heading = RUN,
        value_name = "NAME",
        value_delimiter = ',',
        value_parser = Item(StringValueParser::new()),
        conflicts_with_all = ["out", "report", "shard", "ceiling", "timing", "taxonomy"]
    )]
    pub(super) faults: Vec<String>,
    /// With --faults: fly pairs of these faults, each with a start of its own, drawn by the seed; --trials is the number of
    /// flights. Two faults of one table of the scenario make no pair
    #[arg(long, help_heading = RUN, requires = "faults", conflicts_with = "oracle")]
    pub(super) pairs: bool,
    /// Number of flights in each cell
    #[arg(long, help_heading = RUN, default_value_t = 100, value_parser = within(1, u32::MAX))]
    pub(super) trials: u32,
    /// Fly each cell until the 95 % interval of its strict successes is at most so wide [percentage points], or --trials is
    /// reached. Every 20 flights decide
    #[arg(
        long,
        help_heading = RUN,
        value_name = "POINTS",
        value_parser = width,
        conflicts_with_all = ["faults", "oracle", "ceiling", "shard"],
        allow_negative_numbers = true
    )]
    until_width: Option<f64>,
    /// Seed of the first flight; the next flights take the next seeds [default: the scenario's]
    #[arg(long, help_heading = RUN, value_parser = seed)]
    pub(super) seed: Option<u64>,
    /// Number of threads, at most 1024 and no more than there is work for; 0 takes every core
    #[arg(long, help_heading = RUN, default_value_t = 0, value_parser = threads())]
    pub(super) threads: usize,
    /// Fly only the i-th of n parts, such as 2/8
    #[arg(long, help_heading = RUN, default_value = "1/1")]
    shard: Shard,
    /// Row file (JSON lines) to write or to continue
    #[arg(long, help_heading = OUTPUT, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Also measure the core's wall time; it depends on the machine
    #[arg(long, help_heading = RUN)]
    timing: bool,
    /// Fly nothing; report the rows of these files, which are shards of one campaign
    #[arg(long, help_heading = OUTPUT, value_name = "FILE", num_args = 1.., conflicts_with_all = FLOWN)]
    report: Vec<PathBuf>,
    /// Also print the causes of failures for each cell, the most frequent cause first; the JSON
    /// report always holds them
    #[arg(long, help_heading = OUTPUT)]
    taxonomy: bool,
    #[command(flatten)]
    pub(super) loudness: Loudness,
    /// Print the report as one JSON object
    #[arg(long, help_heading = OUTPUT)]
    pub(super) json: bool,
}

pub(super) fn run(args: &CampaignArgs) -> Result<u8, Failure> {
    args.loudness.set();
    if !args.report.is_empty() && !args.ceiling && args.threads > 0 {
        let why = "--report flies nothing: leave --threads out, or give --ceiling";
        return Err(Failure::usage(why));
    }
    let (campaign, rows, told) = if args.report.is_empty() {
        flown(args)?
    } else {
        let (campaign, rows) = rows_of(&args.report).map_err(|error| failure(&error))?;
        (campaign, rows, None)
    };
    let mut report = Report::new(&campaign, &rows);
    if args.ceiling {
        set_beside_ceiling(&campaign, &rows, &mut report, args.threads)?;
    }
    if args.json {
        print_json(&report)?;
    } else {
        data(report.to_string().trim_end())?;
        if args.taxonomy {
            data(Taxonomy(&report).to_string().trim_end())?;
        }
    }
    if let Some(told) = told {
        if args.json {
            talk(told);
        } else {
            data(told)?;
        }
    }
    Ok(0)
}

pub(super) fn failure(error: &CampaignError) -> Failure {
    let code = match error {
        CampaignError::Flight(.., why)
        | CampaignError::Faulty(.., why)
        | CampaignError::Pair(.., why) => exit_code(why),
        CampaignError::Stopped
        | CampaignError::Log(..)
        | CampaignError::Full(..)
        | CampaignError::Open(..)
        | CampaignError::Interrupted(_)
        | CampaignError::Disagree(_) => FAILURE,
        CampaignError::Scenario(_)
        | CampaignError::Ceiling(_)
        | CampaignError::Read(..)
        | CampaignError::NoFile(_)
        | CampaignError::NoRowFile(_)
        | CampaignError::Line(..)
        | CampaignError::Differs(..)
        | CampaignError::Busy(_)
        | CampaignError::NoRows
        | CampaignError::Threads(_) => USAGE,
    };
    Failure::new(code, error)
}

/// Decides about the fields of every kind once, and sets the flights beside the verdicts.
pub(super) fn set_beside_ceiling(
    campaign: &Campaign,
    rows: &[Row],
    report: &mut Report,
    threads: usize,
) -> Result<(), Failure> {
    let signals = Signals::heed()?;
    for cell in campaign.cells() {
        let is_set = |one: &CellReport| one.cell == cell && one.against_ceiling.is_some();
        if !report.cells.iter().any(is_set) {
            let done = || match signals.raised() {
                Some(_) => Err(CampaignError::Stopped),
                None => Ok(()),
            };
            let verdicts = decide_all(campaign, &cell, 0.0, threads, done);
            let verdicts = verdicts.map_err(|error| failure(&error))?;
            report.set_beside(&cell, rows, &verdicts);
        }
    }
    Ok(())
}

/// The campaign of row files, and its rows.
pub(super) fn rows_of(paths: &[PathBuf]) -> Result<(Campaign, Vec<Row>), CampaignError> {
    let mut first: Option<Header> = None;
    let mut rows = Vec::new();
    for path in paths {
        let (mut header, found) = read(path)?;
        rows.extend(found);
        let first = first.get_or_insert_with(|| header.clone());
        header.shard = first.shard;
        if let Some(what) = first.difference(&header) {
            return Err(CampaignError::Differs(path.display().to_string(), what));
        }
    }
    let campaign = first.ok_or(CampaignError::NoRows)?.campaign;
    let rows = merge(&campaign, rows).map_err(CampaignError::Disagree)?;
    Ok((campaign, rows))
}

/// The lists of the command line.
pub(super) fn lists(args: &CampaignArgs) -> Result<Lists, Failure> {
    Ok(Lists {
        preset: args.preset.clone(),
        paths: args.paths.clone(),
        replan_hz: args.replan_hz.clone(),
        ..args.field.lists()?
    })
}

/// The scenario of the command line.
pub(super) fn scenario(args: &CampaignArgs) -> Result<ScenarioFile, Failure> {
    let mut scenario = args.scenario.file()?;
    replace(&mut scenario.oracle, args.oracle.then_some(true));
    Ok(scenario)
}

/// Flies the campaign. With --until-width the text tells how it stopped.
fn flown(args: &CampaignArgs) -> Result<(Campaign, Vec<Row>, Option<String>), Failure> {
    let scenario = scenario(args)?;
    let campaign = Campaign::new(scenario, lists(args)?, args.trials, args.seed);
    let campaign = campaign.map_err(Failure::usage)?;
    let signals = Signals::heed()?;
    let (rows, told) =
        fly_rows(args, &campaign, &signals).map_err(|error| match signals.raised() {
            Some(code) if matches!(error, CampaignError::Interrupted(_)) => {
                Failure::new(code, error)
            }
            _ => failure(&error),
        })?;
    let rows = merge(&campaign, rows).map_err(Failure::failed)?;
    Ok((campaign, rows, told))
}

/// Flies the missing flights and returns every row of this shard, or of the blocks up to the stop.
fn fly_rows(
    args: &CampaignArgs,
    campaign: &Campaign,
    signals: &Signals,
) -> Result<(Vec<Row>, Option<String>), CampaignError> {
    let (file, rows) = match &args.out {
        Some(path) => {
            let header = header(campaign.clone(), args.shard)?;
            RowFile::open(path, &header).map(|(file, rows)| (Some(file), rows))?
        }
        None => (None, Vec::new()),
    };
    let mut kept = Kept { file, rows };
    let Some(points) = args.until_width else {
        let jobs = campaign.jobs(args.shard);
        let kept = fly_missing(args, campaign, signals, &jobs, kept)?;
        return Ok((kept.rows, None));
    };
    let mut sequential = Sequential::new(campaign, points / 100.0);
    loop {
        let block = sequential.next_block(&kept.rows);
        if block.is_empty() {
            break;
        }
        kept = fly_missing(args, campaign, signals, &block, kept)?;
    }
    kept.rows.retain(|row| sequential.counts(row));
    Ok((kept.rows, Some(sequential.to_string())))
}

/// The rows so far, and the file that they go to.
struct Kept {
    file: Option<RowFile>,
    rows: Vec<Row>,
}

/// Flies those of these flights that have no row.
fn fly_missing(
    args: &CampaignArgs,
    campaign: &Campaign,
    signals: &Signals,
    all: &[(Cell, u64)],
    kept: Kept,
) -> Result<Kept, CampaignError> {
    let places = (kept.rows.iter()).map(|row| campaign.place(&row.cell, row.seed));
    let places: HashSet<Option<(usize, u64)>> = places.collect();
    let missing = |(cell, seed): &(Cell, u64)| !places.contains(&campaign.place(cell, *seed));
    let jobs: Vec<(Cell, u64)> = all.iter().filter(|job| missing(job)).cloned().collect();
    if args.until_width.is_none() && !kept.rows.is_empty() {
        talk(format_args!(
            "{} of {} flights are there",
            all.len() - jobs.len(),
            all.len()
        ));
    }
    args.loudness.tell(|| {
        let cells = campaign.cells().len();
        format!(
            "{cells} cells, {} flights to fly, {} threads (0: all cores)",
            jobs.len(),
            args.threads
        )
    });
    let progress = progress_bar(jobs.len() as u64, "flights");
    let extras = Extras {
        hashed: args.out.is_some(),
        judged: args.out.is_some() || args.taxonomy || args.json,
        timed: args.timing,
    };
    let sink = Mutex::new(kept);
    let flown = fly_all(campaign, &jobs, args.threads, extras, |row| {
        progress.inc(1);
        let kept = &mut *sink.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(file) = &mut kept.file {
            file.push(&row)?;
        }
        kept.rows.push(row);
        match signals.raised() {
            Some(_) => Err(CampaignError::Interrupted(
                args.out.as_ref().map(|path| path.display().to_string()),
            )),
            None => Ok(()),
        }
    });
    progress.finish_and_clear();
    flown?;
    Ok(sink.into_inner().unwrap_or_else(PoisonError::into_inner))
}
