//! `campaign --faults`: pairs of flights without and with named faults.

use super::answer::{Failure, print};
use super::campaign::{CampaignArgs, failure, lists, scenario};
use super::loudness::progress_bar;
use super::signals::Signals;
use crate::campaign::{CampaignError, run_faults};
use mpp_analysis::campaign::{FaultCampaign, FaultReport, NamedFault};

pub(super) fn run(args: &CampaignArgs) -> Result<u8, Failure> {
    args.loudness.set();
    if args.preset.len() > 1 || args.paths.len() > 1 {
        return Err(Failure::usage(
            "--faults: give at most one --preset and one --paths",
        ));
    }
    let faults = NamedFault::of(&args.faults).map_err(Failure::usage)?;
    let scenario = scenario(args)?;
    let campaign = FaultCampaign::new(&scenario, &lists(args)?, args.trials, args.seed, &faults)
        .map_err(Failure::usage)?;
    let signals = Signals::heed()?;
    let progress = progress_bar(campaign.jobs().len() as u64, "pairs");
    let flown = run_faults(&campaign, args.threads, || {
        progress.inc(1);
        signals
            .raised()
            .map_or(Ok(()), |_| Err(CampaignError::Stopped))
    });
    progress.finish_and_clear();
    let flown = flown.map_err(|error| match signals.raised() {
        Some(code) if matches!(error, CampaignError::Stopped) => Failure::new(code, error),
        _ => failure(&error),
    })?;
    let report = FaultReport::new(&campaign, &flown);
    print(&report, args.json)?;
    Ok(0)
}
