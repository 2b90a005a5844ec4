//! `campaign --faults`: pairs of flights without and with named faults.

use super::answer::{Failure, print};
use super::campaign::{CampaignArgs, failure, lists, scenario};
use super::loudness::progress_bar;
use super::signals::Signals;
use crate::campaign::{CampaignError, run_faults, run_pairs};
use mpp_analysis::campaign::{FaultCampaign, FaultPairs, FaultReport, NamedFault, PairReport};
use mpp_sim::scenario::ScenarioFile;

pub(super) fn run(args: &CampaignArgs) -> Result<u8, Failure> {
    args.loudness.set();
    if args.preset.len() > 1 || args.paths.len() > 1 {
        return Err(Failure::usage(
            "--faults: give at most one --preset and one --paths",
        ));
    }
    let faults = NamedFault::of(&args.faults).map_err(Failure::usage)?;
    let scenario = scenario(args)?;
    if args.pairs {
        return pairs(args, &scenario, &faults);
    }
    let campaign = FaultCampaign::new(&scenario, &lists(args)?, args.trials, args.seed, &faults)
        .map_err(Failure::usage)?;
    let flown = heeded(campaign.jobs().len(), "pairs", |done| {
        run_faults(&campaign, args.threads, done)
    })?;
    print(&FaultReport::new(&campaign, &flown), args.json)?;
    Ok(0)
}

/// Flies pairs of faults.
fn pairs(
    args: &CampaignArgs,
    scenario: &ScenarioFile,
    faults: &[NamedFault],
) -> Result<u8, Failure> {
    let campaign = FaultPairs::new(scenario, &lists(args)?, args.trials, args.seed, faults)
        .map_err(Failure::usage)?;
    let count = campaign.pairs().len();
    if count == 0 {
        let why = "--pairs: no two of these faults make a pair: name faults of two tables, or all";
        return Err(Failure::usage(why));
    }
    let flown = heeded(count, "flights", |done| {
        run_pairs(&campaign, args.threads, done)
    })?;
    print(&PairReport::new(flown), args.json)?;
    Ok(0)
}

/// Runs a campaign that keeps nothing of a part, with a bar and with an ear for signals.
fn heeded<T>(
    count: usize,
    what: &'static str,
    fly: impl FnOnce(&(dyn Fn() -> Result<(), CampaignError> + Sync)) -> Result<T, CampaignError>,
) -> Result<T, Failure> {
    let signals = Signals::heed()?;
    let progress = progress_bar(count as u64, what);
    let flown = fly(&|| {
        progress.inc(1);
        signals
            .raised()
            .map_or(Ok(()), |_| Err(CampaignError::Stopped))
    });
    progress.finish_and_clear();
    flown.map_err(|error| match signals.raised() {
        Some(code) if matches!(error, CampaignError::Stopped) => Failure::new(code, error),
        _ => failure(&error),
    })
}
