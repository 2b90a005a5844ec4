//! The ceiling in space: which forests an aircraft that banks can pass, proven either way.
//!
//! ```text
//! SpaceScenario -> Envelope --------> Reach -----------> Blocked
//!      |               | reach.rs
//!      +-> Woods -> Search -> way -> Pilot: flights ---> Passable
//!          trunks.rs  way.rs   |     witness.rs
//!                   sight.rs: from look to look
//! ```

mod envelope;
mod reach;
mod sight;
#[cfg(test)]
mod tests;
mod trunks;
mod way;
mod witness;

pub use envelope::SpaceEnvelope;
pub use sight::fly_with_sight;

use super::{CeilingError, Feasibility};
use core::f64::consts::PI;
use mpp_core::control::SpaceRegulator;
use mpp_core::vehicle::{GRAVITY, SpaceModel};
use mpp_sim::faults::Faults;
use mpp_sim::outcome::Outcome;
use mpp_sim::space::{STRAY, SpaceAircraft, SpaceScenario, WindConfig, regulator, true_path};
use reach::Reach;
use trunks::{Place, Trunk, Woods, trunks};
use way::{Effort, Search, Way};
use witness::{Flight, Moment, Pilot};

/// Greatest bank of a way, and of the regulator that follows it \[rad\]: 62 deg, where plans have 60, and 5 deg to correct.
const BANK: f64 = 62.0 * (PI / 180.0);
const MOST_BANK: f64 = 67.0 * (PI / 180.0);
/// Rate of the bank of plans [rad/s]: 90 deg/s.
const BANK_RATE: f64 = 0.5 * PI;
/// Way before the end of the world up to which a proof looks \[m\]: what is touched farther on may be touched behind the end.
const LAST: f64 = 2.0;
/// How far beyond what searches reach a proof looks \[m\]. Where they all end, a proof ends soon or never.
const PATIENCE: f64 = 20.0;

/// The first efforts, each from the start. They find a witness wherever there is room.
const FIRST: [Effort; 2] = [
    Effort::new(300, [0.3, 0.5], [1.3, 0.92], 4),
    Effort::new(1000, [0.15, 0.4], [1.4, 0.95], 4),
];
/// The harder ones in turn, each from before the place where the last flight ended.
const HARDER: [Effort; 5] = [
    Effort::new(3000, [0.1, 0.4], [1.6, 0.95], 5),
    Effort::new(3000, [0.05, 0.3], [1.6, 0.92], 5),
    Effort::new(3000, [0.15, 0.3], [1.7, 0.97], 5),
    Effort::new(3000, [0.05, 0.2], [1.8, 1.0], 5),
    Effort::new(6000, [0.02, 0.2], [1.8, 1.0], 6),
];
/// How many of them.
const ATTEMPTS: usize = 25;
/// Moments before the end of a flight from which the next way begins, and how many more after a way that came no farther.
const BACK: usize = 5;
const MORE: usize = 4;

/// Refuses a scenario about which the ceiling says nothing.
///
/// # Errors
/// [`CeilingError`] if its world has more than endless trunks, or its aircraft does not fly.
pub fn check_in_space(scenario: &SpaceScenario) -> Result<(), CeilingError> {
    Question::new(scenario).map(|_| ())
}

/// The verdict about the forest of a scenario, in still air and without faults.
///
/// # Errors
/// As [`check_in_space`].
pub fn decide_in_space(scenario: &SpaceScenario) -> Result<Feasibility, CeilingError> {
    Ok(Question::new(scenario)?.verdict())
}

/// The question whether a forest can be passed.
struct Question {
    scenario: SpaceScenario,
    trunks: Vec<Trunk>,
    woods: Woods,
    envelope: SpaceEnvelope,
    model: SpaceModel,
    regulator: SpaceRegulator,
    /// The aircraft where it starts from.
    start: Moment,
}

impl Question {
    fn new(scenario: &SpaceScenario) -> Result<Self, CeilingError> {
        let mut scenario = scenario.clone();
        scenario.plane.faults = Faults::default();
        let refused = |error: &dyn std::fmt::Display| CeilingError::Aircraft(error.to_string());
        let known = &scenario.plane.aircraft.known;
        let thrust = scenario.plane.limits().thrust_max.unwrap_or(f64::INFINITY);
        let limits = [MOST_BANK, BANK_RATE];
        let of = |stall| {
            SpaceModel::new(&known.airframe, known.cruise, stall, thrust, limits)
                .map_err(CeilingError::Trim)
        };
        let level = of(f64::INFINITY)?;
        let attack = level.trim.state.angle_of_attack();
        // The stall is told from level flight on.
        let model = known
            .stall
            .map_or(Ok(level), |beyond| of(attack + beyond))?;
        let lateral = regulator(&scenario.plane).map_err(|error| refused(&error))?;
        let still = WindConfig::default();
        let aircraft = SpaceAircraft::new(&scenario.plane, still);
        let mut aircraft = aircraft.map_err(|error| refused(&error))?;
        aircraft.start_at(scenario.altitude());
        let trunks = trunks(&scenario.world)?;
        Ok(Self {
            woods: Woods::new(&trunks, scenario.world.extent(), &scenario.hull()),
            trunks,
            envelope: SpaceEnvelope::of(known.cruise),
            regulator: SpaceRegulator::new(&known.airframe, lateral, &model),
            model,
            start: Moment { aircraft, flown: 0 },
            scenario,
        })
    }

    fn verdict(&self) -> Feasibility {
        let length = self.scenario.world.extent().length;
        match self.witness() {
            Ok(_) => Feasibility::Passable,
            // There is a way, and no flight along it: no proof will hold.
            Err(farthest) if farthest >= length => Feasibility::Undecided,
            Err(farthest) => (self.blocked_at(farthest + PATIENCE))
                .map_or(Feasibility::Undecided, Feasibility::Blocked),
        }
    }

    /// A flight that passes, or how far searches come \[m\].
    fn witness(&self) -> Result<Flight, f64> {
        let mut farthest: f64 = 0.0;
        for effort in &FIRST {
            match self.attempt(effort, &self.start) {
                Ok(flight) if flight.outcome == Some(Outcome::Survived) => return Ok(flight),
                Ok(_) => farthest = self.scenario.world.extent().length,
                Err(reached) => farthest = farthest.max(reached),
            }
        }
        let mut moments = vec![self.start.clone()];
        let (mut flown, mut back) = (0.0, 0);
        for effort in HARDER.iter().cycle().take(ATTEMPTS) {
            let from = moments.len().saturating_sub(1 + back);
            let flight = match self.attempt(effort, &moments[from]) {
                Ok(flight) if flight.outcome == Some(Outcome::Survived) => return Ok(flight),
                Ok(flight) => flight,
                Err(reached) => {
                    farthest = farthest.max(reached);
                    back = 2 * back + MORE;
                    continue;
                }
            };
            farthest = self.scenario.world.extent().length;
            let reached = flight.moments.last().map_or(0.0, Moment::ahead);
            if reached > flown + 1.0 {
                flown = reached;
                moments.truncate(from + 1);
                moments.extend(flight.moments);
                back = BACK;
            } else {
                back += MORE;
            }
        }
        Err(farthest)
    }

    /// A flight along a way, or how far the search for a way comes \[m\].
    fn attempt(&self, effort: &Effort, from: &Moment) -> Result<Flight, f64> {
        self.way(effort, from).map(|way| self.fly(from, &way))
    }

    /// A way, or how far the search for it comes \[m\].
    fn way(&self, effort: &Effort, from: &Moment) -> Result<Way, f64> {
        let model = &self.model;
        let airspeed = model.trim.state.airspeed;
        let [_, most] = model.angle_of_attack;
        let load = model.pull(airspeed, most, model.trim.control.thrust) / GRAVITY;
        let path = true_path(from.aircraft.state());
        let [x, y, _] = path.position;
        let search = Search {
            woods: &self.woods,
            extent: self.scenario.world.extent(),
            airspeed,
            bank: effort.share * BANK.min(libm::acos((1.0 / load).min(1.0))),
            effort,
        };
        search.run(Place {
            at: [x, y],
            course: path.course,
            bank: path.bank,
        })
    }

    /// The flight along a way.
    fn fly(&self, from: &Moment, way: &Way) -> Flight {
        let pilot = Pilot {
            scenario: &self.scenario,
            envelope: &self.envelope,
            model: &self.model,
            regulator: &self.regulator,
        };
        pilot.fly(from, way, self.model.trim.state.airspeed)
    }

    /// The place, up to `most`, that no flight of the envelope reaches \[m\].
    fn blocked_at(&self, most: f64) -> Option<f64> {
        let extent = self.scenario.world.extent();
        let reach = Reach {
            trunks: &self.trunks,
            envelope: &self.envelope,
            hull: &self.scenario.hull(),
            length: most.min(extent.length - LAST),
            half_width: extent.half_width + STRAY,
            step: 0.5,
            sines: 80,
            banks: 12,
        };
        reach.blocked_at()
    }
}
