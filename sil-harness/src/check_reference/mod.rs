//! Checks the core and the plant against data recorded from the authors' code.
//!
//! A directory holds JSON files, one kind a file-name stem: `plant_open_loop`, `linearization`,
//! `lqr`, `coherent_command`, `ekf`, `lidar_*`, `ray_*`, `rrt_*`, `case_*`. Each file gives one or
//! more comparisons; a comparison has an error and a tolerance.

mod perception;
mod program;
mod search;
mod vehicle;

pub(crate) use program::recorded_instances;
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf};

/// One comparison of ours with what was recorded.
#[derive(Clone, Debug)]
pub(crate) struct Comparison {
    kind: &'static str,
    result: Result<f64, String>,
    tolerance: f64,
}

impl Comparison {
    /// An error that must not exceed a tolerance.
    pub(crate) fn within(kind: &'static str, error: f64, tolerance: f64) -> Self {
        Self {
            kind,
            result: Ok(error),
            tolerance,
        }
    }

    /// A comparison that could not be made, or whose outcome is plainly wrong.
    pub(crate) fn failed(kind: &'static str, why: impl Into<String>) -> Self {
        Self {
            kind,
            result: Err(why.into()),
            tolerance: 0.0,
        }
    }

    /// A difference that is meant, with its reason.
    pub(crate) fn by_design(kind: &'static str, error: f64) -> Self {
        Self::within(kind, error, f64::INFINITY)
    }
}

/// Why our results differ from the recorded ones on purpose, by kind.
const BY_DESIGN: [(&str, &str); 1] = [(
    "steady flight, not steady",
    "the recorded point is not steady: off level the authors' force balance has the wrong sign of \
     m g sin(gamma), and below 4.40 N there is no level flight to find",
)];

/// The result for one kind.
#[derive(Clone, Debug, Serialize)]
pub struct KindReport {
    /// What was compared.
    pub kind: String,
    /// Files that hold such data.
    pub files: usize,
    /// Comparisons made.
    pub checks: usize,
    /// Those within tolerance.
    pub passed: usize,
    /// Those that differ by design, counted apart.
    pub differs_by_design: usize,
    /// Worst error of the comparisons that could be made.
    pub worst_error: f64,
    /// Largest error allowed.
    pub tolerance: f64,
    /// Why it differs by design, if it does.
    pub reason: Option<String>,
    /// What failed: file and reason.
    pub failures: Vec<String>,
}

/// Results for a directory.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// One entry a kind, in the order of the data flow.
    pub kinds: Vec<KindReport>,
    /// Files whose name names no known kind.
    pub unknown_files: Vec<String>,
}

impl Report {
    /// Whether every comparison that is not by design passed, and at least one was made.
    #[must_use]
    pub fn passed(&self) -> bool {
        !self.kinds.is_empty() && self.kinds.iter().all(|kind| kind.failures.is_empty())
    }

    fn add(&mut self, file: &str, comparisons: Vec<Comparison>) {
        let mut seen: Vec<&str> = Vec::new();
        for comparison in comparisons {
            let new_file = !seen.contains(&comparison.kind);
            seen.push(comparison.kind);
            self.kind(comparison.kind).add(file, new_file, &comparison);
        }
    }

    fn kind(&mut self, kind: &str) -> &mut KindReport {
        let index = self.kinds.iter().position(|known| known.kind == kind);
        let index = index.unwrap_or_else(|| {
            let reason = BY_DESIGN.iter().find(|(name, _)| *name == kind);
            self.kinds.push(KindReport {
                kind: kind.to_owned(),
                files: 0,
                checks: 0,
                passed: 0,
                differs_by_design: 0,
                worst_error: 0.0,
                tolerance: 0.0,
                reason: reason.map(|(_, reason)| (*reason).to_owned()),
                failures: Vec::new(),
            });
            self.kinds.len() - 1
        });
        &mut self.kinds[index]
    }
}

impl KindReport {
    fn add(&mut self, file: &str, new_file: bool, comparison: &Comparison) {
        self.files += usize::from(new_file);
        self.checks += 1;
        match &comparison.result {
            Err(why) => self.failures.push(format!("{file}: {why}")),
            Ok(error) => {
                self.worst_error = self.worst_error.max(*error);
                if comparison.tolerance == f64::INFINITY {
                    self.differs_by_design += 1;
                    return;
                }
                self.tolerance = self.tolerance.max(comparison.tolerance);
                // Not `>`: an error that is not a number must fail.
                if *error <= comparison.tolerance {
                    self.passed += 1;
                } else {
                    self.failures.push(format!("{file}: error {error:.3e}"));
                }
            }
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<32} {:>5} {:>6} {:>6} {:>9} {:>11} {:>9}",
            "kind", "files", "checks", "passed", "by design", "worst error", "allowed"
        )?;
        for kind in &self.kinds {
            writeln!(
                f,
                "{:<32} {:>5} {:>6} {:>6} {:>9} {:>11.1e} {:>9.0e}",
                kind.kind,
                kind.files,
                kind.checks,
                kind.passed,
                kind.differs_by_design,
                kind.worst_error,
                kind.tolerance
            )?;
        }
        for kind in &self.kinds {
            if let Some(reason) = &kind.reason {
                writeln!(f, "differs by design: {}: {reason}", kind.kind)?;
            }
            for failure in &kind.failures {
                writeln!(f, "FAILED {}: {failure}", kind.kind)?;
            }
        }
        for file in &self.unknown_files {
            writeln!(f, "no known kind: {file}")?;
        }
        Ok(())
    }
}

/// A directory or file that cannot be read.
#[derive(Debug)]
pub enum CheckError {
    /// The directory or a file cannot be read.
    Io(PathBuf, std::io::Error),
    /// The directory holds no JSON files.
    Empty(PathBuf),
}

impl fmt::Display for CheckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, error) => write!(f, "cannot read {}: {error}", path.display()),
            Self::Empty(path) => write!(
                f,
                "{} holds no .json files: give the directory of the recorded reference",
                path.display()
            ),
        }
    }
}

impl std::error::Error for CheckError {}

/// Checks every recorded file of a directory.
///
/// # Errors
/// [`CheckError`]. A file of a known kind that does not parse is a failure in the report.
pub fn check_directory(directory: &Path) -> Result<Report, CheckError> {
    let io = |error| CheckError::Io(directory.to_owned(), error);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(io)? {
        let path = entry.map_err(io)?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "json")
        {
            files.push(path);
        }
    }
    if files.is_empty() {
        return Err(CheckError::Empty(directory.to_owned()));
    }
    files.sort_by_key(|path| (order(&stem(path)), path.clone()));
    let mut report = Report::default();
    for path in files {
        let text =
            std::fs::read_to_string(&path).map_err(|error| CheckError::Io(path.clone(), error))?;
        let name = stem(&path);
        match check_file(&name, &text) {
            Some(comparisons) => report.add(&name, comparisons),
            None => report.unknown_files.push(name),
        }
    }
    Ok(report)
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .map(|stem| stem.to_string_lossy().into_owned())
        .unwrap_or_default()
}

type Checker = fn(&str) -> Result<Vec<Comparison>, serde_json::Error>;

/// Stems of file names, in the order of the data flow, with what checks them.
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

fn check_file(name: &str, text: &str) -> Option<Vec<Comparison>> {
    let (kind, check) = KINDS.get(order(name))?;
    Some(
        check(text).unwrap_or_else(|error| {
            vec![Comparison::failed(kind, format!("does not parse: {error}"))]
        }),
    )
}

/// Largest absolute difference of two sequences; not a number when their lengths differ.
pub(crate) fn worst_difference<'a>(
    ours: impl IntoIterator<Item = &'a f64>,
    recorded: impl IntoIterator<Item = &'a f64>,
) -> f64 {
    let (mut ours, mut recorded) = (ours.into_iter(), recorded.into_iter());
    let mut worst = 0.0_f64;
    loop {
        match (ours.next(), recorded.next()) {
            (Some(a), Some(b)) => {
                let difference = (a - b).abs();
                // `max` would lose a difference that is not a number.
                if difference.is_nan() {
                    return difference;
                }
                worst = worst.max(difference);
            }
            (None, None) => return worst,
            _ => return f64::NAN,
        }
    }
}
