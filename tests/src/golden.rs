//! Golden flights: a small table of whole flights that shows at once whether a change moved a
//! flight.
//!
//! `golden/flights.toml` holds the parameters of the flights, and `golden/table.txt` holds their
//! results. The test `golden` compares; `cargo xtask golden --save` rewrites the table.

use mpp_sim::flight::fly;
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Scenario, ScenarioFile};
use mpp_sim::space::{SpaceFile, fly_space};
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

/// One golden flight in space.
pub struct GoldenInSpace {
    /// Its name in the table.
    pub name: String,
    /// Its keys.
    pub file: SpaceFile,
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

/// Reads the keys of the golden flights in space.
///
/// # Errors
/// As [`flights`].
pub fn flights_in_space() -> Result<Vec<GoldenInSpace>, Failure> {
    let mut file: toml::Table = std::fs::read_to_string(folder().join("flights.toml"))?.parse()?;
    let Some(toml::Value::Array(entries)) = file.remove("space") else {
        return Err("flights.toml has no [[space]]".into());
    };
    let golden = |entry| {
        let (name, keys) = named(entry)?;
        let file = keys.try_into()?;
        Ok(GoldenInSpace { name, file })
    };
    entries.into_iter().map(golden).collect()
}

/// The name of an entry, and its other keys.
fn named(entry: toml::Value) -> Result<(String, toml::Table), Failure> {
    let toml::Value::Table(mut keys) = entry else {
        return Err("a flight is a table of keys".into());
    };
    let Some(toml::Value::String(name)) = keys.remove("name") else {
        return Err("a flight has no name".into());
    };
    Ok((name, keys))
}

fn golden(entry: toml::Value) -> Result<Golden, Failure> {
    let (name, mut keys) = named(entry)?;
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
    for GoldenInSpace { name, file } in flights_in_space()? {
        let log =
            in_space(move || -> Result<FlightLog, Failure> { Ok(fly_space(&file.build(None)?)?) })?;
        writeln!(table, "{name:<22} {}", line(&log)?)?;
    }
    Ok(table)
}

/// Does something on a stack on which the core in space can be built.
///
/// # Errors
/// That of `work`, and an error when there is no such thread.
pub fn in_space<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
) -> Result<T, Failure> {
    let thread = std::thread::Builder::new().stack_size(mpp_sim::space::STACK);
    let done = thread.spawn(work)?.join();
    done.map_err(|_| "the flight in space broke")?
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
