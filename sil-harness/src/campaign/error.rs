//! The errors that stop a campaign.

use mpp_analysis::campaign::{Cell, Disagreement};
use mpp_analysis::ceiling::CeilingError;
use mpp_sim::flight::FlyError;
use mpp_sim::log::LogError;
use mpp_sim::scenario::ScenarioError;

/// The reason why a campaign did not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// The scenario is invalid.
    #[error("{0}")]
    Scenario(#[source] ScenarioError),
    /// A field cannot be judged.
    #[error("{0}")]
    Ceiling(#[source] CeilingError),
    /// A flight has no outcome. Holds its cell, its seed and the reason.
    #[error("{2}; fly it again with: fly --seed {1} {0}")]
    Flight(Box<Cell>, u64, #[source] FlyError),
    /// A flight of a campaign of faults has no outcome. Holds its fault, its cell, its seed and the reason.
    #[error("{3}; this flight failed: {0}, --seed {2} {1}")]
    Faulty(&'static str, Box<Cell>, u64, #[source] FlyError),
    /// A flight with two faults has no outcome. Holds its faults, its seed and the reason.
    #[error("{2}; this flight failed: {0}, --seed {1}")]
    Pair(String, u64, #[source] FlyError),
    /// Whoever started a command that keeps nothing ended it.
    #[error("interrupted: this command keeps nothing of a part")]
    Stopped,
    /// A flight's log cannot be written. Holds its cell, its seed and the reason.
    #[error("{2}; fly it again with: fly --seed {1} {0}")]
    Log(Box<Cell>, u64, #[source] LogError),
    /// A row file cannot be opened to go on with it.
    #[error("cannot open {0}: {1}; give a path that can be read and written")]
    Open(String, #[source] std::io::Error),
    /// A row file cannot be read.
    #[error("cannot read {0}: {1}; give a row file that can be read")]
    Read(String, #[source] std::io::Error),
    /// A row cannot be written: file, rows that it holds, why.
    #[error(
        "cannot write to {0}: {2}; it holds {1} whole rows: make room, and give the same command again to go on"
    )]
    Full(String, usize, #[source] std::io::Error),
    /// Whoever started it ended it; its row file, if there is one.
    #[error("interrupted: {}", kept(.0))]
    Interrupted(Option<String>),
    /// What rows should go to is no file but a directory, a device or a pipe.
    #[error("{0} is no regular file: give another path")]
    NoFile(String),
    /// The file holds something else than a campaign's rows.
    #[error("{0} is no row file of this campaign and is left as it was: give another path")]
    NoRowFile(String),
    /// A line of a row file is not valid for its campaign. Holds the file, the line and the reason.
    #[error("{0}, line {1}: {2}")]
    Line(String, usize, String),
    /// A row file holds another campaign's rows. Holds the file and the difference.
    #[error("{0} holds another campaign: {1}; give another file, or the same flags")]
    Differs(String, String),
    /// Another process writes this row file.
    #[error("{0} is being written by another process: wait for it, or give another file")]
    Busy(String),
    /// Two row files disagree about a flight.
    #[error("{0}")]
    Disagree(#[source] Disagreement),
    /// No row file was given.
    #[error("--report: give at least one row file")]
    NoRows,
    /// The threads cannot be started.
    #[error("--threads: {0}")]
    Threads(#[source] rayon::ThreadPoolBuildError),
}

fn kept(rows: &Option<String>) -> String {
    match rows {
        Some(path) => {
            format!("{path} holds what was flown; give the same command again to go on")
        }
        None => "nothing is kept; give --out FILE to keep rows and to go on with them".to_owned(),
    }
}
