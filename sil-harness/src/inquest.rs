//! Why a flight failed: one cause each, by rules that measure.
//!
//! A collision is asked, in this order, about the obstacle that was hit and the plan flown at impact:
//!
//! 1. no plan was flown ([`Class::NoPlan`]): [`Cause::NoPlan`];
//! 2. the plan passes the true circle at [`KEPT`] or more: [`Cause::Tracking`];
//! 3. no beam had met the obstacle when the plan was made, or the first plan that could know it was
//!    taken over less than [`REACTION`] before impact: [`Cause::Hidden`];
//! 4. a candidate of the plan's cycle kept every margin in the map: [`Cause::Misjudged`];
//! 5. the last plan before whose cycle had such a candidate passes an obstacle that no beam had met
//!    then, within [`ALLEY`] of the one that was hit, nearer than [`MARGIN`]: [`Cause::BlindAlley`];
//! 6. else: [`Cause::NoWay`].
//!
//! Other failures have their class for a cause.

use crate::lidar::entry_range;
use crate::outcome::Class;
use crate::run::Moment;
use crate::scenario::Scenario;
use crate::world::{Obstacle, ObstacleField, Point};
use hil_protocol::LidarScan;
use mpp_core::vehicle::VehicleState;
use serde::{Deserialize, Serialize};

/// Distance at which a plan passes a true circle and has kept its margin, cells and knots being as
/// coarse as they are [m].
pub const KEPT: f64 = 0.2;
/// Distance from a true circle within which no plan leads that knows it [m].
pub const MARGIN: f64 = 0.8;
/// Distance either way along the track within which an obstacle closes the way past another [m]: a
/// second of flight.
pub const ALLEY: f64 = 12.0;
/// Time that it takes to leave the way of a circle met head on [s].
pub const REACTION: f64 = 0.7;

/// Distance by which a return may be off the obstacle that it came from: [m], and share of the range.
const DOUBT: (f64, f64) = (2.0, 0.05);

/// Why a flight failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// Collision with what no beam had met, or too late.
    Hidden,
    /// Collision with a known obstacle, on a way that was open until a hidden one closed it.
    BlindAlley,
    /// Collision with a known obstacle: no candidate kept its margin, and nothing hidden is to blame.
    NoWay,
    /// Collision with a known obstacle that the plan leads into, though candidates kept their margin.
    Misjudged,
    /// Collision off a plan that kept its margin.
    Tracking,
    /// As [`Class::NoPlan`].
    NoPlan,
    /// As [`Class::Pitch`].
    Pitch,
    /// As [`Class::FlightPath`].
    FlightPath,
    /// As [`Class::LeftBand`].
    LeftBand,
}

impl Cause {
    /// Its name in rows and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Hidden => "hidden",
            Self::BlindAlley => "blind-alley",
            Self::NoWay => "no-way",
            Self::Misjudged => "misjudged",
            Self::Tracking => "tracking",
            Self::NoPlan => "no-plan",
            Self::Pitch => "pitch",
            Self::FlightPath => "flight-path",
            Self::LeftBand => "left-band",
        }
    }
}

/// A failure and what was measured for it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// Why.
    pub cause: Cause,
    /// Time from the first scan that met the obstacle until impact [s]; null without one.
    pub seen_before: Option<f64>,
    /// Least distance of the plan flown at impact from the obstacle's edge [m], negative inside; null
    /// without a plan or an obstacle.
    pub plan_clearance: Option<f64>,
    /// Distance of the aircraft from that plan [m]; null likewise.
    pub off_plan: Option<f64>,
}

/// A scan, and where it was made.
struct Sight {
    t: f64,
    state: VehicleState,
    scan: LidarScan,
}

/// A plan that was flown.
struct Plan {
    /// Time of its scan [s].
    made: f64,
    /// Time at which it was taken over [s].
    used: f64,
    /// Whether a candidate of its cycle kept every margin.
    feasible: bool,
    /// Where it leads.
    path: Vec<Point>,
}

/// Collects evidence while a flight goes on.
#[derive(Default)]
pub(crate) struct Inquest {
    sights: Vec<Sight>,
    plans: Vec<Plan>,
}

impl Inquest {
    /// Takes down one tick.
    pub(crate) fn watch(&mut self, moment: &Moment<'_>) {
        let (t, state) = (moment.tick.t, moment.tick.state);
        if let Some(scan) = moment.scan {
            let scan = scan.clone();
            self.sights.push(Sight { t, state, scan });
        }
        if let (Some(report), Some(trajectory)) = (moment.report, moment.trajectory) {
            let knots = trajectory.knots.iter();
            self.plans.push(Plan {
                made: Scenario::time(report.scan_tick),
                used: Scenario::time(report.used_from_tick),
                feasible: report.feasible > 0,
                path: knots
                    .map(|[x, z, _]| (f64::from(*x), f64::from(*z)))
                    .collect(),
            });
        }
    }

    /// What came of a flight whose last tick led from one place to the other, until `t_end` [s]; none
    /// if it did not fail by itself.
    pub(crate) fn conclude(
        &self,
        class: Class,
        field: &ObstacleField,
        last: (Point, Point),
        t_end: f64,
    ) -> Option<Failure> {
        let cause = match class {
            Class::Success | Class::Terminated => return None,
            Class::Collision => return Some(self.collision(field, last, t_end)),
            Class::LeftBand => Cause::LeftBand,
            Class::Pitch => Cause::Pitch,
            Class::FlightPath => Cause::FlightPath,
            Class::NoPlan => Cause::NoPlan,
        };
        Some(Failure {
            cause,
            seen_before: None,
            plan_clearance: None,
            off_plan: None,
        })
    }

    fn collision(&self, field: &ObstacleField, last: (Point, Point), t_end: f64) -> Failure {
        let seen = self.first_seen(field);
        let clearance =
            |index: &usize| field.obstacles[*index].clearance_of_segment(last.0, last.1);
        let hit = (0..field.obstacles.len())
            .min_by(|a, b| clearance(a).total_cmp(&clearance(b)))
            .unwrap_or(0);
        let mut failure = Failure {
            cause: Cause::NoPlan,
            seen_before: seen[hit].map(|t| t_end - t),
            plan_clearance: None,
            off_plan: None,
        };
        let Some((flown, earlier)) = self.plans.split_last() else {
            return failure;
        };
        let (x, z) = last.1;
        let aircraft = Obstacle { x, z, radius: 0.0 };
        let clearance = passes(&field.obstacles[hit], &flown.path);
        failure.plan_clearance = Some(clearance);
        failure.off_plan = Some(passes(&aircraft, &flown.path));
        let knowing = |plan: &&Plan| seen[hit].is_some_and(|t| t <= plan.made);
        let first_knowing = self.plans.iter().find(knowing);
        let in_time = first_knowing.is_some_and(|plan| t_end - plan.used >= REACTION);
        failure.cause = if clearance >= KEPT {
            Cause::Tracking
        } else if !in_time {
            Cause::Hidden
        } else if flown.feasible {
            Cause::Misjudged
        } else if earlier
            .iter()
            .rfind(|plan| plan.feasible)
            .is_some_and(|plan| leads_into_the_dark(plan, field, &seen, hit))
        {
            Cause::BlindAlley
        } else {
            Cause::NoWay
        };
        failure
    }

    /// When a beam first met each obstacle [s].
    fn first_seen(&self, field: &ObstacleField) -> Vec<Option<f64>> {
        let mut seen = vec![None; field.obstacles.len()];
        for sight in &self.sights {
            for index in met(sight, field) {
                seen[index].get_or_insert(sight.t);
            }
        }
        seen
    }
}

/// The obstacles that a scan's returns come from.
fn met(sight: &Sight, field: &ObstacleField) -> Vec<usize> {
    let Sight { state, scan, .. } = sight;
    let obstacle_of = |(beam, range): (usize, &f32)| {
        let range = f64::from(*range);
        let increment = f64::from(scan.angle_increment) * beam as f64;
        let angle = state.air.pitch + f64::from(scan.angle_min) + increment;
        let (up, ahead) = libm::sincos(angle);
        let entries = field
            .obstacles
            .iter()
            .enumerate()
            .filter_map(|(index, obstacle)| {
                Some((
                    index,
                    entry_range((state.x, state.z), (ahead, up), obstacle)?,
                ))
            });
        let (nearest, entry) = entries.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let told = range > 0.0 && (range - entry).abs() <= DOUBT.0 + DOUBT.1 * entry;
        told.then_some(nearest)
    };
    scan.ranges
        .iter()
        .enumerate()
        .filter_map(obstacle_of)
        .collect()
}

/// Whether a plan passes an obstacle that no beam had met yet, and that stands about the one that was
/// hit, nearer than [`MARGIN`].
fn leads_into_the_dark(
    plan: &Plan,
    field: &ObstacleField,
    seen: &[Option<f64>],
    hit: usize,
) -> bool {
    let obstacles = field.obstacles.iter().zip(seen);
    obstacles
        .filter(|(_, seen)| seen.is_none_or(|t| t > plan.made))
        .filter(|(obstacle, _)| (obstacle.x - field.obstacles[hit].x).abs() <= ALLEY)
        .any(|(obstacle, _)| passes(obstacle, &plan.path) < MARGIN)
}

/// Least distance of a path from a circle [m].
fn passes(circle: &Obstacle, path: &[Point]) -> f64 {
    let legs = path.iter().zip(path.iter().skip(1));
    legs.map(|(from, to)| circle.clearance_of_segment(*from, *to))
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests;
