//! Airspeed and pitch that are wrong at once, told by the motion over ground.
//!
//! Two errors at once hide each other from the watches of one sensor: a wrong airspeed makes the drag look wrong, so that a
//! wrong pitch does not tilt wind and airspeed alike. This observer uses neither of both sensors: the generalised observer
//! scheme (Frank, "Fault diagnosis in dynamic systems using analytical and knowledge-based redundancy", Automatica 26,
//! 1990). Its hypothesis is calm air and the known airframe. Then airspeed and path are those over ground, and commands and
//! known forces explain how both change. Of the weight of an aircraft at 12 m/s a wind of 1 m/s leaves a sixth unexplained.
//! While nothing is, an airspeed and a pitch that are both off are both wrong, and by as much as they are off.

use crate::tuning::calm_flight::{
    FOLLOWS, FOUND_FOR, LEAST_AIRSPEED, LEAST_PITCH, LONG, MEMORY, SETTLED, STEADY, UNEXPLAINED,
};
use crate::vehicle::{Airframe, GRAVITY};

/// What a tick shows of the motion over ground, and what the sensors say.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Velocity over ground `(x, z)` [m/s].
    pub velocity: (f64, f64),
    /// Measured airspeed [m/s].
    pub airspeed: f64,
    /// Measured pitch \[rad\].
    pub pitch: f64,
    /// Angle of attack that the commands give \[rad\].
    pub angle_of_attack: f64,
    /// Thrust that the motor gives \[N\].
    pub thrust: f64,
}

/// The observer, and what the sensors have been off lately.
#[derive(Clone, Copy, Debug)]
pub struct CalmFlight {
    /// The known airframe, [balanced](Airframe::balanced).
    airframe: Airframe,
    /// Velocity over ground by the forces, `(x, z)` [m/s].
    velocity: Option<(f64, f64)>,
    /// Time since the first tick \[s\].
    time: f64,
    /// Mean square of the acceleration that the forces do not explain, as a share of the weight [-].
    unexplained: f64,
    /// Mean over [`LONG`] by which the airspeed is off, as a share of it [-].
    airspeed: f64,
    /// Mean by which the pitch is off \[rad\], and its variance [rad^2].
    pitch: f64,
    variance: f64,
    /// Time for which both have been off while the forces explain the motion \[s\].
    shown: f64,
}

impl CalmFlight {
    /// An observer of this known airframe, without observations.
    #[must_use]
    pub fn new(known: &Airframe) -> Self {
        Self {
            airframe: known.balanced(),
            velocity: None,
            time: 0.0,
            unexplained: 0.0,
            airspeed: 0.0,
            pitch: 0.0,
            variance: 0.0,
            shown: 0.0,
        }
    }

    /// Takes in a tick after a further `period` \[s\]. Gives the amount by which the pitch reads too much \[rad\] if both sensors
    /// have been found wrong.
    pub fn update(&mut self, seen: &Seen, period: f64) -> Option<f64> {
        let (x, z) = seen.velocity;
        let speed = libm::sqrt(x * x + z * z);
        let sensed = seen.airspeed + seen.pitch + seen.angle_of_attack + seen.thrust;
        if !(sensed.is_finite() && speed > 1.0 && period > 0.0) {
            return None;
        }
        let (before_x, before_z) = self.velocity.unwrap_or(seen.velocity);
        let follows = (FOLLOWS * period).min(1.0);
        let off = (x - before_x, z - before_z);
        let pushed = self.acceleration(seen, speed);
        self.velocity = Some((
            before_x + period * pushed.0 + follows * off.0,
            before_z + period * pushed.1 + follows * off.1,
        ));
        self.time += period;
        if self.time < SETTLED {
            return None;
        }
        let lasts = self.time - SETTLED + period;
        let [share, slow] = [MEMORY, LONG].map(|most| (period / most.min(lasts)).min(1.0));
        let path = libm::asin((z / speed).clamp(-1.0, 1.0));
        let per_weight = FOLLOWS / GRAVITY;
        let square = per_weight * per_weight * (off.0 * off.0 + off.1 * off.1);
        let pitch = seen.pitch - seen.angle_of_attack - path - self.pitch;
        self.unexplained += share * (square - self.unexplained);
        self.airspeed += slow * ((seen.airspeed - speed) / speed - self.airspeed);
        self.pitch += share * pitch;
        self.variance += share * (pitch * pitch * (1.0 - share) - self.variance);
        let shows = self.time > SETTLED + MEMORY && self.both_off();
        self.shown = if shows { self.shown + period } else { 0.0 };
        (self.shown >= FOUND_FOR).then_some(self.pitch)
    }

    /// Whether the forces explain the motion, and neither sensor agrees with it.
    fn both_off(&self) -> bool {
        let square = self.pitch * self.pitch;
        self.unexplained < UNEXPLAINED * UNEXPLAINED
            && libm::fabs(self.airspeed) > LEAST_AIRSPEED
            && square > LEAST_PITCH * LEAST_PITCH
            && square > STEADY * STEADY * self.variance
    }

    /// Acceleration in calm air, `(x, z)` [m/s^2].
    fn acceleration(&self, seen: &Seen, speed: f64) -> (f64, f64) {
        let a = &self.airframe;
        let pressure_area = 0.5 * a.air_density * (speed * speed) * a.wing_area;
        let lift = a.lift_zero + a.lift_alpha * seen.angle_of_attack;
        let drag = a.drag_zero + a.drag_induced * (lift * lift);
        let (sin, cos) = libm::sincos(seen.angle_of_attack);
        let along = (seen.thrust * cos - pressure_area * drag) / a.mass / speed;
        let across = (seen.thrust * sin + pressure_area * lift) / a.mass / speed;
        let (x, z) = seen.velocity;
        (along * x - across * z, along * z + across * x - GRAVITY)
    }
}
