//! Estimate of the lift that the wing gives beyond that of the known airframe.

use super::answer::Answer;
use crate::tuning::lift::{MEMORY, MOST, TRUST_TIME};
use crate::units::REFERENCE_CRUISE;
use crate::vehicle::{AirState, Airframe, Control, GRAVITY};

/// Estimator of the offset of the lift coefficient, at the angle of attack that the elevator balances.
///
/// The estimator differentiates the climb rate over ground. Lift, drag, thrust and weight cause this
/// acceleration. The estimator averages the difference from the acceleration of the known airframe at the
/// elevator's angle of attack. An aircraft that follows its elevator slowly, or whose turn damps its pitch, has another angle
/// than the elevator balances: `Answer` follows it. Errors of mass, lift slope and pitch stiffness all appear in this one number;
/// gusts average out. The noise of the climb rate averages out too: the sum of its differences is the
/// difference between last and first.
#[derive(Clone, Debug)]
pub struct LiftEstimator {
    /// The known airframe, [balanced](Airframe::balanced).
    airframe: Airframe,
    answer: Option<Answer>,
    /// Averaged offset of the lift coefficient [-].
    average: f64,
    /// Time over which the offset was averaged \[s\].
    seen: f64,
    /// Climb rate over ground at the last tick [m/s].
    last: Option<f64>,
    /// Greatest plausible offset [-].
    most: f64,
}

impl LiftEstimator {
    /// An estimator that starts with the offset 0, for an airframe that cruises at an airspeed [m/s].
    #[must_use]
    pub fn new(airframe: &Airframe, cruise: f64) -> Self {
        let level = airframe.level_lift(cruise);
        let reference = Airframe::REFERENCE.level_lift(REFERENCE_CRUISE);
        Self {
            most: MOST * (level / reference),
            airframe: airframe.balanced(),
            answer: Answer::of(airframe, cruise),
            average: 0.0,
            seen: 0.0,
            last: None,
        }
    }

    /// Offset to add to the lift coefficient of the known airframe [-].
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.average.max(-self.most).min(self.most)
    }

    /// The averaged offset, however implausible [-].
    #[must_use]
    pub fn observed(&self) -> f64 {
        self.average
    }

    /// Takes in the climb rate over ground [m/s] after a further `period` \[s\], the motion through the air,
    /// and the controls that the actuators gave until then.
    pub fn update(&mut self, period: f64, climb: f64, air: &AirState, given: Control) {
        let balanced = self.airframe.angle_of_attack_for(given.elevator);
        let alpha = (self.answer.as_mut()).map_or(balanced, |it| it.follow(period, air, given));
        let Some(before) = self.last.replace(climb) else {
            return;
        };
        let (expected, per_lift) = self.acceleration(alpha, air, given.thrust);
        let more = (climb - before) / period - expected;
        // Without airspeed there is no lift. Without a period there is no acceleration.
        if !(more.is_finite() && per_lift >= 1.0 && period > 0.0) {
            return;
        }
        self.seen = (self.seen + period).min(MEMORY);
        let share = period / (TRUST_TIME + self.seen);
        self.average += share * (more / per_lift - self.average);
    }

    /// Goes back to an offset of before, and forgets the last climb rate.
    pub fn set_offset(&mut self, offset: f64) {
        self.average = offset;
        self.interrupt();
    }

    /// Forgets the last climb rate. The next one may be another by more than the acceleration.
    pub fn interrupt(&mut self) {
        self.last = None;
    }

    /// Vertical acceleration of the known airframe at an angle of attack, and its derivative with respect to the lift
    /// coefficient [m/s^2].
    fn acceleration(&self, alpha: f64, air: &AirState, thrust: f64) -> (f64, f64) {
        let a = &self.airframe;
        let (sin, cos) = libm::sincos(air.flight_path);
        let pressure_area = 0.5 * a.air_density * (air.airspeed * air.airspeed) * a.wing_area;
        let lift = a.lift_zero + a.lift_alpha * alpha;
        let drag = a.drag_zero + a.drag_induced * (lift * lift);
        let thrust = thrust * libm::sin(air.flight_path + alpha);
        let force = pressure_area * (lift * cos - drag * sin) + thrust;
        (force / a.mass - GRAVITY, pressure_area * cos / a.mass)
    }
}
