//! The regulator in space: the wanted lift as a vector, then bank and angle of attack.

use super::{LateralMotion, LateralRegulator};
use crate::vehicle::{
    Airframe, Control, GRAVITY, LateralAirframe, LateralControl, SpaceControl, SpaceModel,
    SpacePath, within,
};

/// Acceleration per metre of position error [1/s^2] and per m/s of velocity error [1/s]. More follows more closely and shakes
/// more with the errors of the estimate. Source: the trial of a prototype that decision 46 names.
const BY_POSITION: f64 = 2.0;
const BY_VELOCITY: f64 = 2.4;
/// Thrust per m/s of airspeed that is missing, in masses [1/s]. Source: as above.
const BY_AIRSPEED: f64 = 2.0;
/// Least natural frequency of the loop that holds the angle of attack [rad/s], and its damping ratio [-]. More frequency meets the
/// lag of the servo, 20 ms. Source: chosen, a fifth of the servo's bandwidth.
const FREQUENCY: f64 = 10.0;
const DAMPING: f64 = 0.8;
/// Least upward lift that gives a bank its direction [m/s^2].
const LEAST_UP: f64 = 1.0;

/// What the regulator is told of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceMotion {
    /// Position, air data and attitude as the estimator gives them.
    pub path: SpacePath,
    /// Roll rate, pitch rate, yaw rate of the body [rad/s].
    pub rates: [f64; 3],
    /// Sideslip \[rad\].
    pub sideslip: f64,
}

/// Follows a plan in space.
#[derive(Clone, Debug)]
pub struct SpaceRegulator {
    /// What holds the bank; without it an autopilot does, and the pitch, too.
    lateral: Option<LateralRegulator>,
    /// How late bank and pitch of an autopilot follow ramps of their commands, beside the dead times \[s\].
    lags: [f64; 2],
    airframe: Airframe,
    /// Elevator per radian of the angle of attack and per rad/s of the pitch rate, at the airspeed of level flight.
    gain: [f64; 2],
}

impl SpaceRegulator {
    /// The regulator of an aircraft whose lateral regulator is designed.
    #[must_use]
    pub fn new(airframe: &Airframe, lateral: LateralRegulator, model: &SpaceModel) -> Self {
        let a = airframe.balanced();
        let v = model.trim.state.airspeed;
        let pressure_area = 0.5 * a.air_density * (v * v) * a.wing_area;
        let per_moment = pressure_area * a.moment_length / a.pitch_inertia;
        let [stiffness, damping, elevator] =
            [a.moment_alpha, a.moment_pitch_rate, a.moment_elevator].map(|it| it * per_moment);
        let lift = pressure_area * a.lift_alpha / (a.mass * v);
        // Short period: `s^2 + (lift - damping) s - (stiffness + lift damping)`.
        let own = libm::sqrt((-stiffness - lift * damping).max(0.0));
        let frequency = own.max(FREQUENCY);
        let wanted_damping = (lift - 2.0 * DAMPING * frequency).min(damping);
        let wanted_stiffness = (-frequency * frequency - lift * wanted_damping).min(stiffness);
        Self {
            lateral: Some(lateral),
            lags: [0.0; 2],
            airframe: a,
            gain: [
                (wanted_stiffness - stiffness) / elevator,
                (wanted_damping - damping) / elevator,
            ],
        }
    }

    /// The regulator of an aircraft behind an autopilot that holds bank and pitch: its commands are the bank as the aileron and the
    /// angle of attack as the elevator, without feedback of either. `lateral` is that of the loop, of which rolling moment and
    /// damping tell the lag.
    #[must_use]
    pub fn behind_autopilot(
        airframe: &Airframe,
        lateral: &LateralAirframe,
        model: &SpaceModel,
    ) -> Self {
        let a = airframe.balanced();
        let per_rate = lateral.span / (2.0 * model.trim.state.airspeed);
        Self {
            lateral: None,
            lags: [
                -lateral.roll.roll_rate * per_rate / lateral.roll.aileron,
                a.moment_pitch_rate / a.moment_alpha,
            ],
            airframe: a,
            gain: [0.0; 2],
        }
    }

    /// The commands of this tick. `now` is the plan's state at this time, `ahead` state and control of the plan at the time when
    /// bank and angle of attack will have followed.
    #[must_use]
    pub fn step(
        &self,
        model: &SpaceModel,
        motion: &SpaceMotion,
        now: &SpacePath,
        ahead: (&SpacePath, &SpaceControl),
    ) -> (Control, LateralControl) {
        let path = &motion.path;
        let [bank, attack] = follow(model, path, now, ahead);
        let [low, high] = model.reachable_angles();
        let attack = attack.max(low).min(high);
        let [bank_lag, attack_lag] = self.lags;
        let attack = attack + attack_lag * ahead.1.angle_of_attack_rate;
        let thrust =
            ahead.1.thrust + BY_AIRSPEED * self.airframe.mass * (now.airspeed - path.airspeed);
        let command = Control {
            thrust: thrust.max(0.0).min(model.thrust_max),
            elevator: self.elevator(model, motion, attack),
        };
        let [roll_rate, _, yaw_rate] = motion.rates;
        let lateral = LateralMotion {
            airspeed: path.airspeed,
            bank: path.bank,
            roll_rate,
            yaw_rate,
            sideslip: motion.sideslip,
        };
        let rate = ahead.1.bank_rate;
        let lateral = match &self.lateral {
            Some(it) => it.follow(&lateral, bank, rate),
            None => LateralControl {
                aileron: within(bank + bank_lag * rate, model.bank),
                rudder: 0.0,
            },
        };
        (command, lateral)
    }

    /// The elevator that brings the angle of attack to a value: the balance there in a steady turn, and the feedback. It pulls no
    /// more than balances the greatest angle, because beyond the stall the lift line tells a small one (decision 64).
    fn elevator(&self, model: &SpaceModel, motion: &SpaceMotion, attack: f64) -> f64 {
        let (a, path) = (&self.airframe, &motion.path);
        let v = path.airspeed.max(0.5 * model.trim.state.airspeed);
        let pull = model.pull(v, attack, model.trim.control.thrust);
        let carried = GRAVITY * libm::cos(path.flight_path) * libm::cos(path.bank);
        let turn = (pull - carried) / v;
        let moment = a.moment_zero + a.moment_alpha * attack + a.moment_pitch_rate * turn;
        let ratio = model.trim.state.airspeed / v;
        let [by_attack, by_rate] = self.gain.map(|it| it * ratio * ratio);
        let (off, pitch_rate) = (path.angle_of_attack - attack, motion.rates[1]);
        let wanted = -moment / a.moment_elevator + by_attack * off + by_rate * (pitch_rate - turn);
        let [_, high] = model.reachable_angles();
        let most = -(a.moment_zero + a.moment_alpha * high + a.moment_pitch_rate * pitch_rate);
        if a.moment_elevator * wanted > most {
            most / a.moment_elevator
        } else {
            wanted
        }
    }
}

/// Bank and angle of attack \[rad\] that follow a plan. `now` is the plan's state at this time, `ahead` state and control of
/// the plan when they will be reached.
pub(crate) fn follow(
    model: &SpaceModel,
    path: &SpacePath,
    now: &SpacePath,
    ahead: (&SpacePath, &SpaceControl),
) -> [f64; 2] {
    let [forwards, up, right] = path.axes();
    let flown = path.ground_velocity_along(&forwards, &model.wind);
    let wanted = lift(model, (path, &flown), now, ahead);
    let along = |axis: [f64; 3]| wanted.iter().zip(&axis).map(|(a, b)| a * b).sum::<f64>();
    let (up, right) = (along(up), along(right));
    let bank = within(libm::atan2(right, up.max(LEAST_UP)), model.bank);
    let pull = (up / libm::cos(bank).max(0.3)).max(0.0);
    let pull = pull.min(libm::hypot(up, right));
    [bank, model.angle_for(path.airspeed, pull)]
}

/// The wanted acceleration across the flight path [m/s^2]: the lift of the plan, and what brings the aircraft, at a velocity over
/// ground [m/s], back to it.
fn lift(
    model: &SpaceModel,
    (path, flown): (&SpacePath, &[f64; 3]),
    now: &SpacePath,
    (ahead, control): (&SpacePath, &SpaceControl),
) -> [f64; 3] {
    let pull = model.pull(ahead.airspeed, ahead.angle_of_attack, control.thrust);
    let (sin_bank, cos_bank) = libm::sincos(ahead.bank);
    let [_, up, right] = ahead.axes();
    let planned = now.ground_velocity(&model.wind);
    core::array::from_fn(|axis| {
        pull * (cos_bank * up[axis] + sin_bank * right[axis])
            + BY_POSITION * (now.position[axis] - path.position[axis])
            + BY_VELOCITY * (planned[axis] - flown[axis])
    })
}
