//! The summary of a flight.

use crate::entries::{PlanEntry, finite};
use crate::inquest::Failure;
use crate::outcome::{Class, Outcome, Score};
use serde::{Deserialize, Serialize};

/// The end of a flight and its totals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Outcome: the flight survived, or the event that ended it.
    pub outcome: Outcome,
    /// Success by the strict rule: survived, and never left the altitude band.
    pub strict: bool,
    /// Class in which a campaign counts the flight.
    pub class: Class,
    /// Cause of the failure; not written if the flight did not fail.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<Failure>,
    /// Time at the end \[s\].
    pub t_end: f64,
    /// Downrange distance at the end \[m\].
    pub x_end: f64,
    /// Least distance to an obstacle's edge \[m\]; null without obstacles.
    pub min_clearance: Option<f64>,
    /// Greatest distance from the initial altitude \[m\].
    pub max_altitude_deviation: f64,
    /// Number of plans delivered.
    pub replans: u32,
    /// Candidates over all plans.
    pub candidates: u32,
    /// Feasible candidates over all plans.
    pub feasible: u32,
    /// Slices of planning work over all plans.
    pub slices: u64,
}

impl Default for Summary {
    /// The summary of a flight that has not begun.
    fn default() -> Self {
        Self {
            outcome: Outcome::Survived,
            strict: true,
            class: Class::Success,
            failure: None,
            t_end: 0.0,
            x_end: 0.0,
            min_clearance: None,
            max_altitude_deviation: 0.0,
            replans: 0,
            candidates: 0,
            feasible: 0,
            slices: 0,
        }
    }
}

impl Summary {
    /// The summary of a flight with this outcome. The caller adds the failure, the time and the
    /// place of the end. `holds_trim` says that the core held level trim at the end.
    pub(crate) fn new(
        plans: &[PlanEntry],
        outcome: Outcome,
        score: &Score,
        holds_trim: bool,
    ) -> Self {
        let strict = outcome == Outcome::Survived && score.in_band();
        let planless = holds_trim || plans.last().is_some_and(PlanEntry::had_nothing);
        Self {
            outcome,
            strict,
            class: Class::of(outcome, strict, planless),
            min_clearance: finite(Some(score.min_clearance)),
            max_altitude_deviation: score.max_altitude_deviation,
            replans: plans.len() as u32,
            candidates: plans.iter().map(|plan| plan.candidates).sum(),
            feasible: plans.iter().map(|plan| plan.feasible).sum(),
            slices: plans.iter().map(|plan| u64::from(plan.slices)).sum(),
            ..Self::default()
        }
    }
}
