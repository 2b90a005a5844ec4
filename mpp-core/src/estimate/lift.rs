//! How much more lift the wing gives than the airframe that the core knows.

use super::wind::LONGEST;
use crate::vehicle::{AirState, Airframe, Control, GRAVITY};

/// How long lift must be seen to be believed as much as the airframe that was told [s]: gusts move the mean
/// acceleration of a shorter time by more than errors of the airframe do.
const DOUBT: f64 = 0.7;
/// Beyond it, what was seen before is slowly forgotten [s].
const MEMORY: f64 = 6.0;
/// Greatest offset that is believed [-]: somewhat more than a quarter of the lift of level flight.
const MOST: f64 = 0.4;
/// Greatest difference in acceleration that is lift [m/s^2]: beyond it the position is wrong.
const MOST_ACCELERATION: f64 = 20.0;

/// Offset of the lift coefficient, at the angle of attack that the elevator balances.
///
/// Vertical acceleration over ground, twice differenced from the height, is lift, drag, thrust and
/// weight. What it is more than the airframe's at the elevator's angle of attack is averaged. Errors of
/// mass, lift slope and pitch stiffness all come out as this one number; gusts average out.
#[derive(Clone, Debug)]
pub struct LiftEstimator {
    airframe: Airframe,
    offset: f64,
    /// How long was averaged [s].
    seen: f64,
    /// Time [s] and height [m] of the last position, and the climb to it [m/s].
    last: Option<(f64, f64, Option<f64>)>,
}

impl LiftEstimator {
    /// An estimator that takes the airframe to be as told.
    #[must_use]
    pub const fn new(airframe: &Airframe) -> Self {
        Self {
            airframe: *airframe,
            offset: 0.0,
            seen: 0.0,
            last: None,
        }
    }

    /// What is to be added to the airframe's lift coefficient [-].
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// Takes in a height [m] at a time [s], the motion through the air, and what the actuators gave
    /// until then. What cannot be lift is left out.
    pub fn update(&mut self, time: f64, height: f64, air: &AirState, given: Control) {
        let last = self.last.replace((time, height, None));
        let Some((before, from, climb)) = last else {
            return;
        };
        let period = time - before;
        if !(period > 0.0 && period <= LONGEST) {
            return;
        }
        let climb_now = (height - from) / period;
        self.last = Some((time, height, Some(climb_now)));
        let Some(climb) = climb else {
            return;
        };
        let (expected, per_lift) = self.acceleration(air, given);
        let more = (climb_now - climb) / period - expected;
        // Not a number is in no range; without speed there is no lift.
        if !(-MOST_ACCELERATION..=MOST_ACCELERATION).contains(&more) || per_lift < 1.0 {
            return;
        }
        self.seen = (self.seen + period).min(MEMORY);
        let share = period / (DOUBT + self.seen);
        let offset = self.offset + share * (more / per_lift - self.offset);
        self.offset = offset.clamp(-MOST, MOST);
    }

    /// Vertical acceleration by the airframe as told, and how it changes with the lift coefficient
    /// [m/s^2].
    fn acceleration(&self, air: &AirState, given: Control) -> (f64, f64) {
        let a = &self.airframe;
        let alpha = a.angle_of_attack_for(given.elevator);
        let (sin, cos) = libm::sincos(air.flight_path);
        let pressure_area = 0.5 * a.air_density * (air.airspeed * air.airspeed) * a.wing_area;
        let lift = a.lift_zero + a.lift_alpha * alpha;
        let drag = a.drag_zero + a.drag_induced * (lift * lift);
        let thrust = given.thrust * libm::sin(air.flight_path + alpha);
        let force = pressure_area * (lift * cos - drag * sin) + thrust;
        (force / a.mass - GRAVITY, pressure_area * cos / a.mass)
    }
}
