//! `replay`: makes a page from a recorded flight.

use super::answer::{Failure, talk};
use crate::files::{read_log, write_whole};
use mpp_analysis::picture::replay::replay;
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
    let read = |path: &PathBuf| {
        let log = read_log(path)?;
        if log.header.space.is_some() {
            let why = "a page shows flights in the vertical plane: export this flight in space";
            return Err(Failure::usage(format!("{}: {why}", path.display())));
        }
        Ok(log)
    };
    let log = read(&args.log)?;
    let against = args.against.as_ref().map(read).transpose()?;
    let (page, whole) = replay(&log, against.as_ref())
        .map_err(|error| Failure::usage(format!("{}: {error}", args.log.display())))?;
    if !whole {
        talk(
            "the page has no scans and candidates of a flight: flown again, it does not come out the \
             same (another version, or settings that its log does not hold)",
        );
    }
    write_whole(&args.out, page.as_bytes())?;
    talk(format_args!("page {}", args.out.display()));
    Ok(0)
}
