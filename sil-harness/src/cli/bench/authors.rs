//! The authors' own planning cycles, timed beside ours.

use super::super::answer::Failure;
use mpp_analysis::bench::CycleReport;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;
use std::process::Command;

/// The script that times them, from the root of the repository.
const SCRIPT: &str = "bench/authors/cycle.py";

/// Times of cycles, as the script prints them.
#[derive(Debug, Deserialize, Serialize)]
struct Timed {
    /// Number of cycles.
    cycles: usize,
    /// Median \[us\].
    median_us: f64,
    /// 99th percentile \[us\].
    p99_us: f64,
}

/// Our cycles beside the authors'.
#[derive(Debug, Serialize)]
pub(super) struct Comparison {
    #[serde(flatten)]
    ours: CycleReport,
    /// Their code as published.
    authors: Timed,
    /// Their code with its direction search compiled.
    authors_compiled: Timed,
    /// Their median as published, as a multiple of ours of preset `flight` [-].
    authors_by_flight: f64,
}

/// Times the authors' cycles with as many paths, past as many obstacles.
pub(super) fn compare(python: &Path, ours: CycleReport) -> Result<Comparison, Failure> {
    let authors = timed(python, &ours, &["--as-published"])?;
    let authors_compiled = timed(python, &ours, &[])?;
    let flight = ours
        .presets
        .last()
        .map_or(f64::NAN, |flight| flight.cycle.median_us);
    Ok(Comparison {
        authors_by_flight: authors.median_us / flight,
        authors,
        authors_compiled,
        ours,
    })
}

fn timed(python: &Path, ours: &CycleReport, options: &[&str]) -> Result<Timed, Failure> {
    let output = Command::new(python)
        .arg(SCRIPT)
        .args(["--paths", &ours.paths.to_string()])
        .args(["--obstacles", &ours.obstacles.to_string()])
        .args(["--seed", &ours.seed.to_string()])
        .args(options)
        .output()
        .map_err(|error| {
            let why = format!(
                "--authors {}: {error}: bench/authors/README.md sets it up",
                python.display()
            );
            Failure::usage(why)
        })?;
    if !output.status.success() {
        let why = String::from_utf8_lossy(&output.stderr);
        let last = why.trim_end().lines().last().unwrap_or_default();
        return Err(Failure::failed(format!("{SCRIPT}: {last}")));
    }
    serde_json::from_slice(&output.stdout)
        .map_err(|error| Failure::failed(format!("{SCRIPT}: {error}")))
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.ours)?;
        let rows = [
            ("as published", &self.authors),
            ("search compiled", &self.authors_compiled),
        ];
        for (name, times) in rows {
            writeln!(
                f,
                "the authors' code, {name}: {} cycles, median {:.0} us, 99th percentile {:.0} us",
                times.cycles, times.median_us, times.p99_us
            )?;
        }
        write!(
            f,
            "a cycle of flight is {:.0} times faster than the authors' as published",
            self.authors_by_flight
        )
    }
}
