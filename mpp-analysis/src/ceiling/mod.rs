//! The ceiling: which fields an aircraft can pass at all, proven either way.
//!
//! A verdict speaks about the flights of an [`Envelope`], in still air and without faults. A field is *blocked* if an outer
//! approximation of what these flights reach ends before the field does (`reach.rs`). It is *passable* if a flight of the simulated
//! aircraft passes it (`witness.rs`). If neither is found, the field stays undecided. `avoidable.rs` asks the same from
//! shortly before a collision.
//!
//! ```text
//! Scenario -> Envelope ----> Reach -----------------> Blocked
//!     |                        | free.rs
//!     +-----> Guide --------> Search -> commands ---> Passable
//! ```

mod avoidable;
mod envelope;
mod error;
mod free;
mod guide;
mod reach;
mod report;
mod space;
mod witness;

#[cfg(test)]
mod tests;

pub use avoidable::{BEFORE, avoidable};
pub use envelope::Envelope;
pub use error::CeilingError;
pub use report::{CeilingCell, CeilingReport, Counts, SpaceCeilingCell, SpaceCeilingReport};
pub use space::{SpaceEnvelope, check_in_space, decide_in_space, fly_with_sight};

use free::Interval;
use guide::{Guide, Way};
use mpp_sim::aircraft::Aircraft;
use mpp_sim::faults::Faults;
use mpp_sim::field::{Field, ObstacleField, Point};
use mpp_sim::plant::Plant;
use mpp_sim::scenario::{ALTITUDE, Scenario};
use reach::Reach;
use serde::{Deserialize, Serialize};
use witness::{Commands, Search};

/// Place that a flight has to reach, in a world of scale 1 \[m\]: 5 m beyond the centre of the last obstacle.
const END: f64 = 245.0;
/// Clearance beyond the margin that a witness should have where there is room, in a world of scale 1 \[m\].
const ROOM: f64 = 0.8;

/// The verdict about a field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Feasibility {
    /// No flight of the envelope reaches this place \[m\].
    Blocked(f64),
    /// A flight of the simulated aircraft passes.
    Passable,
    /// Neither was found.
    Undecided,
}

/// How hard a proof that a field is blocked tries.
struct Proof {
    /// Distance of layers, in a world of scale 1 \[m\].
    step: f64,
    /// Bins that the sine passes in a layer, to either side.
    bins: i64,
}

/// Finer layers cut more of the obstacles' corners off, and finer bins widen the sets less. Layers of 0.5 m blocked 0 of 8 fields
/// that layers of 0.1 m blocked.
const PROOFS: [Proof; 2] = [
    Proof {
        step: 0.25,
        bins: 6,
    },
    Proof { step: 0.1, bins: 8 },
];

/// How hard a search for a witness tries.
struct Effort {
    /// States that are kept at a time.
    width: usize,
    /// Duration of a command, in the aircraft's units \[s\].
    hold: f64,
    /// Part of the aircraft's turn that the guide reckons with [-].
    turn: f64,
    /// Distance of the guide's heights, in a world of scale 1 \[m\].
    rise: f64,
    /// The guide's steps of slope to either side of level.
    slopes: usize,
}

/// The first effort finds a witness wherever there is room; the others are for narrow ways.
const EFFORTS: [Effort; 4] = [
    Effort {
        width: 30,
        hold: 0.1,
        turn: 0.7,
        rise: 0.1,
        slopes: 16,
    },
    Effort {
        width: 150,
        hold: 0.1,
        turn: 0.8,
        rise: 0.05,
        slopes: 24,
    },
    Effort {
        width: 500,
        hold: 0.05,
        turn: 0.9,
        rise: 0.05,
        slopes: 32,
    },
    Effort {
        width: 500,
        hold: 0.05,
        turn: 0.7,
        rise: 0.05,
        slopes: 32,
    },
];

/// The verdict about the field of a scenario, for flights that keep a margin \[m\] beside the body's radius. Faults and
/// wind of the scenario do not count; limits of its actuators do.
///
/// # Errors
/// [`CeilingError`] if the field or the aircraft is none that can be judged.
pub fn decide(scenario: &Scenario, margin: f64) -> Result<Feasibility, CeilingError> {
    Ok(Question::new(scenario, margin)?.verdict())
}

/// The question whether a field can be passed.
struct Question {
    scenario: Scenario,
    field: ObstacleField,
    envelope: Envelope,
    /// The aircraft where it starts from.
    aircraft: Aircraft,
    end: f64,
    band: Interval,
    margin: f64,
    /// Whether the bounds of the envelope hold for the aircraft, so that a proof can be given.
    provable: bool,
}

impl Question {
    fn new(scenario: &Scenario, margin: f64) -> Result<Self, CeilingError> {
        if !(margin >= 0.0 && margin.is_finite()) {
            return Err(CeilingError::Margin(margin));
        }
        let mut scenario = scenario.clone();
        scenario.faults = Faults {
            actuators: scenario.faults.actuators,
            ..Faults::default()
        };
        let field = scenario.field();
        if field
            .obstacles()
            .iter()
            .any(|one| one.velocity != (0.0, 0.0))
        {
            return Err(CeilingError::Moving);
        }
        Ok(Self {
            field,
            envelope: Envelope::of(&scenario)?,
            aircraft: Aircraft::new(&scenario).map_err(CeilingError::Trim)?,
            end: END * scenario.world_scale,
            band: (ALTITUDE - scenario.band(), ALTITUDE + scenario.band()),
            margin: margin + scenario.body_radius,
            provable: true,
            scenario,
        })
    }

    fn verdict(&self) -> Feasibility {
        let passes = |effort| self.witness(effort).is_some();
        let [first, harder @ ..] = &EFFORTS;
        if passes(first) {
            return Feasibility::Passable;
        }
        if let Some(place) = self.blocked() {
            return Feasibility::Blocked(place);
        }
        if harder.iter().any(passes) {
            Feasibility::Passable
        } else {
            Feasibility::Undecided
        }
    }

    /// The place at which the field is proven to be blocked \[m\], if a proof would hold.
    fn blocked(&self) -> Option<f64> {
        let mut proofs = PROOFS.iter().filter(|_| self.provable);
        proofs.find_map(|proof| self.blocked_at(proof))
    }

    fn start(&self) -> Point {
        let state = self.aircraft.state();
        (state.x, state.z)
    }

    /// The place that no flight of the envelope reaches \[m\], if there is one.
    fn blocked_at(&self, proof: &Proof) -> Option<f64> {
        let reach = Reach {
            obstacles: self.field.obstacles(),
            envelope: &self.envelope,
            start: self.start(),
            sine: libm::sin(self.aircraft.state().air.flight_path),
            end: self.end,
            band: self.band,
            margin: self.margin,
            step: proof.step * self.scenario.world_scale,
            bins: proof.bins,
        };
        reach.blocked_at()
    }

    /// A flight that passes, as commands.
    fn witness(&self, effort: &Effort) -> Option<Commands> {
        let scale = self.scenario.world_scale;
        let guide = Guide::new(&Way {
            obstacles: self.field.obstacles(),
            start: self.start(),
            end: self.end,
            band: self.band,
            margin: self.margin,
            room: ROOM * scale,
            turn: effort.turn * self.envelope.level_turn,
            rise: effort.rise * scale,
            slopes: effort.slopes,
        });
        self.search(&guide, effort).run()
    }

    fn search<'a>(&'a self, guide: &'a Guide, effort: &Effort) -> Search<'a> {
        let aircraft = &self.scenario.aircraft;
        Search {
            start: &self.aircraft,
            airframe: &aircraft.known.airframe,
            field: &self.field,
            envelope: &self.envelope,
            guide,
            trim: aircraft.trim.control,
            cruise: aircraft.known.cruise,
            band: self.band,
            margin: self.margin,
            end: self.end,
            units: aircraft.units(),
            hold: effort.hold,
            width: effort.width,
        }
    }
}
