//! `replay`: makes a page from a recorded flight.

use super::answer::{FAILURE, Failure, USAGE, talk};
use crate::files::{read_log, write_whole};
use mpp_analysis::picture::replay::replay;
use std::path::PathBuf;

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::REPLAY)]
pub(super) struct ReplayArgs {
    /// Log of the flight
    log: PathBuf,
    /// Page to write
    #[arg(long, default_value = "out/replay.html")]
    out: PathBuf,
}

pub(super) fn run(args: &ReplayArgs) -> Result<u8, Failure> {
    let log = read_log(&args.log).map_err(|error| Failure::new(USAGE, error))?;
    let (page, whole) = replay(&log)
        .map_err(|error| Failure::new(USAGE, format!("{}: {error}", args.log.display())))?;
    if !whole {
        talk(
            "the page has no scans and candidates: flown again, this flight does not come out the \
             same (another version, or settings that its log does not hold)",
        );
    }
    let failed = |error| {
        Failure::new(
            FAILURE,
            format!("cannot write {}: {error}", args.out.display()),
        )
    };
    if let Some(directory) = args.out.parent() {
        std::fs::create_dir_all(directory).map_err(failed)?;
    }
    write_whole(&args.out, page.as_bytes()).map_err(|error| Failure::new(FAILURE, error))?;
    talk(format_args!("page {}", args.out.display()));
    Ok(0)
}
