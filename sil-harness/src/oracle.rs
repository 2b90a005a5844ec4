//! An informed upper bound: preset `flight` as it would fly if it knew everything.
//!
//! The same plant, field, gusts and actuators, from the same seed. The core is the same too, but
//!
//! * its planner starts from the true position with the true velocity over ground, and its map holds every
//!   circle of the field, everything else being free: nothing is hidden and nothing unknown;
//! * its sensors are exact, so that the regulator tracks by an estimate without noise;
//! * it replans at [`REPLAN_HZ`], its plans are flown a tick later, and every candidate gets all
//!   rounds of linearisation.
//!
//! It knows no gust to come and no fault of the actuators. What it does not fly is not proven to be
//! impossible: it is bounded by the planner's horizon, window and margin.

use crate::scenario::{ALTITUDE, Scenario};
use crate::world::Obstacle;
use flight_node::Order;
use mpp_core::planner::Planner;
use mpp_core::vehicle::{VehicleState, Wind};

/// Replanning rate of an oracle [Hz].
pub const REPLAN_HZ: f64 = 10.0;
/// Reach of the map either way along the track, and somewhat more [m].
const REACH: f64 = 80.0;

/// What an oracle knows.
pub struct Oracle {
    obstacles: Vec<Obstacle>,
    /// None before the first tick.
    truth: Option<(VehicleState, Wind)>,
}

impl Oracle {
    /// The oracle of a scenario, before its first tick.
    pub(crate) fn new(scenario: &Scenario) -> Self {
        Self {
            obstacles: scenario.field().obstacles,
            truth: None,
        }
    }

    /// Sees where the aircraft is, and how the air moves.
    pub(crate) fn see(&mut self, truth: &VehicleState, wind: Wind) {
        self.truth = Some((*truth, wind));
    }

    /// Puts the truth in the place of what the core believes.
    pub(crate) fn advise(&self, order: &mut Order, planner: &mut Planner) {
        match order {
            Order::SetUp { tuning, .. } => {
                if let Some(iteration) = &mut tuning.settings.planner.iteration {
                    iteration.deepened = usize::MAX;
                }
            }
            Order::Begin {
                state,
                conditions,
                scan,
                ..
            } => {
                if let Some((truth, wind)) = &self.truth {
                    // The regulator tracks by the estimated motion: what is wrong with it counts as wind.
                    let (x, z) = wind.ground_velocity(&truth.air);
                    let (ahead, up) = Wind::STILL.ground_velocity(&state.air);
                    conditions.wind = Wind {
                        x: x - ahead,
                        z: z - up,
                    };
                    (state.x, state.z) = (truth.x, truth.z);
                }
                // Beams would unlearn cells that they graze.
                scan.ranges.clear();
                let near = |obstacle: &&Obstacle| (obstacle.x - state.x).abs() < REACH;
                let near: Vec<&Obstacle> = self.obstacles.iter().filter(near).collect();
                let map = planner.map_mut();
                map.roll(state.x, ALTITUDE);
                map.know(|x, z| {
                    near.iter()
                        .any(|obstacle| obstacle.clearance((x, z)) <= 0.0)
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::link::{LinkError, PipeLink};
    use crate::outcome::Outcome;
    use crate::run::{FlyError, fly};
    use crate::scenario::{Preset, Scenario};
    use crate::world::Obstacle;

    /// A lidar that sees two metres, and obstacles straight ahead.
    fn in_the_dark() -> Scenario {
        let mut scenario = Scenario {
            obstacles: 0,
            ticks: 1000,
            ..Scenario::new(Preset::Flight, 1)
        };
        scenario.lidar.range_max = 2.0;
        for x in [40.0, 70.0] {
            let (z, radius) = (50.0, 2.0);
            scenario.placed.push(Obstacle { x, z, radius });
        }
        scenario
    }

    #[test]
    fn an_oracle_flies_around_what_the_lidar_does_not_see() {
        let blind = fly(&in_the_dark(), &mut PipeLink::new(), |_| {}).unwrap();
        assert_eq!(blind.summary.outcome, Outcome::Collision);
        let scenario = in_the_dark().informed();
        let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
        assert_eq!(log.summary.outcome, Outcome::Survived);
        assert!(log.header.oracle && log.summary.min_clearance.unwrap() > 0.2);
        assert_eq!(log.plans.len(), 100);
    }

    /// It knows, but it cannot do more: behind a wall that fills the band it flies into the wall, or
    /// around it out of the band.
    #[test]
    fn an_oracle_does_not_fly_through_walls() {
        let mut scenario = in_the_dark();
        scenario.placed = (0..30)
            .map(|row| Obstacle {
                x: 40.0,
                z: 35.5 + f64::from(row),
                radius: 1.0,
            })
            .collect();
        let scenario = scenario.informed();
        let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
        assert!(!log.summary.strict);
    }

    #[test]
    fn a_core_that_is_no_oracle_says_so() {
        let scenario = in_the_dark().informed();
        let error = fly(&scenario, &mut PipeLink::new(), |_| {}).unwrap_err();
        assert!(
            matches!(error, FlyError::Link(LinkError::Peer(_))),
            "{error}"
        );
    }
}
