//! Comparisons and the report about them.

use serde::Serialize;
use std::fmt;

/// One comparison of our result with the recorded one.
#[derive(Clone, Debug)]
pub(super) struct Comparison {
    kind: &'static str,
    result: Result<f64, String>,
    tolerance: f64,
}

impl Comparison {
    /// An error that must not exceed a tolerance.
    pub(super) fn within(kind: &'static str, error: f64, tolerance: f64) -> Self {
        Self {
            kind,
            result: Ok(error),
            tolerance,
        }
    }

    /// A comparison that could not be made, or whose outcome is plainly wrong.
    pub(super) fn failed(kind: &'static str, why: impl Into<String>) -> Self {
        Self {
            kind,
            result: Err(why.into()),
            tolerance: 0.0,
        }
    }

    /// A difference by design. `BY_DESIGN` holds its reason.
    pub(super) fn by_design(kind: &'static str, error: f64) -> Self {
        Self::within(kind, error, f64::INFINITY)
    }
}

/// The reasons why our results differ from the recorded ones by design, for each kind.
const BY_DESIGN: [(&str, &str); 1] = [(
    "steady flight, not steady",
    "the recorded point is not steady: off level the authors' force balance has the wrong sign of \
     m g sin(gamma), and below 4.40 N there is no level flight to find",
)];

/// The result for one kind.
#[derive(Clone, Debug, Serialize)]
pub struct KindReport {
    /// Kind of the comparisons.
    pub kind: String,
    /// Number of files that hold such data.
    pub files: usize,
    /// Number of comparisons.
    pub checks: usize,
    /// Number of comparisons within tolerance.
    pub passed: usize,
    /// Number of comparisons that differ by design. They are counted apart.
    pub differs_by_design: usize,
    /// Worst error of the comparisons that could be made.
    pub worst_error: f64,
    /// Largest error allowed.
    pub tolerance: f64,
    /// Reason why the kind differs by design, if it does.
    pub reason: Option<String>,
    /// File and reason of each failure.
    pub failures: Vec<String>,
}

/// Results for a directory.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// One entry for each kind, in the order of the data flow.
    pub kinds: Vec<KindReport>,
    /// Files whose names begin with no known kind.
    pub unknown_files: Vec<String>,
}

impl Report {
    /// Whether every comparison that is not by design passed, and at least one was made.
    #[must_use]
    pub fn passed(&self) -> bool {
        !self.kinds.is_empty() && self.kinds.iter().all(|kind| kind.failures.is_empty())
    }

    pub(super) fn add(&mut self, file: &str, comparisons: Vec<Comparison>) {
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

/// Largest absolute difference of two sequences; not a number when their lengths differ.
pub(super) fn worst_difference<'a>(
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
