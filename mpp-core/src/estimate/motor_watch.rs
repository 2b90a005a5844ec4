//! The watch of the motor, by the speed that the sensors find and the thrust does not explain.
//!
//! Without thrust the aircraft does not gain the speed that its model expects of the command. Two signs must show it.
//! Airspeed and estimated wind together show it soon, but a gust moves the airspeed before the wind. The positions show it
//! without gusts, but late. The first sign must also exceed its usual value.

use super::Trust;
use crate::tuning::motor::{
    BY_AIRSPEED, BY_POSITION, FADE, FOLLOWS, LEAST_GIVEN, MOST_AHEAD, QUIET, SETTLED, SHOWN_FOR,
    SIGMAS, USUAL,
};
use crate::units::REFERENCE_CRUISE;

/// The estimates of a tick about the speed along the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Position downrange \[m\].
    pub x: f64,
    /// Velocity through the air along the way [m/s].
    pub air: f64,
    /// Correction of this velocity by the sensors since the last tick [m/s].
    pub corrected: f64,
    /// Wind along the way [m/s].
    pub wind: f64,
}

/// The watch of the motor, which has its full effect or none.
#[derive(Clone, Copy, Debug)]
pub struct MotorWatch {
    /// Unit of the times of this watch \[s\]: a faster aircraft gains and loses speed more slowly.
    unit: f64,
    /// Mass \[kg\].
    mass: f64,
    /// Least gain of speed that the comparison assumes [m/s].
    least: f64,
    last: Option<Progress>,
    /// Dead reckoned position \[m\] and velocity over ground [m/s], by the model and the positions alone.
    dead_reckoned: (f64, f64),
    /// Gain of speed that the command should give [m/s]. It fades.
    given: f64,
    /// Gains beyond that of the model, by airspeed and wind and by the positions [m/s]. They fade.
    by_airspeed: f64,
    by_position: f64,
    /// Usual mean square of the gain by airspeed [(m/s)^2].
    usual: f64,
    /// Time of the watch, and time for which both signs have said that the motor stopped or works again, in own units.
    seen: f64,
    shown: f64,
    lost: bool,
}

impl MotorWatch {
    /// A motor that works, of an aircraft with this mass \[kg\], with this thrust \[N\] and airspeed [m/s] in level flight.
    #[must_use]
    pub fn new(mass: f64, level: f64, cruise: f64) -> Self {
        let unit = cruise / REFERENCE_CRUISE;
        Self {
            unit,
            mass,
            least: LEAST_GIVEN * level / mass * FADE * unit,
            last: None,
            dead_reckoned: (0.0, 0.0),
            given: 0.0,
            by_airspeed: 0.0,
            by_position: 0.0,
            usual: QUIET * QUIET * unit * unit,
            seen: 0.0,
            shown: 0.0,
            lost: false,
        }
    }

    /// Whether the motor gives no thrust.
    #[must_use]
    pub fn lost(&self) -> bool {
        self.lost
    }

    /// The trust in the motor: excluded while it gives no thrust.
    #[must_use]
    pub fn trust(&self) -> Trust {
        match self.lost {
            true => Trust::Excluded,
            false => Trust::Healthy,
        }
    }

    /// Restarts at the next tick, because the estimates have jumped or cannot be judged. The verdict stays meanwhile.
    pub fn interrupt(&mut self) {
        self.last = None;
        (self.given, self.by_airspeed, self.by_position) = (0.0, 0.0, 0.0);
        (self.seen, self.shown) = (0.0, 0.0);
    }

    /// Takes in the estimates of a tick, a `period` \[s\] after the last one, in which the motor was to give a thrust
    /// \[N\].
    pub fn update(&mut self, now: &Progress, thrust: f64, period: f64) {
        let inputs = [now.x, now.air, now.corrected, now.wind, thrust, period];
        if !(inputs.iter().all(|input| input.is_finite()) && period > 0.0) {
            return;
        }
        let Some(last) = self.last.replace(*now) else {
            self.dead_reckoned = (now.x, now.air + now.wind);
            return;
        };
        let rate = FOLLOWS / self.unit;
        // After a gap the position is caught up with at once, and no further.
        let follows = (rate * period).min(0.5);
        let speed = self.dead_reckoned.1 + now.air - last.air - now.corrected;
        let x = self.dead_reckoned.0 + speed * period;
        let ahead = now.x - x;
        // After lost steps the first position corrects the place, not the speed.
        if libm::fabs(ahead) > MOST_AHEAD * self.unit * self.unit {
            return self.interrupt();
        }
        let pull = rate * follows * ahead;
        self.dead_reckoned = (x + 2.0 * follows * ahead, speed + pull);

        let own = period / self.unit;
        let kept = (1.0 - own / FADE).max(0.0);
        self.given = kept * self.given + thrust / self.mass * period;
        self.by_position = kept * self.by_position + pull;
        let found = now.corrected + now.wind - last.wind;
        self.by_airspeed = kept * self.by_airspeed + found;
        self.seen += own;
        self.judge(own);
    }

    /// Changes the verdict if both signs have contradicted it for long enough. The period is in own units.
    fn judge(&mut self, period: f64) {
        // A lost motor lacks the gain that the command should give; one that works again gives what the model lacks.
        let expected = self.given.max(self.least);
        let signed = if self.lost { expected } else { -expected };
        let airspeed = self.by_airspeed / signed;
        let position = self.by_position / signed;
        let square = self.by_airspeed * self.by_airspeed;
        let suspicious = airspeed > 0.5 * BY_AIRSPEED && position > 0.5 * BY_POSITION;
        if !(self.lost || suspicious) {
            self.usual += (square - self.usual) * (period / USUAL).min(1.0);
        }
        let says = expected > 0.0
            && airspeed > BY_AIRSPEED
            && position > BY_POSITION
            && square > SIGMAS * SIGMAS * self.usual
            && self.seen > SETTLED;
        self.shown = if says { self.shown + period } else { 0.0 };
        if self.shown > SHOWN_FOR {
            self.lost = !self.lost;
            (self.by_airspeed, self.by_position, self.shown) = (0.0, 0.0, 0.0);
        }
    }
}
