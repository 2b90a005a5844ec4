//! What a flight is judged by, in its panels: goal, band, limits, replans, closest approach, end.

use super::mark::{Mark, Outline};
use super::palette::{CLOSEST, GOOD, LIMIT, REFERENCE, of_outcome};
use super::panel::Panel;
use crate::closest::Closest;
use mpp_sim::log::FlightLog;
use mpp_sim::outcome::{ALTITUDE_BAND, Outcome};
use mpp_sim::scenario::{ALTITUDE, Scenario};

/// Width of the lines \[px\].
pub(super) const WIDTH: u32 = 6;

/// Adds the goal, which is the initial altitude, and the edges of the band about it.
pub(super) fn add_goal(panel: &mut Panel, log: &FlightLog) {
    let band = ALTITUDE_BAND * log.header.world_scale;
    let range = panel.x.range.clone();
    let mut level = |colour, z| panel.line(colour, WIDTH, &[(range.start, z), (range.end, z)]);
    level(LIMIT, ALTITUDE - band);
    level(LIMIT, ALTITUDE + band);
    level(GOOD, ALTITUDE);
}

/// Adds a dot of this radius \[px\] on the flown path wherever a plan took over, the closest approach, and the end.
pub(super) fn add_events(
    panel: &mut Panel,
    log: &FlightLog,
    closest: Option<&Closest>,
    radius: u32,
) {
    let ticks = &log.ticks;
    for tick in log.plans.iter().filter_map(|plan| plan.used_from_tick) {
        let row = usize::try_from(tick).unwrap_or(usize::MAX);
        if let (Some(x), Some(z)) = (ticks.x.get(row), ticks.z.get(row)) {
            panel.dot((*x, *z), radius, REFERENCE);
        }
    }
    if let Some(found) = closest {
        panel.mark((found.x, found.z), Outline::Ring, CLOSEST);
    }
    add_end(panel, log);
}

fn add_end(panel: &mut Panel, log: &FlightLog) {
    if let (Some(x), Some(z)) = (log.ticks.x.last(), log.ticks.z.last()) {
        let outcome = log.summary.outcome;
        panel.mark((*x, *z), of_end(outcome), of_outcome(outcome));
    }
}

/// Adds the end of a flight that failed.
pub(super) fn add_failure(panel: &mut Panel, log: &FlightLog) {
    if log.summary.outcome != Outcome::Survived {
        add_end(panel, log);
    }
}

/// The shape that stands for the end of a flight.
pub(super) fn of_end(outcome: Outcome) -> Outline {
    if outcome == Outcome::Survived {
        Outline::Diamond
    } else {
        Outline::Cross
    }
}

/// Adds a limit on both sides of 0.
pub(super) fn add_limits(panel: &mut Panel, limit: f64) {
    let range = panel.x.range.clone();
    for limit in [-limit, limit] {
        panel.line(LIMIT, WIDTH, &[(range.start, limit), (range.end, limit)]);
    }
}

/// Adds the time of the closest approach as an upright line.
pub(super) fn add_closest_time(panel: &mut Panel, closest: Option<&Closest>) {
    if let Some(found) = closest {
        let (time, range) = (Scenario::time(found.tick), panel.y.range.clone());
        panel.line(CLOSEST, WIDTH, &[(time, range.start), (time, range.end)]);
    }
}

impl Panel {
    /// Adds a mark if it lies within the panel.
    fn mark(&mut self, at: (f64, f64), outline: Outline, colour: plotters::style::RGBColor) {
        if self.holds(at) {
            self.marks.push(Mark {
                at,
                outline,
                colour,
            });
        }
    }
}
