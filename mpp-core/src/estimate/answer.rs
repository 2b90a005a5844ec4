//! The motion in pitch with which the known airframe answers its elevator.

use crate::config::TICK_PERIOD;
use crate::tuning::lift::SLOW_ANSWER;
use crate::vehicle::{AirState, Airframe, Control, air_rate};

/// The angle of attack of the known airframe under the elevator's command, by the equations of motion. No measurement of the
/// pitch enters, so that errors of the airframe stay to be seen.
#[derive(Clone, Debug)]
pub(super) struct Answer {
    airframe: Airframe,
    /// Angle of attack \[rad\] and pitch rate [rad/s], after the first step.
    motion: Option<(f64, f64)>,
}

impl Answer {
    /// The answer of an airframe at an airspeed [m/s]. `None` if the elevator alone tells the angle of attack: the turn does not
    /// damp the pitch, or the answer is over soon.
    ///
    /// A pitch loop is always followed. Its damping holds back the angle of attack for as long as a turn lasts: of a command
    /// the loop of ArduPlane's plane gives a quarter.
    pub(super) fn of(airframe: &Airframe, airspeed: f64) -> Option<Self> {
        let a = airframe;
        let flow = 0.5 * a.air_density * airspeed * a.wing_area;
        let damping =
            -flow * airspeed * a.moment_length * (a.moment_pitch_rate + a.moment_alpha_rate)
                / a.pitch_inertia
                + flow * a.lift_alpha / a.mass;
        let stiffness =
            -flow * airspeed * a.moment_length * a.turn_stiffness(airspeed) / a.pitch_inertia;
        // Both roots of the motion are slower than this rate.
        let rate = damping.max(libm::sqrt(stiffness));
        let follows = rate < SLOW_ANSWER || a.commands_angle_of_attack();
        (follows && a.moment_pitch_rate < 0.0).then_some(Self {
            airframe: *airframe,
            motion: None,
        })
    }

    /// Moves on by a period \[s\] of a flight with this motion and these controls. Returns the angle of attack \[rad\].
    pub(super) fn follow(&mut self, period: f64, air: &AirState, given: Control) -> f64 {
        let (alpha, pitch_rate) = (self.motion).unwrap_or((air.angle_of_attack(), air.pitch_rate));
        let rate = air_rate(
            &self.airframe,
            &AirState {
                pitch: air.flight_path + alpha,
                pitch_rate,
                ..*air
            },
            given,
        );
        // More time than a tick has been flown without control.
        let period = period.clamp(0.0, TICK_PERIOD);
        let alpha = alpha + period * (pitch_rate - rate.flight_path);
        let pitch_rate = pitch_rate + period * rate.pitch_rate;
        let finite = alpha.is_finite() && pitch_rate.is_finite();
        self.motion = finite.then_some((alpha, pitch_rate));
        alpha
    }
}
