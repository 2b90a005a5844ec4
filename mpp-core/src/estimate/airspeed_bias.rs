//! Slow error of the airspeed, seen as a wind along the way and as missing lift at once.
//!
//! The filter believes its airspeed sensor. If the sensor reads too much by `e`, the estimated wind along the way falls by
//! `e`, and the wing seems to give less lift than the dynamic pressure promises: the lift coefficient seems to change by
//! `-2 e / V` of itself. Wind alone changes only the wind, an error of the airframe changes only the lift, and a gust changes
//! both, but at different times. So wind and lift must show an error together, for some time. An error that is there from
//! the start changes neither. Then wind and lift are both farther from calm air and from the known airframe than they can
//! be.

use crate::tuning::airspeed_bias::{
    AGREES, AGREES_FOR, FOUND_BY_LIFT, FOUND_BY_LIFT_AT_START, FOUND_BY_WIND, FOUND_FOR, MEMORY,
    MOST_LIFT, OFF_TIME, SETTLED,
};

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
    /// Time for which wind and lift have both shown an error \[s\].
    beyond: f64,
    found: bool,
    /// Mean difference of the sensor from the estimate, as a share of the airspeed [-], and the time for which it was small
    /// \[s\].
    off: f64,
    agrees: f64,
}

/// The estimates as they were before the error, as far as the watch knows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Before {
    /// Wind along the way [m/s].
    pub wind: f64,
    /// Offset of the lift coefficient [-].
    pub lift: f64,
}

impl AirspeedBias {
    /// A watch without observations, for an aircraft with this lift coefficient in level flight [-].
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
    /// airspeed [m/s], after a further `period` \[s\]. Gives the estimates before the error if it has just been found.
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
        let mean = Before {
            wind: self.wind,
            lift: self.lift,
        };
        // No airframe is known so badly, so the airspeed was wrong from the start.
        let calm = Before::default();
        let from_start = self.agree(calm, wind, lift, airspeed, FOUND_BY_LIFT_AT_START);
        let agree = from_start || self.agree(mean, wind, lift, airspeed, FOUND_BY_LIFT);
        self.beyond = if agree { self.beyond + period } else { 0.0 };
        if self.beyond >= FOUND_FOR {
            self.set_found();
            return Some(if from_start { calm } else { mean });
        }
        let share = period / MEMORY;
        self.wind += share * (wind - self.wind);
        self.lift += share * (lift - self.lift);
        None
    }

    /// Whether wind and lift have both moved from these estimates as an error of the airspeed moves them. `by_lift` is
    /// the least such error by the lift, as a share of the airspeed [-].
    fn agree(&self, before: Before, wind: f64, lift: f64, airspeed: f64, by_lift: f64) -> bool {
        let wind = (before.wind - wind) / airspeed / FOUND_BY_WIND;
        let lift = (before.lift - lift) / (2.0 * self.level_lift) / by_lift;
        (wind > 1.0 && lift > 1.0) || (wind < -1.0 && lift < -1.0)
    }

    /// Takes the airspeed for wrong, because something else has shown it.
    pub fn set_found(&mut self) {
        (self.found, self.off, self.agrees) = (true, 2.0 * AGREES, 0.0);
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

    /// Whether the airspeed is wrong or may be.
    #[must_use]
    pub fn suspected(&self) -> bool {
        self.found || self.beyond > 0.0
    }

    /// Whether the airspeed is wrong.
    #[must_use]
    pub fn found(&self) -> bool {
        self.found
    }
}
