//! What an observer of a flight notes beside its log, for a campaign.

use crate::aircraft::Aircraft;
use crate::field::Point;
use crate::inquest::Inquest;
use crate::log::FlightLog;
use crate::outcome::Outcome;
use crate::plant::Plant;
use crate::scenario::Scenario;
use crate::tick_record::TickRecord;
use hil_protocol::{SensorState, SensorStates};
use mpp_core::vehicle::{Control, TrimError};
use std::collections::BTreeSet;

/// Time from which on an obstacle counts as known \[s\]: the aircraft can avoid it with time to spare.
pub const KNOWN: f64 = 1.0;

/// Watches one flight.
#[derive(Default)]
pub struct FlightObserver {
    inquest: Inquest,
    /// The first tick of the faults.
    onset: u32,
    /// Ticks watched.
    ticks: u32,
    place: Point,
    /// What the core commanded in each tick.
    commands: Vec<Control>,
    /// Inputs refused so far.
    rejections: usize,
    /// Names of the sensors and actuators that the core has told as failed.
    told: BTreeSet<&'static str>,
    /// Number of those that it tells now.
    tells: usize,
    flagged: Option<f64>,
}

impl FlightObserver {
    /// An observer of a flight of this scenario.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            onset: scenario.faults.onset(),
            ..Self::default()
        }
    }

    /// Records one tick.
    pub fn watch(&mut self, record: &TickRecord<'_>) {
        self.inquest.watch(record);
        self.place = (record.tick.state.x, record.tick.state.z);
        self.commands.push(record.tick.control);
        let since = self.ticks.checked_sub(self.onset);
        self.ticks += 1;
        let tells = failed(&record.sensors);
        let said = record.rejections.len() > self.rejections || tells.len() > self.tells;
        if let Some(since) = since.filter(|_| said) {
            self.flagged.get_or_insert(Scenario::time(since));
        }
        (self.rejections, self.tells) = (record.rejections.len(), tells.len());
        self.told.extend(tells);
    }

    /// Names of the sensors that the core excluded at some tick, of the motor if it was told to give no thrust, and of
    /// the elevator if it was told as weak or without an answer.
    #[must_use]
    pub fn told(&self) -> &BTreeSet<&'static str> {
        &self.told
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

    /// The aircraft with its actuators and its air, as it was this number of ticks before the end: it flies the
    /// commands up to there again.
    ///
    /// # Errors
    /// [`TrimError`] when the aircraft has no level flight.
    pub fn aircraft_before(&self, scenario: &Scenario, ticks: u32) -> Result<Aircraft, TrimError> {
        let mut aircraft = Aircraft::new(scenario)?;
        let flown = self.commands.len().saturating_sub(ticks as usize);
        for command in &self.commands[..flown] {
            // A plant that does not step keeps its state, as in the flight.
            let _ = aircraft.step(*command);
        }
        Ok(aircraft)
    }

    /// Where the last tick began \[m\].
    #[must_use]
    pub fn place(&self) -> Point {
        self.place
    }
}

/// Names of what the core tells as failed. A weak elevator is used on, with greater commands.
fn failed(states: &SensorStates) -> Vec<&'static str> {
    let weak = states.elevator == SensorState::Suspected;
    let named = states.named().into_iter();
    let failed = named
        .filter(|(name, state)| *state == SensorState::Excluded || (weak && *name == "elevator"));
    failed.map(|(name, _)| name).collect()
}
