//! Numbers of instructions in each region, from the counting plugin.

use crate::folders::{root, work};
use crate::toolchain::succeed;
use anyhow::{Context, Result, ensure};
use std::path::{Path, PathBuf};
use std::process::Command;

// These are the kinds of firmware/src/mark.rs.
const STEP: u64 = 2;
const ORDER: u64 = 3;
const MAP: u64 = 4;
const TREE: u64 = 5;
const CORRIDOR: u64 = 6;
const PROGRAM: u64 = 7;
const ANSWER: u64 = 8;
const REMEMBER: u64 = 12;
const LATTICE: u64 = 13;
const LINEARISE: u64 = 14;
const IMPROVE: u64 = 15;

/// The planner's stages, as docs/budgets.toml names them.
const STAGES: [(&str, u64); 8] = [
    ("map", MAP),
    ("tree", TREE),
    ("corridor", CORRIDOR),
    ("program", PROGRAM),
    ("remember", REMEMBER),
    ("lattice", LATTICE),
    ("linearise", LINEARISE),
    ("improve", IMPROVE),
];

/// Builds the plugin.
pub(crate) fn plugin() -> Result<PathBuf> {
    let library = work("counter")?.join("libcounter.so");
    succeed(
        Command::new("rustc")
            .args(["--edition", "2024", "-O", "--crate-type", "cdylib", "-o"])
            .arg(&library)
            .arg(root().join("xtask/counter/counter.rs")),
    )?;
    Ok(library)
}

/// The regions of a flight.
#[derive(Debug)]
pub(crate) struct Counts {
    regions: Vec<(u64, u64)>,
    /// Number of marks without their other mark.
    unpaired: u64,
    /// All instructions of the run.
    pub(crate) total: u64,
}

impl Counts {
    /// Reads the file that the plugin wrote to a folder.
    pub(crate) fn read(folder: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(folder.join("counts"))?;
        let (mut regions, mut unpaired, mut total) = (Vec::new(), None, None);
        for line in text.lines() {
            let (kind, count) = line.split_once(' ').context("a line of counts")?;
            let count = count.parse()?;
            match kind {
                "unpaired" => unpaired = Some(count),
                "total" => total = Some(count),
                kind => regions.push((kind.parse()?, count)),
            }
        }
        Ok(Self {
            regions,
            unpaired: unpaired.context("the emulator counted no unpaired marks")?,
            total: total.context("the emulator wrote no total")?,
        })
    }

    /// Checks that no mark was lost, and that there are steps and cycles to measure. A lost mark would make
    /// figures too small, which a budget cannot notice.
    pub(crate) fn check(&self) -> Result<()> {
        ensure!(
            self.unpaired == 0,
            "{} marks of firmware/src/mark.rs have no other mark: the counting plugin loses marks",
            self.unpaired
        );
        ensure!(self.of(STEP).count() > 0, "no step was counted");
        ensure!(!self.cycles().is_empty(), "no planning cycle was counted");
        Ok(())
    }

    fn of(&self, wanted: u64) -> impl Iterator<Item = u64> {
        self.regions
            .iter()
            .filter(move |(kind, _)| *kind == wanted)
            .map(|(_, count)| *count)
    }

    fn worst(&self, kind: u64) -> u64 {
        self.of(kind).max().unwrap_or_default()
    }

    /// Mean count of the 100 Hz step.
    pub(crate) fn step_mean(&self) -> u64 {
        let steps = self.of(STEP).count().max(1) as u64;
        self.of(STEP).sum::<u64>() / steps
    }

    /// Count of the worst 100 Hz step.
    pub(crate) fn step_worst(&self) -> u64 {
        self.worst(STEP)
    }

    /// The count of the worst slice of each stage that ran, with the stage's name.
    pub(crate) fn slices_worst(&self) -> impl Iterator<Item = (&'static str, u64)> {
        STAGES
            .iter()
            .map(|(name, kind)| (*name, self.worst(*kind)))
            .filter(|(_, count)| *count > 0)
    }

    /// The mean count of each stage that ran, per cycle, with the stage's name.
    pub(crate) fn stages_mean(&self) -> impl Iterator<Item = (&'static str, u64)> {
        let cycles = self.cycles().len().max(1) as u64;
        STAGES
            .iter()
            .map(move |(name, kind)| (*name, self.of(*kind).sum::<u64>() / cycles))
            .filter(|(_, count)| *count > 0)
    }

    /// Counts of whole cycles, from order to answer, sorted.
    pub(crate) fn cycles(&self) -> Vec<u64> {
        let mut cycles = Vec::new();
        let mut open = None;
        let mut planned = false;
        for (kind, count) in &self.regions {
            match *kind {
                ORDER => (open, planned) = (Some(*count), false),
                kind if STAGES.iter().any(|(_, stage)| *stage == kind) => {
                    planned = true;
                    open = open.map(|sum| sum + count);
                }
                // An order without slices is a set-up.
                ANSWER if planned => cycles.extend(open.take().map(|sum| sum + count)),
                _ => {}
            }
        }
        cycles.sort_unstable();
        cycles
    }
}

/// The median of sorted values.
pub(crate) fn median(sorted: &[u64]) -> u64 {
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::{ANSWER, Counts, MAP, ORDER, PROGRAM, STEP, TREE, median};

    #[test]
    fn cycles_go_from_order_to_answer_and_steps_between_do_not_count() {
        let set_up = [(ORDER, 1000), (ANSWER, 10)];
        let first = [(ORDER, 1), (MAP, 2), (STEP, 500), (TREE, 3), (ANSWER, 4)];
        let second = [(ORDER, 1), (PROGRAM, 8), (ANSWER, 1)];
        let counts = Counts {
            regions: [&set_up[..], &first, &second].concat(),
            unpaired: 0,
            total: 0,
        };
        assert!(counts.check().is_ok());
        assert_eq!(counts.cycles(), [10, 10]);
        assert_eq!((counts.step_mean(), counts.step_worst()), (500, 500));
        assert_eq!(median(&[1, 2, 9]), 2);
    }
    #[test]
    fn lost_marks_are_noticed() {
        let whole = [(ORDER, 1), (MAP, 2), (STEP, 500), (ANSWER, 4)];
        for lost in [ORDER, ANSWER, STEP, MAP] {
            let regions = whole.into_iter().filter(|(kind, _)| *kind != lost);
            let counts = Counts {
                regions: regions.collect(),
                unpaired: 0,
                total: 0,
            };
            assert!(counts.check().is_err(), "{lost}");
        }
        let counts = Counts {
            regions: whole.to_vec(),
            unpaired: 1,
            total: 0,
        };
        assert!(counts.check().is_err());
    }
}
