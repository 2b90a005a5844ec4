//! Golden flights: a small table of whole flights that shows at once whether a change moved a
//! flight.
//!
//! `golden/flights.toml` holds the parameters of the flights, and `golden/table.txt` holds their
//! results. The test `golden` compares; `cargo xtask golden --save` rewrites the table.

use mpp_sim::flight::fly;
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Scenario, ScenarioFile};
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The error of the functions here. Its message tells what to do.
pub type Failure = Box<dyn Error + Send + Sync>;

/// One golden flight.
pub struct Golden {
    /// Its name in the table.
    pub name: String,
    /// Parameters of the flight.
    pub scenario: Scenario,
}

/// The file that holds the expected table.
#[must_use]
pub fn table_path() -> PathBuf {
    folder().join("table.txt")
}

/// Reads the parameters of the golden flights.
///
/// # Errors
/// An error when a file cannot be read, or when a key is invalid.
pub fn flights() -> Result<Vec<Golden>, Failure> {
    let path = folder().join("flights.toml");
    let mut file: toml::Table = std::fs::read_to_string(&path)?.parse()?;
    let Some(toml::Value::Array(entries)) = file.remove("flight") else {
        return Err(format!("{} has no [[flight]]", path.display()).into());
    };
    entries.into_iter().map(golden).collect()
}

fn golden(entry: toml::Value) -> Result<Golden, Failure> {
    let toml::Value::Table(mut keys) = entry else {
        return Err("a flight is a table of keys".into());
    };
    let Some(toml::Value::String(name)) = keys.remove("name") else {
        return Err("a flight has no name".into());
    };
    let mut scenario = match keys.remove("base") {
        Some(toml::Value::String(base)) => {
            let path = folder().join("../../docs/scenarios").join(base);
            std::fs::read_to_string(path)?.parse()?
        }
        _ => toml::Table::new(),
    };
    scenario.extend(keys);
    let file: ScenarioFile = scenario.try_into()?;
    let scenario = file.build()?;
    Ok(Golden { name, scenario })
}

/// Flies all golden flights. Returns a line for each.
///
/// # Errors
/// The errors of [`flights`], and an error when a flight has no outcome.
pub fn table() -> Result<String, Failure> {
    let mut table = format!(
        "{:<22} {:<17} {:<17} {:>9} {:>7} {:>6} {:>8} {:>7}\n",
        "flight", "log", "outcome", "clearance", "t_end", "plans", "feasible", "slices"
    );
    for Golden { name, scenario } in flights()? {
        let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {})?;
        writeln!(table, "{name:<22} {}", line(&log)?)?;
    }
    Ok(table)
}

fn line(log: &FlightLog) -> Result<String, Failure> {
    if log.health.contains_key("planner_inconsistent") {
        return Err(
            "the planner ended a cycle early: its phase and its workspace did not belong together"
                .into(),
        );
    }
    let flown = &log.summary;
    let clearance = flown
        .min_clearance
        .map(|clearance| format!("{clearance:.4}"));
    Ok(format!(
        "{:<17} {:<17} {:>9} {:>7.2} {:>6} {:>8} {:>7}",
        log.hash()?,
        flown.class.name(),
        clearance.unwrap_or_else(|| "-".to_owned()),
        flown.t_end,
        flown.replans,
        flown.feasible,
        flown.slices,
    ))
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden")
}
