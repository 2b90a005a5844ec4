//! What a flight came to.

use super::{PlanEntry, finite};
use crate::inquest::Failure;
use crate::outcome::{Class, Outcome, Score};
use serde::{Deserialize, Serialize};

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Survived, or what ended the flight.
    pub outcome: Outcome,
    /// Success by the strict rule: survived, and never left the altitude band.
    pub strict: bool,
    /// What a campaign counts the flight as.
    pub class: Class,
    /// Why it failed; not written if it did not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<Failure>,
    /// Time at the end [s].
    pub t_end: f64,
    /// Downrange distance at the end [m].
    pub x_end: f64,
    /// Least distance to an obstacle's edge [m]; null without obstacles.
    pub min_clearance: Option<f64>,
    /// Greatest distance from the initial altitude [m].
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
    /// Of a flight that has not begun.
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
    /// Of a flight that ended so, but for where and when; `holds_trim` when the core held level trim
    /// at that moment.
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
