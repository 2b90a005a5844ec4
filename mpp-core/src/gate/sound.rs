//! Whether a trajectory is a motion of this aircraft, by equations of the gate's own.

use super::{Cause, Gate};
use crate::tuning::gate as numbers;
use crate::vehicle::VehicleState;
use mpp_data::GRAVITY;

impl Gate {
    /// What is wrong with the motion from one state to the next within a time, if anything. Comparisons are written so that
    /// a value that is not a number fails them.
    pub(super) fn unsound(
        &self,
        from: &VehicleState,
        to: &VehicleState,
        thrust: f64,
        dt: f64,
    ) -> Option<Cause> {
        if !(to.is_finite() && thrust.is_finite()) {
            return Some(Cause::Incomplete);
        }
        let [level, most] = self.alpha;
        let air = &to.air;
        let within = air.airspeed > numbers::LEAST_SPEED * self.cruise
            && air.airspeed < numbers::MOST_SPEED * self.cruise
            && libm::fabs(air.flight_path) < numbers::MOST_PATH
            && libm::fabs(air.angle_of_attack() - level) < most
            && thrust > -numbers::THRUST_SPARE
            && thrust < self.thrust_max + numbers::THRUST_SPARE;
        if !within {
            return Some(Cause::Limits);
        }
        let (follows, turns) = (self.follows(from, to, dt), self.is_carried(from, to, dt));
        (!(follows && turns)).then_some(Cause::Motion)
    }

    /// Whether the place follows from the speeds.
    fn follows(&self, from: &VehicleState, to: &VehicleState, dt: f64) -> bool {
        let (ahead, up) = self.wind.ground_velocity(&from.air);
        let (later_ahead, later_up) = self.wind.ground_velocity(&to.air);
        let off_x = to.x - from.x - 0.5 * dt * (ahead + later_ahead);
        let off_z = to.z - from.z - 0.5 * dt * (up + later_up);
        off_x * off_x + off_z * off_z < numbers::PLACE * numbers::PLACE
    }

    /// Whether lift turns the path as told, and a thrust that the motor has gives the airspeed.
    fn is_carried(&self, from: &VehicleState, to: &VehicleState, dt: f64) -> bool {
        let a = &self.airframe;
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        let airspeed = mean(from.air.airspeed, to.air.airspeed);
        let path = mean(from.air.flight_path, to.air.flight_path);
        let (before, after) = (from.air.angle_of_attack(), to.air.angle_of_attack());
        let alpha = mean(before, after);
        let turn = (to.air.flight_path - from.air.flight_path) / dt;
        let opens = (after - before) / dt;
        let weight = a.mass * GRAVITY;
        let pressure_area = 0.5 * a.air_density * (airspeed * airspeed) * a.wing_area;
        let lift = a.lift_zero + a.lift_alpha * alpha;
        let by_rates = a.lift_alpha_rate * opens + a.lift_pitch_rate * (opens + turn);
        let (up, along) = libm::sincos(path);
        let drag = pressure_area * (a.drag_zero + a.drag_induced * (lift * lift));
        let speeds_up = (to.air.airspeed - from.air.airspeed) / dt;
        let push = (a.mass * speeds_up + drag + weight * up) / libm::cos(alpha);
        let spare = numbers::LOAD_SPARE * weight;
        let carried = pressure_area * (lift + by_rates) + push * libm::sin(alpha);
        let needed = a.mass * airspeed * turn + weight * along;
        libm::fabs(needed - carried) < spare && push > -spare && push < self.thrust_max + spare
    }
}
