//! The judge of a flight. It collects its evidence while the flight goes on.

use crate::entries::PlanEntry;
use crate::field::{Field, Point};
use crate::inquest::Inquest;
use crate::log::Summary;
use crate::outcome::{Outcome, Score};
use crate::scenario::{ALTITUDE, Scenario};
use crate::tick_record::TickRecord;
use mpp_core::vehicle::VehicleState;

/// Watches a flight and summarises it.
pub(super) struct Judge {
    score: Score,
    inquest: Inquest,
    /// Positions before and after the last tick.
    last: (Point, Point),
    holds_trim: bool,
    /// Ticks flown.
    pub(super) flown: u32,
    /// Outcome that ended the flight; `None` while the flight goes on.
    pub(super) end: Option<Outcome>,
}

impl Judge {
    /// A judge before the first tick.
    pub(super) fn new(scenario: &Scenario) -> Self {
        Self {
            score: Score::new(ALTITUDE, scenario.band(), scenario.body_radius),
            inquest: Inquest::default(),
            last: ((0.0, 0.0), (0.0, 0.0)),
            holds_trim: true,
            flown: 0,
            end: None,
        }
    }

    /// Records one tick, which led from its state to `after`. `holds_trim` says that the core held
    /// level trim.
    pub(super) fn watch(
        &mut self,
        record: &TickRecord<'_>,
        field: &dyn Field,
        after: &VehicleState,
        holds_trim: bool,
    ) {
        let before = &record.tick.state;
        self.inquest.watch(record);
        self.holds_trim = holds_trim;
        self.end = self.score.update(field, before, after);
        self.last = ((before.x, before.z), (after.x, after.z));
        self.flown += 1;
    }

    /// The summary of a flight that ended at `x_end` downrange \[m\].
    pub(super) fn conclude(
        &self,
        outcome: Outcome,
        plans: &[PlanEntry],
        field: &dyn Field,
        x_end: f64,
    ) -> Summary {
        let t_end = Scenario::time(self.flown);
        let summary = Summary::new(plans, outcome, &self.score, self.holds_trim);
        let body = self.score.body_radius;
        let failure = self
            .inquest
            .conclude(summary.class, field, self.last, t_end, body);
        Summary {
            failure,
            t_end,
            x_end,
            ..summary
        }
    }
}
