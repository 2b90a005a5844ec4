//! Kalman filter on position and wind, from positions and velocities over ground.
//!
//! The model of an axis: `p' = a + w` and `w' = noise`, with the position `p`, the estimated velocity
//! through the air `a` as the known input, and the wind `w`. An error of the estimated velocity also counts
//! as wind. Plans move with the sum of wind and velocity through the air, and this sum is then right. Both
//! axes have the same errors, so one covariance serves both. Source: Bar-Shalom, Li and Kirubarajan,
//! "Estimation with Applications to Tracking and Navigation", 6.2 (white noise acceleration).

use super::History;
use super::history::MOST_AGE;
use crate::config::TICK_PERIOD;
use crate::sense::Position;
use crate::tuning::navigation::{
    FIRST_WIND, GATE, LEAST_SIGMA, MOST_WIND, RESTART_TIME, SETTLED_WIND,
};
use crate::vehicle::{AirState, Wind};

/// The filter's decision on a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PositionVerdict {
    /// The filter used the position.
    Accepted,
    /// A value is not a finite number, or a declared error is negative. The filter did not use it.
    NotFinite,
    /// The position repeats the last one to the last bit. The filter did not use it.
    Held,
    /// The position is older than the history, or not older than the last one. The filter did not use it.
    Late,
    /// The innovation exceeds the gate. The filter did not use it.
    Gated,
    /// The filter started anew from this position, because it had refused all others for
    /// [`RESTART_TIME`].
    Restarted,
}

/// Covariance of position and wind of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Covariance {
    /// Variance of the position [m^2].
    position: f64,
    /// Covariance of position and wind [m^2/s].
    both: f64,
    /// Variance of the wind [(m/s)^2].
    wind: f64,
}

/// The scalar measurement `h0 p + h1 w` of one axis.
#[derive(Clone, Copy, Debug)]
struct Observation {
    h: [f64; 2],
    /// Variance of its error.
    variance: f64,
}

/// The filter, and the history that it needs for late positions.
#[derive(Clone, Debug)]
pub struct Navigation {
    /// Standard deviation of the change of the wind in one second [m/s]. Without it the filter assumes still
    /// air, and takes each position as it is.
    wind_change: Option<f64>,
    position: (f64, f64),
    wind: Wind,
    covariance: Covariance,
    history: History,
    /// Whether there was a position.
    started: bool,
    /// The last position to the last bit, and the ticks since it was measured.
    last: Option<([u64; 2], u32)>,
    /// Ticks since the last position that the filter used.
    unaided: u32,
    /// Square of the last innovation over its variance, mean of both axes [-].
    innovation: f64,
}

impl Navigation {
    /// A filter that starts at downrange 0 and an altitude \[m\] in still air.
    // Inlined, as all parts of a loop are, so that it is written where the loop will be.
    #[inline(always)]
    #[must_use]
    pub const fn new(wind_change: Option<f64>, altitude: f64) -> Self {
        Self {
            wind_change,
            position: (0.0, altitude),
            wind: Wind::STILL,
            covariance: Covariance {
                position: 0.0,
                both: 0.0,
                wind: FIRST_WIND * FIRST_WIND,
            },
            history: History::new(),
            started: false,
            last: None,
            unaided: 0,
            innovation: 0.0,
        }
    }

    /// Standard deviation of the change of the wind in one second [m/s], if the filter estimates wind.
    #[must_use]
    pub fn wind_change(&self) -> Option<f64> {
        self.wind_change
    }

    /// Sets this standard deviation.
    pub fn set_wind_change(&mut self, wind_change: Option<f64>) {
        self.wind_change = wind_change;
    }

    /// The estimated position `(x, z)` \[m\].
    #[must_use]
    pub fn position(&self) -> (f64, f64) {
        self.position
    }

    /// The estimated wind.
    #[must_use]
    pub fn wind(&self) -> Wind {
        self.wind
    }

    /// Whether the wind is known well enough to tell the lift from it.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        self.started && self.covariance.wind < SETTLED_WIND * SETTLED_WIND
    }

    /// Square of the last innovation over its variance, mean of both axes [-]. It is 1 in the mean for errors
    /// as declared.
    #[must_use]
    pub fn normalised_innovation(&self) -> f64 {
        self.innovation
    }

    /// The position `(x, z)` \[m\] and pitch \[rad\] at the tick that was `age` ticks ago.
    #[must_use]
    pub fn pose_at(&self, age: u32) -> Option<((f64, f64), f64)> {
        let way = self.history.way_since(age)?;
        let time = f64::from(age) * TICK_PERIOD;
        let x = self.position.0 - way.0 - self.wind.x * time;
        let z = self.position.1 - way.1 - self.wind.z * time;
        Some(((x, z), self.history.pitch_at(age)?))
    }

    /// Moves the estimate on by a period \[s\], at the end of which the motion through the air is `air`.
    pub fn predict(&mut self, air: &AirState, period: f64) {
        let way = self.history.push(air, period);
        self.position.0 += way.0 + self.wind.x * period;
        self.position.1 += way.1 + self.wind.z * period;
        self.unaided = self.unaided.saturating_add(1);
        if let Some((_, age)) = &mut self.last {
            *age = age.saturating_add(1);
        }
        let change = self.wind_change.unwrap_or(0.0);
        let noise = change * change;
        let c = &mut self.covariance;
        let square = period * period;
        c.position += 2.0 * period * c.both + square * c.wind + noise * square * period / 3.0;
        c.both += period * c.wind + 0.5 * noise * square;
        c.wind += noise * period;
    }

    /// Doubts the position by this distance \[m\], because the time since the last step is not known.
    pub fn doubt(&mut self, distance: f64) {
        self.covariance.position += distance * distance;
    }

    /// Takes over a motion through the air that was turned by a known error of the pitch \[rad\]. The velocity over
    /// ground stays, so the wind changes by the difference.
    pub fn turn(&mut self, by: f64, turned: &AirState) {
        let before = AirState {
            flight_path: turned.flight_path - by,
            ..*turned
        };
        let (now, then) = (
            Wind::STILL.ground_velocity(turned),
            Wind::STILL.ground_velocity(&before),
        );
        self.wind.x += then.0 - now.0;
        self.wind.z += then.1 - now.1;
        self.history.turn(by);
        self.history.correct(turned);
    }

    /// Replaces the estimate of the wind along the way [m/s].
    pub fn set_wind_along(&mut self, wind: f64) {
        self.wind.x = wind;
    }

    /// Takes in the motion through the air as it is after the sensors of this tick. Gives its velocity, `(x, z)` [m/s].
    pub fn correct_motion(&mut self, air: &AirState) -> (f64, f64) {
        self.history.correct(air)
    }

    /// Takes in a position and, if it has one, its velocity.
    pub fn take(&mut self, fix: &Position) -> PositionVerdict {
        if !fix.is_sound() {
            return PositionVerdict::NotFinite;
        }
        let bits = [fix.x.to_bits(), fix.z.to_bits()];
        if self.last.is_some_and(|(last, _)| last == bits) {
            return PositionVerdict::Held;
        }
        let newer = self.last.is_none_or(|(_, age)| fix.age < age);
        let (true, true, Some(way)) = (newer, fix.age <= MOST_AGE, self.history.way_since(fix.age))
        else {
            return PositionVerdict::Late;
        };
        self.last = Some((bits, fix.age));
        let delay = f64::from(fix.age) * TICK_PERIOD;
        let now = (fix.x + way.0, fix.z + way.1);
        let Some(change) = self.wind_change else {
            self.position = now;
            self.unaided = 0;
            return PositionVerdict::Accepted;
        };
        let sigma = fix.sigma.max(LEAST_SIGMA);
        // The wind has changed since the measurement.
        let noise = change * change;
        let observation = Observation {
            h: [1.0, -delay],
            variance: sigma * sigma + noise * delay * delay * delay / 3.0,
        };
        if !self.started {
            self.start(now, &observation);
            return PositionVerdict::Accepted;
        }
        let off = (
            now.0 - (self.position.0 - self.wind.x * delay),
            now.1 - (self.position.1 - self.wind.z * delay),
        );
        if !self.correct(&observation, off) {
            if f64::from(self.unaided) * TICK_PERIOD < RESTART_TIME {
                return PositionVerdict::Gated;
            }
            self.start(now, &observation);
            return PositionVerdict::Restarted;
        }
        self.unaided = 0;
        self.take_velocity(fix, noise * delay);
        PositionVerdict::Accepted
    }

    /// Takes in the velocity over ground of a fix. `since` is the variance by which the wind has changed since
    /// [(m/s)^2].
    fn take_velocity(&mut self, fix: &Position, since: f64) {
        let (Some(velocity), Some(air)) = (fix.velocity, self.history.velocity_at(fix.age)) else {
            return;
        };
        let sigma = velocity.sigma.max(LEAST_SIGMA);
        let observation = Observation {
            h: [0.0, 1.0],
            variance: sigma * sigma + since,
        };
        let off = (
            velocity.x - air.0 - self.wind.x,
            velocity.z - air.1 - self.wind.z,
        );
        // A velocity that contradicts the positions is dropped; the positions alone carry the filter.
        self.correct(&observation, off);
    }

    /// Starts from a position that the way through the air has brought up to now.
    fn start(&mut self, now: (f64, f64), observation: &Observation) {
        let delay = -observation.h[1];
        self.position = (now.0 + self.wind.x * delay, now.1 + self.wind.z * delay);
        let wind = FIRST_WIND * FIRST_WIND;
        self.covariance = Covariance {
            position: observation.variance + delay * delay * wind,
            both: delay * wind,
            wind,
        };
        self.started = true;
        self.unaided = 0;
    }

    /// Corrects both axes by innovations. Returns false, and corrects nothing, if one is beyond the gate.
    fn correct(&mut self, observation: &Observation, off: (f64, f64)) -> bool {
        let [h0, h1] = observation.h;
        let c = &mut self.covariance;
        let position = c.position * h0 + c.both * h1;
        let wind = c.both * h0 + c.wind * h1;
        let variance = h0 * position + h1 * wind + observation.variance;
        let most = GATE * GATE * variance;
        let (x, z) = (off.0 * off.0, off.1 * off.1);
        // The tests are false for values that are not numbers.
        if !(x <= most && z <= most && variance > 0.0) {
            return false;
        }
        self.innovation = 0.5 * (x + z) / variance;
        let gain = (position / variance, wind / variance);
        self.position.0 += gain.0 * off.0;
        self.position.1 += gain.0 * off.1;
        self.wind.x = (self.wind.x + gain.1 * off.0).clamp(-MOST_WIND, MOST_WIND);
        self.wind.z = (self.wind.z + gain.1 * off.1).clamp(-MOST_WIND, MOST_WIND);
        c.position -= gain.0 * position;
        c.both -= gain.0 * wind;
        c.wind -= gain.1 * wind;
        true
    }
}
