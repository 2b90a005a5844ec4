//! Checks the core and the plant against data recorded from the authors' code.
//!
//! The data are JSON texts. The beginning of a text's name is its kind: `plant_open_loop`,
//! `linearization`, `lqr`, `coherent_command`, `ekf`, `lidar_*`, `ray_*`, `rrt_*`, `case_*`. Each
//! text gives one or more comparisons; a comparison has an error and a tolerance.

mod perception;
mod program;
mod report;
mod search;
mod vehicle;

pub use program::recorded_instances;
use report::Comparison;
pub use report::{KindReport, Report};

/// Checks recorded texts, given as pairs of a name and the text. A text of a known kind that does
/// not parse is a failure in the report.
#[must_use]
pub fn check(mut texts: Vec<(String, String)>) -> Report {
    texts.sort_by_key(|(name, _)| (order(name), name.clone()));
    let mut report = Report::default();
    for (name, text) in texts {
        match check_text(&name, &text) {
            Some(comparisons) => report.add(&name, comparisons),
            None => report.unknown_files.push(name),
        }
    }
    report
}

type Checker = fn(&str) -> Result<Vec<Comparison>, serde_json::Error>;

/// Beginnings of names with their checks, in the order of the data flow.
const KINDS: [(&str, Checker); 9] = [
    ("plant_open_loop", vehicle::check_plant),
    ("linearization", vehicle::check_linearization),
    ("lqr", vehicle::check_regulator),
    ("coherent_command", vehicle::check_steady_flight),
    ("ekf", vehicle::check_estimator),
    ("lidar", perception::check_lidar),
    ("ray", perception::check_rays),
    ("rrt", search::check_tree),
    ("case", program::check_case),
];

fn order(name: &str) -> usize {
    KINDS
        .iter()
        .position(|(stem, _)| name.starts_with(stem))
        .unwrap_or(KINDS.len())
}

fn check_text(name: &str, text: &str) -> Option<Vec<Comparison>> {
    let (kind, check) = KINDS.get(order(name))?;
    Some(
        check(text).unwrap_or_else(|error| {
            vec![Comparison::failed(kind, format!("does not parse: {error}"))]
        }),
    )
}
