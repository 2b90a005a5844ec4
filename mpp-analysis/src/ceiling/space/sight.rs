//! The oracle with a limited sight: it knows its state, and exactly each trunk that has been near. It flies the first part of a
//! witness through those to the edge of its sight, and then looks again (receding horizon).

use super::trunks::{Trunk, Woods};
use super::way::Way;
use super::{CeilingError, FIRST, Feasibility, Flight, HARDER, Moment, Question};
use mpp_sim::outcome::Outcome;
use mpp_sim::space::world::{Body, Extent, World};
use mpp_sim::space::{SpaceScenario, true_path};

/// Moments of a flight until the next look, 0.4 s. Less looks more often and takes longer.
const LOOK: usize = 2;
/// Most looks of a flight, far beyond those of a slow one.
const MOST_LOOKS: usize = 10_000;

/// Whether an oracle that sees trunks within a sight \[m\] passes the forest of a scenario. What it does not pass is undecided.
///
/// # Errors
/// As [`check_in_space`](super::check_in_space).
pub fn fly_with_sight(scenario: &SpaceScenario, sight: f64) -> Result<Feasibility, CeilingError> {
    let passes = Question::new(scenario)?.passes_with_sight(sight);
    Ok(if passes {
        Feasibility::Passable
    } else {
        Feasibility::Undecided
    })
}

impl Question {
    fn passes_with_sight(&self, sight: f64) -> bool {
        let extent = *self.scenario.world.extent();
        let mut unseen = self.trunks.clone();
        let (mut seen, mut moment, mut way) = (Vec::new(), self.start.clone(), None);
        for _ in 0..MOST_LOOKS {
            let [x, y, _] = true_path(moment.aircraft.state()).position;
            let near = |trunk: &mut Trunk| {
                libm::hypot(trunk.at[0] - x, trunk.at[1] - y) - trunk.radius <= sight
            };
            seen.extend(unseen.extract_if(.., near));
            let length = (x + sight).min(extent.length);
            let Some(known) = self.knowing(&seen, Extent { length, ..extent }) else {
                return false;
            };
            let Some((flight, flown)) = known.first_flight(&moment, way) else {
                return false;
            };
            if length >= extent.length && flight.outcome == Some(Outcome::Survived) {
                return true;
            }
            match flight.moments.into_iter().nth(LOOK - 1) {
                Some(next) => (moment, way) = (next, Some(flown)),
                None => return false,
            }
        }
        false
    }

    /// The same question about some of the trunks, in a smaller world.
    fn knowing(&self, trunks: &[Trunk], extent: Extent) -> Option<Self> {
        let body = |trunk: &Trunk| Body::Cylinder {
            x: trunk.at[0],
            y: trunk.at[1],
            radius: trunk.radius,
            height: f64::INFINITY,
        };
        let mut scenario = self.scenario.clone();
        scenario.world = World::new(trunks.iter().map(body).collect(), extent).ok()?;
        Some(Self {
            woods: Woods::new(trunks, &extent, &self.scenario.hull()),
            trunks: trunks.to_vec(),
            scenario,
            envelope: self.envelope,
            model: self.model,
            regulator: self.regulator.clone(),
            start: self.start.clone(),
        })
    }

    /// The first flight that reaches the end of the world, or the one that comes farthest, with its way; `None` if there is none.
    /// The way flown so far is one of them.
    fn first_flight(&self, from: &Moment, flown: Option<Way>) -> Option<(Flight, Way)> {
        let found = FIRST
            .iter()
            .chain(&HARDER)
            .filter_map(|it| self.way(it, from).ok());
        let mut best: Option<(Flight, Way)> = None;
        for way in found.chain(flown) {
            let flight = self.fly(from, &way);
            if flight.outcome == Some(Outcome::Survived) {
                return Some((flight, way));
            }
            let farther = |(best, _): &(Flight, Way)| flight.moments.len() > best.moments.len();
            if best.as_ref().is_none_or(farther) {
                best = Some((flight, way));
            }
        }
        best
    }
}
