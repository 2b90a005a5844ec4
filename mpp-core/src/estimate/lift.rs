//! Estimate of the lift that the wing gives beyond that of the known airframe.

use crate::tuning::lift::{MEMORY, MOST, MOST_ACCELERATION, TRUST_TIME};
use crate::tuning::wind::LONGEST_GAP;
use crate::vehicle::{AirState, Airframe, Control, GRAVITY};

/// Estimator of the offset of the lift coefficient, at the angle of attack that the elevator balances.
///
/// The estimator differentiates the height twice and gets the vertical acceleration over ground. Lift,
/// drag, thrust and weight cause this acceleration. The estimator averages the difference from the
/// acceleration of the known airframe at the elevator's angle of attack. Errors of mass, lift slope and
/// pitch stiffness all appear in this one number; gusts average out.
#[derive(Clone, Debug)]
pub struct LiftEstimator {
    airframe: Airframe,
    offset: f64,
    /// Time over which the offset was averaged \[s\].
    seen: f64,
    /// Time \[s\] and height \[m\] of the last position, and the climb rate up to it [m/s].
    last: Option<(f64, f64, Option<f64>)>,
}

impl LiftEstimator {
    /// An estimator that starts with the offset 0.
    #[must_use]
    pub const fn new(airframe: &Airframe) -> Self {
        Self {
            airframe: *airframe,
            offset: 0.0,
            seen: 0.0,
            last: None,
        }
    }

    /// Offset to add to the lift coefficient of the known airframe [-].
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// Takes in a height \[m\] at a time \[s\], the motion through the air, and the controls that the
    /// actuators gave until then. It ignores a difference in acceleration that is too large to be lift.
    pub fn update(&mut self, time: f64, height: f64, air: &AirState, given: Control) {
        let last = self.last.replace((time, height, None));
        let Some((before, from, climb)) = last else {
            return;
        };
        let period = time - before;
        if !(period > 0.0 && period <= LONGEST_GAP) {
            return;
        }
        let climb_now = (height - from) / period;
        self.last = Some((time, height, Some(climb_now)));
        let Some(climb) = climb else {
            return;
        };
        let (expected, per_lift) = self.acceleration(air, given);
        let more = (climb_now - climb) / period - expected;
        // The range test also refuses NaN. Without airspeed there is no lift.
        if !(-MOST_ACCELERATION..=MOST_ACCELERATION).contains(&more) || per_lift < 1.0 {
            return;
        }
        self.seen = (self.seen + period).min(MEMORY);
        let share = period / (TRUST_TIME + self.seen);
        let offset = self.offset + share * (more / per_lift - self.offset);
        self.offset = offset.clamp(-MOST, MOST);
    }

    /// Vertical acceleration of the known airframe, and its derivative with respect to the lift coefficient
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
