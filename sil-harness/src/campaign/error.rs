//! The errors that stop a campaign.

use mpp_analysis::campaign::{Cell, Disagreement};
use mpp_analysis::ceiling::CeilingError;
use mpp_sim::flight::FlyError;
use mpp_sim::log::LogError;
use mpp_sim::scenario::ScenarioError;
use std::fmt;

/// The reason why a campaign did not come to its end.
#[derive(Debug)]
pub enum CampaignError {
    /// The scenario is invalid.
    Scenario(ScenarioError),
    /// A field cannot be judged.
    Ceiling(CeilingError),
    /// A flight has no outcome. Holds its cell, its seed and the reason.
    Flight(Box<Cell>, u64, FlyError),
    /// A flight of a campaign of faults has no outcome. Holds its fault, its cell, its seed and the reason.
    Faulty(&'static str, Box<Cell>, u64, FlyError),
    /// Whoever started a command that keeps nothing ended it.
    Stopped,
    /// A flight's log cannot be written. Holds its cell, its seed and the reason.
    Log(Box<Cell>, u64, LogError),
    /// A row file cannot be opened or read.
    File(String, std::io::Error),
    /// A row cannot be written: file, rows that it holds, why.
    Full(String, usize, std::io::Error),
    /// Whoever started it ended it; its row file, if there is one.
    Interrupted(Option<String>),
    /// What rows should go to is no file but a directory, a device or a pipe.
    NoFile(String),
    /// The file holds something else than a campaign's rows.
    NoRowFile(String),
    /// A line of a row file is not valid for its campaign. Holds the file, the line and the reason.
    Line(String, usize, String),
    /// A row file holds another campaign's rows. Holds the file and the difference.
    Differs(String, String),
    /// Another process writes this row file.
    Busy(String),
    /// Two row files disagree about a flight.
    Disagree(Disagreement),
    /// No row file was given.
    NoRows,
    /// The threads cannot be started.
    Threads(rayon::ThreadPoolBuildError),
}

impl fmt::Display for CampaignError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scenario(error) => write!(f, "{error}"),
            Self::Ceiling(error) => write!(f, "{error}"),
            Self::Flight(cell, seed, why) => {
                write!(f, "{why}; fly it again with: fly --seed {seed} {cell}")
            }
            Self::Faulty(fault, cell, seed, why) => {
                write!(
                    f,
                    "{why}; this flight failed: {fault}, --seed {seed} {cell}"
                )
            }
            Self::Stopped => f.write_str("interrupted: this command keeps nothing of a part"),
            Self::Log(cell, seed, why) => {
                write!(f, "{why}; fly it again with: fly --seed {seed} {cell}")
            }
            Self::File(path, error) => write!(
                f,
                "cannot open {path}: {error}; give a path that can be read and written"
            ),
            Self::Full(path, rows, error) => write!(
                f,
                "cannot write to {path}: {error}; it holds {rows} whole rows: make room, and give the \
                 same command again to go on"
            ),
            Self::Interrupted(Some(path)) => write!(
                f,
                "interrupted: {path} holds what was flown; give the same command again to go on"
            ),
            Self::Interrupted(None) => f.write_str(
                "interrupted: nothing is kept; give --out FILE to keep rows and to go on with them",
            ),
            Self::NoFile(path) => write!(f, "{path} is no regular file: give another path"),
            Self::NoRowFile(path) => write!(
                f,
                "{path} is no row file of this campaign and is left as it was: give another path"
            ),
            Self::Line(path, line, why) => write!(f, "{path}, line {line}: {why}"),
            Self::Differs(path, what) => write!(
                f,
                "{path} holds another campaign: {what}; give another file, or the same flags"
            ),
            Self::Busy(path) => write!(
                f,
                "{path} is being written by another process: wait for it, or give another file"
            ),
            Self::Disagree(error) => write!(f, "{error}"),
            Self::NoRows => f.write_str("--report: give at least one row file"),
            Self::Threads(error) => write!(f, "--threads: {error}"),
        }
    }
}

impl std::error::Error for CampaignError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Scenario(error) => Some(error),
            Self::Ceiling(error) => Some(error),
            Self::Flight(_, _, error) | Self::Faulty(_, _, _, error) => Some(error),
            Self::Log(_, _, error) => Some(error),
            Self::File(_, error) | Self::Full(_, _, error) => Some(error),
            Self::Disagree(error) => Some(error),
            Self::Threads(error) => Some(error),
            Self::Interrupted(_)
            | Self::Stopped
            | Self::NoFile(_)
            | Self::NoRowFile(_)
            | Self::Line(..)
            | Self::Differs(..)
            | Self::Busy(_)
            | Self::NoRows => None,
        }
    }
}
