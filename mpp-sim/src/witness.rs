//! What an observer of a flight notes beside its log, for a campaign.

use crate::field::Point;
use crate::inquest::Inquest;
use crate::log::FlightLog;
use crate::moment::Moment;
use crate::outcome::Outcome;
use crate::scenario::Scenario;
use hil_protocol::SensorState;

/// Time from which on an obstacle counts as known \[s\]: the aircraft can avoid it with time to spare.
pub const KNOWN: f64 = 1.0;

/// Watches one flight.
#[derive(Default)]
pub struct Witness {
    inquest: Inquest,
    /// The first tick of the faults.
    onset: u32,
    /// Ticks watched.
    ticks: u32,
    place: Point,
    /// Inputs refused so far.
    rejections: usize,
    /// Number of sensors that are excluded or whose fault is made up for.
    told: usize,
    flagged: Option<f64>,
}

impl Witness {
    /// A witness of a flight of this scenario.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            onset: scenario.faults.onset(),
            ..Self::default()
        }
    }

    /// Records one tick.
    pub fn watch(&mut self, moment: &Moment<'_>) {
        self.inquest.watch(moment);
        self.place = (moment.tick.state.x, moment.tick.state.z);
        let since = self.ticks.checked_sub(self.onset);
        self.ticks += 1;
        let states = moment.sensors.named();
        // A weak elevator is used on, with greater commands.
        let weak = moment.sensors.elevator == SensorState::Suspected;
        let excluded = states
            .iter()
            .filter(|(_, state)| *state == SensorState::Excluded);
        let told = excluded.count() + usize::from(weak);
        let said = moment.rejections.len() > self.rejections || told > self.told;
        if let Some(since) = since.filter(|_| said) {
            self.flagged.get_or_insert(Scenario::time(since));
        }
        (self.rejections, self.told) = (moment.rejections.len(), told);
    }

    /// Time from the onset of the faults until the core first said that something is wrong \[s\]: it refused an
    /// input, excluded a sensor or the motor, or makes up for a weak elevator. `None` if it said nothing.
    #[must_use]
    pub fn flagged(&self) -> Option<f64> {
        self.flagged
    }

    /// Whether the flight collided with an obstacle that a beam had met more than [`KNOWN`] before. A scan
    /// that the lidar did not show, or that was lost, does not count.
    #[must_use]
    pub fn known_collision(&self, log: &FlightLog) -> bool {
        if log.summary.outcome != Outcome::Collision {
            return false;
        }
        let field = log.header.field.obstacles();
        let seen = self
            .inquest
            .seen_before(&field, self.place, log.summary.t_end);
        seen.is_some_and(|time| time > KNOWN)
    }
}
