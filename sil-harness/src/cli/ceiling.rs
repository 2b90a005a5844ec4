//! `ceiling`: which fields can be passed at all, proven either way.

use super::answer::{Failure, print};
use super::campaign::failure;
use super::help::{OUTPUT, RUN, WORLD};
use super::loudness::progress_bar;
use super::scenario::{FieldArgs, ScenarioArgs};
use super::signals::Signals;
use super::values::{Item, number, seed, threads, within};
use crate::campaign::{CampaignError, decide_all};
use mpp_analysis::campaign::Campaign;
use mpp_analysis::ceiling::{CeilingCell, CeilingReport};

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::CEILING)]
pub(super) struct CeilingArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    #[command(flatten)]
    field: FieldArgs,
    /// Margins that a flight keeps beside the body's radius [m], a list
    #[arg(long, help_heading = WORLD, value_delimiter = ',', default_values_t = [0.0], value_parser = Item(number))]
    margin: Vec<f64>,
    /// Number of fields in each cell
    #[arg(long, help_heading = RUN, default_value_t = 100, value_parser = within(1, u32::MAX))]
    fields: u32,
    /// Seed of the first field; the next fields take the next seeds [default: the scenario's]
    #[arg(long, help_heading = RUN, value_parser = seed)]
    seed: Option<u64>,
    /// Number of threads, at most 1024 and no more than there is work for; 0 takes every core
    #[arg(long, help_heading = RUN, default_value_t = 0, value_parser = threads())]
    threads: usize,
    /// Print the report as one JSON object
    #[arg(long, help_heading = OUTPUT)]
    json: bool,
}

pub(super) fn run(args: &CeilingArgs) -> Result<u8, Failure> {
    let campaign = Campaign::new(
        args.scenario.file()?,
        args.field.lists()?,
        args.fields,
        args.seed,
    );
    let campaign = campaign.map_err(Failure::usage)?;
    let signals = Signals::heed()?;
    let cells = campaign.cells();
    let all = cells.len() * args.margin.len();
    let progress = progress_bar(all as u64 * u64::from(args.fields), "fields");
    let done = || {
        progress.inc(1);
        signals
            .raised()
            .map_or(Ok(()), |_| Err(CampaignError::Stopped))
    };
    let mut report = CeilingReport::default();
    for cell in &cells {
        for &margin in &args.margin {
            let verdicts = decide_all(&campaign, cell, margin, args.threads, done);
            let verdicts = verdicts.map_err(|error| match signals.raised() {
                Some(code) => Failure::new(code, error),
                None => failure(&error),
            })?;
            let of_cell: Vec<_> = verdicts.into_iter().map(|(_, verdict)| verdict).collect();
            report
                .cells
                .push(CeilingCell::new(&campaign, cell, margin, &of_cell));
        }
    }
    progress.finish_and_clear();
    print(&report, args.json)?;
    Ok(0)
}
