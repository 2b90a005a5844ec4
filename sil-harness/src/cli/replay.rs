//! `replay`: a recorded flight as a page.

use super::{FAILURE, Failure, USAGE, talk};
use crate::log::FlightLog;
use crate::picture::replay::replay;
use std::path::PathBuf;

#[derive(Clone, Debug, clap::Args)]
pub(super) struct ReplayArgs {
    /// A flight's log
    log: PathBuf,
    /// The page
    #[arg(long, default_value = "out/replay.html")]
    out: PathBuf,
}

pub(super) fn run(args: &ReplayArgs) -> Result<u8, Failure> {
    let unreadable = |why: String| Failure::new(USAGE, format!("{}: {why}", args.log.display()));
    let bytes = std::fs::read(&args.log).map_err(|error| unreadable(error.to_string()))?;
    let log = FlightLog::from_json(&bytes).map_err(|error| unreadable(error.to_string()))?;
    let (page, whole) = replay(&log).map_err(|error| unreadable(error.to_string()))?;
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
    std::fs::write(&args.out, page).map_err(failed)?;
    talk(format_args!("page {}", args.out.display()));
    Ok(0)
}
