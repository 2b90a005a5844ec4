//! Slow error of the airspeed, seen as a wind along the way and as missing lift at once.
//!
//! The filter believes its airspeed sensor. A sensor that reads too much by `e` therefore makes the air move along with
//! the aircraft by `e` less, and the wing give less lift than the dynamic pressure promises: the lift coefficient seems to
//! change by `-2 e / V` of itself. Wind alone changes the one, an error of the airframe the other, and gusts change
//! both but not together. So an error is the lesser of the two, if both say so for some time.

use crate::tuning::airspeed_bias::{
    AGREES, AGREES_FOR, FOUND_BY_LIFT, FOUND_BY_WIND, FOUND_FOR, MEMORY, OFF_TIME, SETTLED,
};
use crate::tuning::motor::MOST_LIFT;

/// Watches the estimated wind along the way and lift for an error of the airspeed.
#[derive(Clone, Copy, Debug)]
pub struct AirspeedBias {
    /// Lift coefficient of level flight [-].
    level_lift: f64,
    /// Time over which wind and lift were seen \[s\].
    seen: f64,
    /// Slow means of the wind [m/s] and of the lift coefficient's offset [-].
    wind: f64,
    lift: f64,
    /// Time for which both have said so \[s\].
    beyond: f64,
    found: bool,
    /// Mean difference of the sensor from the estimate, as a share of the airspeed [-], and the time for which it was small
    /// \[s\].
    off: f64,
    agrees: f64,
}

/// The estimates as they were before the error, as far as the watch knows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Before {
    /// Wind along the way [m/s].
    pub wind: f64,
    /// Offset of the lift coefficient [-].
    pub lift: f64,
}

impl AirspeedBias {
    /// A watch that has seen nothing, for an aircraft with this lift coefficient in level flight [-].
    #[must_use]
    pub const fn new(level_lift: f64) -> Self {
        Self {
            level_lift,
            seen: 0.0,
            wind: 0.0,
            lift: 0.0,
            beyond: 0.0,
            found: false,
            off: 0.0,
            agrees: 0.0,
        }
    }

    /// Takes in the estimated wind along the way [m/s] and the offset of the lift coefficient [-] at an estimated
    /// airspeed [m/s], after a further `period` \[s\]. Gives the estimates of before if an error has just been found.
    pub fn update(&mut self, wind: f64, lift: f64, airspeed: f64, period: f64) -> Option<Before> {
        let sound = wind.is_finite() && lift.is_finite() && airspeed > 1.0 && period > 0.0;
        if !sound || self.found {
            return None;
        }
        self.seen += period;
        if self.seen < SETTLED {
            (self.wind, self.lift) = (wind, lift);
            return None;
        }
        let by_wind = (self.wind - wind) / airspeed;
        let by_lift = (self.lift - lift) / (2.0 * self.level_lift);
        let too_much = by_wind > FOUND_BY_WIND && by_lift > FOUND_BY_LIFT;
        let too_little = by_wind < -FOUND_BY_WIND && by_lift < -FOUND_BY_LIFT;
        let agree = too_much || too_little;
        self.beyond = if agree { self.beyond + period } else { 0.0 };
        if self.beyond >= FOUND_FOR {
            (self.found, self.off, self.agrees) = (true, 2.0 * AGREES, 0.0);
            return Some(Before {
                wind: self.wind,
                lift: self.lift,
            });
        }
        let share = period / MEMORY;
        self.wind += share * (wind - self.wind);
        self.lift += share * (lift - self.lift);
        None
    }

    /// Compares the sensor with the estimate [m/s] after a further `period` \[s\], while it is not believed. The sensor is
    /// believed again after it has agreed for [`AGREES_FOR`].
    pub fn compare(&mut self, measured: f64, airspeed: f64, period: f64) {
        if !(self.found && measured.is_finite() && airspeed > 1.0 && period > 0.0) {
            return;
        }
        let share = (period / OFF_TIME).min(1.0);
        self.off += share * ((measured - airspeed) / airspeed - self.off);
        let small = libm::fabs(self.off) < AGREES;
        self.agrees = if small { self.agrees + period } else { 0.0 };
        if self.agrees >= AGREES_FOR {
            *self = Self::new(self.level_lift);
        }
    }

    /// Whether the airspeed is right, so that the model knows the drag. An airspeed that was wrong from the start shows in the
    /// offset of the lift coefficient alone.
    #[must_use]
    pub fn is_right(&self, lift: f64) -> bool {
        !self.found && libm::fabs(lift) < MOST_LIFT * self.level_lift
    }

    /// Whether the airspeed is wrong.
    #[must_use]
    pub fn found(&self) -> bool {
        self.found
    }
}
