//! `replay`: makes a page from a recorded flight.

use super::answer::{Failure, talk};
use crate::files::{read_log, write_whole};
use mpp_analysis::picture::replay::{replay, replay_space};
use mpp_sim::log::FlightLog;
use std::path::PathBuf;

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::REPLAY)]
pub(super) struct ReplayArgs {
    /// Log of the flight
    log: PathBuf,
    /// Log of another flight, which stands beside it on the same page
    #[arg(long, value_name = "LOG")]
    against: Option<PathBuf>,
    /// Page to write
    #[arg(long, default_value = "out/replay.html")]
    out: PathBuf,
}

pub(super) fn run(args: &ReplayArgs) -> Result<u8, Failure> {
    let log = read_log(&args.log)?;
    let against = args.against.as_deref().map(read_log).transpose()?;
    let page = if log.header.space.is_some() {
        in_space(args, &log)?
    } else {
        in_plane(args, &log, against.as_ref())?
    };
    write_whole(&args.out, page.as_bytes())?;
    talk(format_args!("page {}", args.out.display()));
    Ok(0)
}

fn in_plane(
    args: &ReplayArgs,
    log: &FlightLog,
    against: Option<&FlightLog>,
) -> Result<String, Failure> {
    if against.is_some_and(|it| it.header.space.is_some()) {
        return Err(alone());
    }
    let (page, whole) = replay(log, against).map_err(|error| refused(args, &error.to_string()))?;
    if !whole {
        talk(
            "the page has no scans and candidates of a flight: flown again, it does not come out the \
             same (another version, or settings that its log does not hold)",
        );
    }
    Ok(page)
}

fn in_space(args: &ReplayArgs, log: &FlightLog) -> Result<String, Failure> {
    if args.against.is_some() {
        return Err(alone());
    }
    let page = replay_space(log).map_err(|error| refused(args, &error.to_string()))?;
    page.ok_or_else(|| {
        refused(args, "flown again, it does not come out the same (another version, or another core): fly it again, or export it")
    })
}

fn refused(args: &ReplayArgs, why: &str) -> Failure {
    Failure::usage(format!("{}: {why}", args.log.display()))
}

fn alone() -> Failure {
    Failure::usage(
        "--against: give flights in the vertical plane: one in space stands alone on its page",
    )
}
