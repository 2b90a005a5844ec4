//! An upper bound with full information: preset `flight` as it would fly if it knew everything.
//!
//! Plant, field, gusts and actuators are the same, from the same seed. The core is the same too,
//! with these differences:
//!
//! * its planner starts from the true position with the true velocity over ground; its map holds
//!   every obstacle of the field where it is at that time, thin ones too, and everything else is
//!   free, so that nothing is hidden or unknown;
//! * its sensors are exact, so that the regulator tracks by an estimate without noise;
//! * it replans at [`crate::scenario::ORACLE_REPLAN_HZ`] in the aircraft's unit of time, its plans are
//!   flown a tick later, and every candidate gets all rounds of linearisation.
//!
//! The oracle knows no future gust, no fault of the actuators, and not where an obstacle moves. A flight that the oracle fails is
//! not proven to be impossible: the planner's horizon, window and margin limit the oracle.
//!
//! Key `known_map` of a scenario makes less of an oracle: its map holds every obstacle within the lidar's range, and
//! nothing beyond. Estimates, sensors, rates and latency are as without it. So the difference of both flights is what
//! hidden obstacles cost. The oracle besides has exact measurements, more plans, all rounds and more sight.

use crate::field::{Field, Obstacle, Point, Shape};
use crate::scenario::Scenario;
use mpp_core::config::MAX_PATHS;
use mpp_core::planner::Planner;
use mpp_core::sense::LidarScan;
use mpp_core::tuning::grid::CELL;
use mpp_core::vehicle::{VehicleState, Wind};
use mpp_node::PlanRequest;

/// Distance along the track, in both directions, that covers the map and somewhat more \[m\].
const REACH: f64 = 80.0;

/// What an oracle knows besides the obstacles.
#[derive(Clone, Copy)]
enum Knowledge {
    /// Everything: the true state too, and every obstacle that the map has room for.
    All,
    /// The obstacles within a distance \[m\].
    Within(f64),
}

/// The knowledge of an oracle. Without the true state it knows the field alone, and plans from the
/// core's estimate.
pub struct Oracle {
    obstacles: Vec<Obstacle>,
    knowledge: Knowledge,
    /// True state and wind; `None` before the first tick, and if the oracle does not use them.
    truth: Option<(VehicleState, Wind)>,
}

impl Oracle {
    /// An oracle that knows these obstacles, before its first tick.
    #[must_use]
    pub fn new(obstacles: &[Obstacle]) -> Self {
        Self {
            obstacles: obstacles.to_vec(),
            knowledge: Knowledge::All,
            truth: None,
        }
    }

    /// An oracle that knows of these obstacles those within a distance \[m\], and no true state.
    #[must_use]
    pub fn of_map(obstacles: &[Obstacle], sight: f64) -> Self {
        Self {
            knowledge: Knowledge::Within(sight),
            ..Self::new(obstacles)
        }
    }

    /// Takes the true state of the aircraft and the motion of the air.
    pub(crate) fn see(&mut self, truth: &VehicleState, wind: Wind) {
        if matches!(self.knowledge, Knowledge::All) {
            self.truth = Some((*truth, wind));
        }
    }

    /// The oracle of a scenario in a field, if the scenario has one.
    pub(crate) fn of(scenario: &Scenario, field: &dyn Field) -> Option<Self> {
        if scenario.oracle {
            Some(Self::new(field.obstacles()))
        } else if scenario.known_map {
            Some(Self::of_map(field.obstacles(), scenario.lidar.range_max))
        } else {
            None
        }
    }

    /// The advice that a core gets: that of an oracle if there is one.
    pub fn advice(oracle: Option<&Self>) -> impl FnMut(&mut PlanRequest, &mut Planner) {
        move |request, planner| {
            if let Some(oracle) = oracle {
                oracle.advise(request, planner);
            }
        }
    }

    /// Replaces the core's map by the truth, and its estimates if the oracle knows the true state.
    fn advise(&self, request: &mut PlanRequest, planner: &mut Planner) {
        match request {
            PlanRequest::SetUp { settings, .. } => {
                if matches!(self.knowledge, Knowledge::All)
                    && let Some(own) = settings.planner.plane_mut()
                {
                    own.refined_candidates = MAX_PATHS;
                }
            }
            PlanRequest::Begin {
                poses,
                state,
                conditions,
                scan,
                time,
                planner: settings,
                ..
            } => {
                if let Some((truth, wind)) = &self.truth {
                    // The regulator tracks with the estimated motion. The error of this estimate
                    // counts as wind.
                    let (x, z) = wind.ground_velocity(&truth.air);
                    let (ahead, up) = Wind::STILL.ground_velocity(&state.air);
                    conditions.wind = Wind {
                        x: x - ahead,
                        z: z - up,
                    };
                    (state.x, state.z) = (truth.x, truth.z);
                    for pose in poses {
                        (pose.x, pose.z) = (truth.x, truth.z);
                    }
                }
                // Beams would clear occupied cells that they graze. Without a scan the planner would believe that it is blind.
                *scan = Some(LidarScan::new());
                let length = planner.plane().map_or(1.0, |own| own.units().length);
                let place = (state.x, state.z);
                let reach = match self.knowledge {
                    Knowledge::All => REACH * length,
                    Knowledge::Within(sight) => sight,
                };
                let near = |one: &&Obstacle| one.clearance(place, *time) < reach;
                let near: Vec<&Obstacle> = self.obstacles.iter().filter(near).collect();
                if let Some(planner) = planner.plane_mut() {
                    let map = planner.map_mut();
                    map.roll(state.x / length, settings.altitude / length);
                    map.know(|x, z| {
                        let (at, cell) = ((x * length, z * length), CELL * length);
                        near.iter().any(|one| occupies(one, at, cell, *time))
                    });
                }
            }
        }
    }
}

/// Whether an obstacle occupies the cell with this centre and edge \[m\] at a time \[s\]: it covers the centre, or it
/// touches the cell and may be too thin to cover any centre.
fn occupies(obstacle: &Obstacle, centre: Point, cell: f64, time: f64) -> bool {
    // A circle or a line of at least half the diagonal covers the centre of a cell, wherever it stands.
    let half_diagonal = 0.5 * cell * core::f64::consts::SQRT_2;
    let thick = match obstacle.shape {
        Shape::Circle { radius, .. } | Shape::Line { radius, .. } => radius >= half_diagonal,
        Shape::Polygon { .. } | Shape::Ground(_) | Shape::Ceiling(_) => false,
    };
    if thick {
        return obstacle.clearance(centre, time) <= 0.0;
    }
    obstacle.touches_square(centre, 0.5 * cell, time)
}

#[cfg(test)]
mod tests {
    use crate::field::{Obstacle, Shape};
    use crate::flight::{FlyError, fly};
    use crate::generator::{Generator, GeneratorName};
    use crate::link::LinkError;
    use crate::outcome::Outcome;
    use crate::pipe::PipeLink;
    use crate::scenario::{Preset, Scenario};

    /// A flight with a lidar that sees two metres and with obstacles straight ahead.
    fn in_the_dark() -> Scenario {
        let mut scenario = Scenario {
            obstacles: 0,
            ticks: 1000,
            ..Scenario::new(Preset::Flight, 1)
        };
        scenario.lidar.range_max = 2.0;
        for x in [40.0, 70.0] {
            scenario.placed.push(Obstacle::circle(x, 50.0, 2.0));
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

    /// A known map is that of the lidar's range: two metres do not suffice to turn, and the usual range does.
    #[test]
    fn a_known_map_ends_with_the_range_of_the_lidar() {
        let mut scenario = in_the_dark();
        scenario.known_map = true;
        let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
        assert_eq!(log.summary.outcome, Outcome::Collision);
        scenario.lidar.range_max = 45.0;
        let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
        assert_eq!(log.summary.outcome, Outcome::Survived);
        assert!(log.header.known_map && !log.header.oracle);
        assert!(log.header.scenario().unwrap().known_map);
        // Rate and sensors are those of the flight without it.
        assert_eq!(log.plans.len(), 10);
    }

    /// In a slalom the first wall hides the end of the second one. Who knows it flies through, by the same sensors and at
    /// the same rate.
    #[test]
    fn a_known_map_shows_what_a_wall_hides() {
        let mut scenario = Scenario {
            obstacles: 12,
            generator: Generator::named(GeneratorName::Slalom),
            replan_ticks: 25,
            ..Scenario::new(Preset::Flight, 50_003)
        };
        let unseen = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
        assert_eq!(unseen.summary.outcome, Outcome::Collision);
        scenario.known_map = true;
        let known = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
        assert_eq!(known.summary.outcome, Outcome::Survived);
        let error = fly(&scenario, &mut PipeLink::new(), |_| {}).unwrap_err();
        assert!(
            matches!(error, FlyError::Link(LinkError::NoOracle)),
            "{error}"
        );
    }

    /// The oracle knows more but cannot do more. A wall fills the band, so the oracle flies into
    /// the wall, or it leaves the band to fly around the wall.
    #[test]
    fn an_oracle_does_not_fly_through_walls() {
        let mut scenario = in_the_dark();
        scenario.placed = (0..30)
            .map(|row| Obstacle::circle(40.0, 35.5 + f64::from(row), 1.0))
            .collect();
        let scenario = scenario.informed();
        let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
        assert!(!log.summary.strict);
    }

    /// Circles that lie between the centres of four cells, and a bar between two rows of them.
    #[test]
    fn an_oracle_knows_thin_obstacles() {
        let post = |radius| Obstacle::circle(60.0, 50.0, radius);
        let bar = Obstacle::at_rest(Shape::Line {
            points: vec![(60.0, 47.0), (60.0, 53.0)],
            radius: 0.05,
        });
        for thin in [post(0.3), post(0.05), bar] {
            let mut scenario = in_the_dark().informed();
            scenario.seed = 8_840_000;
            scenario.placed = vec![thin];
            let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
            assert_eq!(log.summary.outcome, Outcome::Survived);
            assert!(
                log.summary.min_clearance.unwrap() > 0.2,
                "{:?}",
                scenario.placed
            );
        }
    }

    #[test]
    fn a_core_that_is_no_oracle_says_so() {
        let scenario = in_the_dark().informed();
        let error = fly(&scenario, &mut PipeLink::new(), |_| {}).unwrap_err();
        assert!(
            matches!(error, FlyError::Link(LinkError::NoOracle)),
            "{error}"
        );
    }
}
