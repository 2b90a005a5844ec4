//! The oracle with a limited sight: it knows its state, and exactly each trunk that has been near. It flies the first part of a
//! witness through those to the edge of its sight, and then looks again (receding horizon).

use super::trunks::{Trunk, Woods, forest};
use super::way::Way;
use super::{CeilingError, FIRST, Feasibility, Flight, HARDER, Moment, Question};
use mpp_sim::outcome::Outcome;
use mpp_sim::space::world::Extent;
use mpp_sim::space::{SpaceScenario, true_path};

/// Moments of a flight until the next look, 0.4 s. Less looks more often and takes longer.
const LOOK: usize = 2;

/// Whether an oracle that sees trunks within a sight \[m\] passes the forest of a scenario. What it does not pass is undecided.
///
/// # Errors
/// As [`check_in_space`](super::check_in_space).
pub fn fly_with_sight(scenario: &SpaceScenario, sight: f64) -> Result<Feasibility, CeilingError> {
    let passes = Question::new(scenario)?.passes_with_sight(sight).is_some();
    Ok(if passes {
        Feasibility::Passable
    } else {
        Feasibility::Undecided
    })
}

impl Question {
    /// `None` if it does not pass. Each look is later by [`LOOK`], and a flight ends with the time of its scenario.
    fn passes_with_sight(&self, sight: f64) -> Option<()> {
        let extent = *self.scenario.world.extent();
        let mut unseen = self.trunks.clone();
        let (mut seen, mut from, mut way) = (Vec::new(), self.start.clone(), None);
        loop {
            let [x, y, _] = true_path(from.aircraft.state()).position;
            let near = |trunk: &mut Trunk| {
                libm::hypot(trunk.at[0] - x, trunk.at[1] - y) - trunk.radius <= sight
            };
            seen.extend(unseen.extract_if(.., near));
            let length = (x + sight).min(extent.length);
            let known = self.knowing(&seen, Extent { length, ..extent }, from)?;
            let (flight, flown) = known.first_flight(way)?;
            if length >= extent.length && flight.outcome == Some(Outcome::Survived) {
                return Some(());
            }
            from = flight.moments.into_iter().nth(LOOK - 1)?;
            way = Some(flown);
        }
    }

    /// The question from a moment on, about some of the trunks in a smaller world.
    fn knowing(&self, trunks: &[Trunk], extent: Extent, start: Moment) -> Option<Self> {
        let mut scenario = self.scenario.clone();
        scenario.world = forest(trunks, extent).ok()?;
        Some(Self {
            woods: Woods::new(trunks, &extent, &scenario.hull()),
            trunks: trunks.to_vec(),
            scenario,
            envelope: self.envelope,
            model: self.model,
            regulator: self.regulator.clone(),
            start,
        })
    }

    /// The first flight that reaches the end of the world, or the one that comes farthest, with its way; `None` if there is none.
    /// The way flown so far is one of them.
    fn first_flight(&self, flown: Option<Way>) -> Option<(Flight, Way)> {
        let found = FIRST
            .iter()
            .chain(&HARDER)
            .filter_map(|it| self.way(it, &self.start).ok());
        let mut best: Option<(Flight, Way)> = None;
        for way in found.chain(flown) {
            let flight = self.fly(&self.start, &way);
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
