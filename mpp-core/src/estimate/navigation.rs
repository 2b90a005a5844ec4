//! Position and wind, from positions and velocities over ground.
//!
//! Two filters take each fix. The *quick* one assumes that the wind changes as much as it can. Its wind holds each gust,
//! and the watches of sensors and actuators need that. It also takes the noise of positions for gusts, and a plan
//! that starts with such a gust sets off by a wrong angle. The *smooth* one assumes a share of this change. Plans, the map and
//! the regulator use it (decision 34).

use super::History;
use super::history::MOST_AGE;
use super::wind_filter::{Observation, WindFilter};
use crate::config::TICK_PERIOD;
use crate::sense::Position;
use crate::tuning::navigation::{LEAST_SIGMA, RESTART_TIME, SETTLED_WIND, SMOOTH_SHARE};
use crate::vehicle::{AirState, Wind};

/// The quick filter's decision on a position, which holds for both.
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

/// The filters, and the history that they need for late positions.
#[derive(Clone, Debug)]
pub struct Navigation {
    /// Standard deviation of the change of the wind in one second that the quick filter assumes [m/s]. Without it both
    /// filters assume still air, and take each position as it is.
    wind_change: Option<f64>,
    /// The filter for the watches.
    quick: WindFilter,
    /// The filter for plans, the map and the regulator.
    smooth: WindFilter,
    history: History,
    /// Whether there was a position.
    started: bool,
    /// The last position to the last bit, and the ticks since it was measured.
    last: Option<([u64; 2], u32)>,
    /// Ticks since the last position that the filter used.
    unaided: u32,
}

impl Navigation {
    /// Filters that start at downrange 0 and an altitude \[m\] in still air.
    // Inlined, as all parts of a loop are, so that it is written where the loop will be.
    #[inline(always)]
    #[must_use]
    pub const fn new(wind_change: Option<f64>, altitude: f64) -> Self {
        Self {
            wind_change,
            quick: WindFilter::new(altitude),
            smooth: WindFilter::new(altitude),
            history: History::new(),
            started: false,
            last: None,
            unaided: 0,
        }
    }

    /// The filter for plans, the map and the regulator.
    #[must_use]
    pub fn smooth(&self) -> &WindFilter {
        &self.smooth
    }

    /// The filter for the watches of sensors and actuators.
    #[must_use]
    pub fn quick(&self) -> &WindFilter {
        &self.quick
    }

    /// Whether the wind is known well enough to tell the lift from it.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        self.started && self.quick.wind_variance() < SETTLED_WIND * SETTLED_WIND
    }

    /// The position `(x, z)` \[m\] and pitch \[rad\] at the tick that was `age` ticks ago.
    #[must_use]
    pub fn pose_at(&self, age: u32) -> Option<((f64, f64), f64)> {
        let way = self.history.way_since(age)?;
        let time = f64::from(age) * TICK_PERIOD;
        let (position, wind) = (self.smooth.position(), self.smooth.wind());
        let x = position.0 - way.0 - wind.x * time;
        let z = position.1 - way.1 - wind.z * time;
        Some(((x, z), self.history.pitch_at(age)?))
    }

    /// Moves the estimate on by a period \[s\], at the end of which the motion through the air is `air`.
    pub fn predict(&mut self, air: &AirState, period: f64) {
        let way = self.history.push(air, period);
        let noise = self.noise();
        self.quick.predict(way, period, noise.quick);
        self.smooth.predict(way, period, noise.smooth);
        self.unaided = self.unaided.saturating_add(1);
        if let Some((_, age)) = &mut self.last {
            *age = age.saturating_add(1);
        }
    }

    /// Doubts the position by this distance \[m\], because the time since the last step is not known.
    pub fn doubt(&mut self, distance: f64) {
        self.quick.doubt(distance);
        self.smooth.doubt(distance);
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
        for filter in [&mut self.quick, &mut self.smooth] {
            let wind = filter.wind();
            filter.set_wind(Wind {
                x: wind.x + then.0 - now.0,
                z: wind.z + then.1 - now.1,
            });
        }
        self.history.turn(by);
        self.history.correct(turned);
    }

    /// Replaces the estimate of the wind along the way [m/s].
    pub fn set_wind_along(&mut self, wind: f64) {
        for filter in [&mut self.quick, &mut self.smooth] {
            let z = filter.wind().z;
            filter.set_wind(Wind { x: wind, z });
        }
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
        if self.wind_change.is_none() {
            self.quick.set_position(now);
            self.smooth.set_position(now);
            self.unaided = 0;
            return PositionVerdict::Accepted;
        }
        let observed = Observation::position(now, delay, fix.sigma.max(LEAST_SIGMA));
        if !self.started {
            self.start(&observed);
            return PositionVerdict::Accepted;
        }
        if !self.correct(&observed) {
            if f64::from(self.unaided) * TICK_PERIOD < RESTART_TIME {
                return PositionVerdict::Gated;
            }
            self.start(&observed);
            return PositionVerdict::Restarted;
        }
        self.unaided = 0;
        self.take_velocity(fix, delay);
        PositionVerdict::Accepted
    }

    /// Takes in the velocity over ground of a fix that was measured `delay` \[s\] ago.
    fn take_velocity(&mut self, fix: &Position, delay: f64) {
        let (Some(velocity), Some(air)) = (fix.velocity, self.history.velocity_at(fix.age)) else {
            return;
        };
        let wind = (velocity.x - air.0, velocity.z - air.1);
        let observed = Observation::wind(wind, delay, velocity.sigma.max(LEAST_SIGMA));
        // A velocity that contradicts the positions is dropped; the positions alone carry the filters.
        self.correct(&observed);
    }

    /// Starts both filters from a position.
    fn start(&mut self, observed: &Observation) {
        self.quick.start(observed, self.noise().quick);
        self.smooth = self.quick;
        self.started = true;
        self.unaided = 0;
    }

    /// Corrects both filters. Returns false, and corrects nothing, if the quick one refuses the observation. If only the smooth
    /// one refuses it, the wind has changed by more than it assumes, and it goes on from the quick one.
    fn correct(&mut self, observed: &Observation) -> bool {
        let noise = self.noise();
        if !self.quick.correct(observed, noise.quick) {
            return false;
        }
        if !self.smooth.correct(observed, noise.smooth) {
            self.smooth = self.quick;
        }
        true
    }

    /// Variance of the change of the wind in one second that each filter assumes.
    fn noise(&self) -> Noise {
        let change = self.wind_change.unwrap_or(0.0);
        let quick = change * change;
        Noise {
            quick,
            smooth: SMOOTH_SHARE * SMOOTH_SHARE * quick,
        }
    }
}

/// Variances of the change of the wind in one second [(m/s)^2].
#[derive(Clone, Copy, Debug)]
struct Noise {
    quick: f64,
    smooth: f64,
}
