//! The cause of a failed flight. Rules that use measured values give each failure one cause.
//!
//! For a collision the inquest checks the obstacle that was hit and the plan flown at impact. The
//! first rule that applies gives the cause:
//!
//! 1. no plan was flown ([`Class::NoPlan`]): [`Cause::NoPlan`];
//! 2. the plan passes the true obstacle at [`KEPT`] or more: [`Cause::Tracking`];
//! 3. no beam had met the obstacle when the plan was made, or the first plan that could know it was
//!    taken over less than [`REACTION`] before impact: [`Cause::Hidden`];
//! 4. a candidate of the plan's cycle kept every margin in the map: [`Cause::Misjudged`];
//! 5. the last earlier plan whose cycle had such a candidate passes nearer than [`MARGIN`] to an
//!    obstacle that no beam had met then and that stands within [`ALLEY`] of the one that was hit:
//!    [`Cause::BlindAlley`];
//!
//! For other failures the cause is the class. Every distance is that of the body's edge, and of an
//! obstacle where it is at that time.

use crate::field::{Field, Obstacle, Point};
use crate::lidar::RANGE_MIN;
use crate::outcome::Class;
use crate::scenario::Scenario;
use crate::tick_record::TickRecord;
use hil_protocol::LidarScan;
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::VehicleState;
use serde::{Deserialize, Serialize};

/// Least distance from a true obstacle at which a plan counts as one that kept its margin \[m\]. The
/// value allows for the coarseness of cells and knots.
pub const KEPT: f64 = 0.2;
/// Distance from a true obstacle that every plan keeps if it knows the obstacle \[m\].
pub const MARGIN: f64 = 0.8;
/// Distance along the track, in both directions, within which an obstacle can close the way past
/// another \[m\]. It is one second of flight.
pub const ALLEY: f64 = 12.0;
/// Time that the aircraft needs to avoid a circle straight ahead \[s\].
pub const REACTION: f64 = 0.7;

/// Largest distance between a return and the obstacle that it came from \[m\], without the next part.
const RETURN_OFF: f64 = 2.0;
/// Part of this distance that grows with the range, as a share of the range [-].
const RETURN_OFF_SHARE: f64 = 0.05;

/// The cause of a failed flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// Collision with an obstacle that no beam met, or that a beam met too late.
    Hidden,
    /// Collision with a known obstacle, on a way that was open until a hidden obstacle closed it.
    BlindAlley,
    /// Collision with a known obstacle: no candidate kept its margin, and no hidden obstacle is the
    /// cause.
    NoWay,
    /// Collision with a known obstacle that the plan leads into, although candidates kept their
    /// margin.
    Misjudged,
    /// Collision although the plan kept its margin: the aircraft was off the plan.
    Tracking,
    /// The cause of the class [`Class::NoPlan`].
    NoPlan,
    /// The cause of the class [`Class::Pitch`].
    Pitch,
    /// The cause of the class [`Class::FlightPath`].
    FlightPath,
    /// The cause of the class [`Class::LeftBand`].
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

/// A failure and the values that were measured for it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// Cause of the failure.
    pub cause: Cause,
    /// Time from the first scan that met the obstacle until impact \[s\]; null without such a scan.
    pub seen_before: Option<f64>,
    /// Least distance of the plan flown at impact from the obstacle's edge \[m\]. It is negative
    /// inside, and null without a plan or an obstacle.
    pub plan_clearance: Option<f64>,
    /// Distance of the aircraft from that plan \[m\]; null without a collision or a plan.
    pub off_plan: Option<f64>,
}

/// A scan with its time and the true state.
struct Sight {
    t: f64,
    state: VehicleState,
    scan: LidarScan,
}

/// A plan that was flown.
struct Plan {
    /// Time of its scan \[s\].
    made: f64,
    /// Time at which it was taken over \[s\].
    used: f64,
    /// Whether a candidate of its cycle kept every margin.
    feasible: bool,
    /// Time from a position to the next \[s\].
    period: f64,
    /// Positions along the plan.
    path: Vec<Point>,
}

/// Collects evidence while a flight goes on.
#[derive(Default)]
pub(crate) struct Inquest {
    sights: Vec<Sight>,
    plans: Vec<Plan>,
}

impl Inquest {
    /// Records one tick.
    pub(crate) fn watch(&mut self, record: &TickRecord<'_>) {
        let (t, state) = (record.tick.t, record.tick.state);
        if let Some(scan) = record.scan {
            let scan = scan.clone();
            self.sights.push(Sight { t, state, scan });
        }
        if let (Some(report), Some(trajectory)) = (record.report, record.trajectory) {
            let knots = trajectory.knots.iter();
            self.plans.push(Plan {
                made: Scenario::time(report.scan_tick),
                used: Scenario::time(report.used_from_tick),
                feasible: report.feasible > 0,
                period: f64::from(trajectory.period),
                path: knots
                    .map(|[x, z, _]| (f64::from(*x), f64::from(*z)))
                    .collect(),
            });
        }
    }

    /// Time from the first scan that met the obstacle nearest to a place until `t_end` \[s\]. Returns `None` if
    /// no beam met it.
    pub(crate) fn seen_before(&self, field: &[Obstacle], place: Point, t_end: f64) -> Option<f64> {
        let clearance = |index: &usize| field[*index].clearance(place, t_end);
        let hit = (0..field.len()).min_by(|a, b| clearance(a).total_cmp(&clearance(b)))?;
        self.first_met(field, hit).map(|t| t_end - t)
    }

    /// The failure of a flight that ended at `t_end` \[s\], of a body of a radius \[m\]. `last` holds the
    /// positions before and after the last tick. Returns `None` if the flight did not fail by itself.
    pub(crate) fn conclude(
        &self,
        class: Class,
        field: &dyn Field,
        last: (Point, Point),
        t_end: f64,
        body_radius: f64,
    ) -> Option<Failure> {
        let cause = match class {
            Class::Success | Class::Terminated | Class::Interrupted => return None,
            Class::Collision => {
                return Some(self.collision(field.obstacles(), last, t_end, body_radius));
            }
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

    fn collision(
        &self,
        field: &[Obstacle],
        last: (Point, Point),
        t_end: f64,
        body_radius: f64,
    ) -> Failure {
        let times = [t_end - TICK_PERIOD, t_end];
        let clearance = |index: &usize| field[*index].clearance_of_motion(last.0, last.1, times);
        let hit = (0..field.len()).min_by(|a, b| clearance(a).total_cmp(&clearance(b)));
        // A field that does not consist of circles may have none. Then no beam has met the obstacle
        // that was hit.
        let first_met = hit.and_then(|hit| self.first_met(field, hit));
        let mut failure = Failure {
            cause: Cause::NoPlan,
            seen_before: first_met.map(|t| t_end - t),
            plan_clearance: None,
            off_plan: None,
        };
        let Some((flown, earlier)) = self.plans.split_last() else {
            return failure;
        };
        let (x, z) = last.1;
        let aircraft = Obstacle::circle(x, z, 0.0);
        let clearance = hit.map(|hit| passes(&field[hit], flown) - body_radius);
        failure.plan_clearance = clearance;
        failure.off_plan = Some(passes(&aircraft, flown));
        let knowing = |plan: &&Plan| first_met.is_some_and(|t| t <= plan.made);
        let first_knowing = self.plans.iter().find(knowing);
        let in_time = first_knowing.is_some_and(|plan| t_end - plan.used >= REACTION);
        failure.cause = if clearance.is_some_and(|clearance| clearance >= KEPT) {
            Cause::Tracking
        } else if !in_time {
            Cause::Hidden
        } else if flown.feasible {
            Cause::Misjudged
        } else if earlier
            .iter()
            .rfind(|plan| plan.feasible)
            .zip(hit)
            .is_some_and(|(plan, hit)| self.leads_into_the_dark(plan, field, hit, body_radius))
        {
            Cause::BlindAlley
        } else {
            Cause::NoWay
        };
        failure
    }

    /// Time at which a beam first met one obstacle \[s\].
    fn first_met(&self, field: &[Obstacle], index: usize) -> Option<f64> {
        let meeting = self.sights.iter().find(|sight| meets(sight, field, index));
        meeting.map(|sight| sight.t)
    }

    /// Whether a plan passes nearer than [`MARGIN`] to an obstacle that no beam had met yet and that
    /// stands within [`ALLEY`] of the one that was hit.
    fn leads_into_the_dark(
        &self,
        plan: &Plan,
        field: &[Obstacle],
        hit: usize,
        body_radius: f64,
    ) -> bool {
        let middle = field[hit].middle();
        let near = |one: &Obstacle| (one.middle() - middle).abs() <= ALLEY;
        let passed = |one: &Obstacle| passes(one, plan) - body_radius < MARGIN;
        let unseen = |index| {
            let met = self.first_met(field, index);
            met.is_none_or(|t| t > plan.made)
        };
        let mut obstacles = field.iter().enumerate();
        obstacles.any(|(index, one)| near(one) && passed(one) && unseen(index))
    }
}

/// Whether a return of a scan comes from this obstacle: nothing else is nearer on its beam.
fn meets(sight: &Sight, field: &[Obstacle], index: usize) -> bool {
    let Sight { t, state, scan } = sight;
    let met = |(beam, range): (usize, &f32)| {
        let range = f64::from(*range);
        let increment = f64::from(scan.angle_increment) * beam as f64;
        let angle = state.air.pitch + f64::from(scan.angle_min) + increment;
        let (up, ahead) = libm::sincos(angle);
        let entry = |one: &Obstacle| {
            let entry = one.range((state.x, state.z), (ahead, up), *t)?;
            Some(entry.max(RANGE_MIN))
        };
        let own = entry(&field[index]).filter(|_| range > 0.0);
        let Some(own) =
            own.filter(|own| (range - own).abs() <= RETURN_OFF + RETURN_OFF_SHARE * own)
        else {
            return false;
        };
        // Of two that are as near, the return comes from the first.
        let hides = |(other, one): (usize, &Obstacle)| {
            let order = entry(one).map(|entry| entry.total_cmp(&own));
            other != index && order.is_some_and(|order| order.then(other.cmp(&index)).is_lt())
        };
        !field.iter().enumerate().any(hides)
    };
    scan.ranges.iter().enumerate().any(met)
}

/// Least distance of a plan from an obstacle \[m\], at the times at which the plan is flown.
fn passes(obstacle: &Obstacle, plan: &Plan) -> f64 {
    let legs = plan.path.windows(2).zip(0_u32..);
    legs.map(|(leg, number)| {
        let begin = plan.used + plan.period * f64::from(number);
        obstacle.clearance_of_motion(leg[0], leg[1], [begin, begin + plan.period])
    })
    .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests;
