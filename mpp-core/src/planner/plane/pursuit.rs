//! Roll-outs without a program: the aircraft steers towards a course with the lift that it has.

use super::PlanePlanner;
use super::candidate::Candidate;
use crate::config::{KNOTS, STAGE_PERIOD};
use crate::tuning::gate::{LOOK_AHEAD, SPEED_GAIN};
use crate::vehicle::{PathState, Trim};
use mpp_data::GRAVITY;

/// Where a roll-out without a program is to go.
pub(super) enum Course<'a> {
    /// Along the places of these knots.
    Path(&'a [PathState; KNOTS]),
    /// Level over ground, with the airspeed of this trim.
    Level(Trim),
    /// Up with this angle of the path \[rad\] and all thrust.
    Climb(f64),
}

impl PlanePlanner {
    /// Flies a course out from where the aircraft takes the plan over.
    #[inline(never)]
    pub(super) fn pursue(&self, course: &Course<'_>) -> Candidate {
        let mut candidate = self.cruising();
        candidate.steer(&self.frame(), &self.limits, |_, state| {
            self.steered(course, state)
        });
        candidate
    }

    /// Rate of the angle of attack and thrust beyond trim that lead from a state to a course.
    fn steered(&self, course: &Course<'_>, state: &PathState) -> [f64; 2] {
        let (path, airspeed) = match course {
            Course::Path(knots) => (aim(knots, state), self.trim.state.airspeed),
            Course::Level(trim) => (0.0, trim.state.airspeed),
            Course::Climb(path) => (*path, f64::INFINITY),
        };
        let speed = state.airspeed.max(1.0);
        let level = libm::atan2(self.wind.z, speed);
        let wanted = (path - level)
            .max(-self.limits.flight_path)
            .min(self.limits.flight_path);
        let a = &self.airframe;
        let pressure_area = 0.5 * a.air_density * (speed * speed) * a.wing_area;
        // The angle of attack whose lift turns the path there within a stage or two.
        let turn = (wanted - state.flight_path) / (2.0 * STAGE_PERIOD);
        let load = a.mass * (speed * turn + GRAVITY * libm::cos(state.flight_path));
        let alpha = (load / pressure_area - a.lift_zero) / a.lift_alpha;
        let [down, up] = self.limits.rolled_out;
        let trim = self.trim.state.angle_of_attack();
        let alpha = alpha.max(trim - down).min(trim + up);
        let thrust = (SPEED_GAIN * (airspeed - state.airspeed)).min(self.limits.thrust_max);
        [(alpha - state.angle_of_attack) / STAGE_PERIOD, thrust]
    }
}

/// The angle over ground towards the place on a path that lies ahead \[rad\].
fn aim(knots: &[PathState; KNOTS], state: &PathState) -> f64 {
    let ahead = |knot: &&PathState| knot.x > state.x + LOOK_AHEAD;
    let [.., last] = knots;
    let target = knots.iter().find(ahead).unwrap_or(last);
    libm::atan2(target.z - state.z, (target.x - state.x).max(LOOK_AHEAD))
}
