//! Trust in a sensor: when it is left out, and when it is used again.

use crate::tuning::sensors::{EXCLUDED_AFTER, RECOVERED_AFTER, SUSPECTED_AFTER};

/// The trust in a sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trust {
    /// The sensor delivers good values.
    #[default]
    Healthy,
    /// The last good value is some ticks old. A good value is used at once.
    Suspected,
    /// The sensor has not delivered a good value for longer. Its values are not used.
    Excluded,
    /// The sensor delivers good values again, but not for long enough. Its values are not used.
    Recovering,
}

impl Trust {
    /// At most suspected.
    #[must_use]
    pub fn doubted(self) -> Self {
        match self {
            Self::Healthy => Self::Suspected,
            other => other,
        }
    }
}

/// The trust in each sensor of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sensors {
    /// Airspeed.
    pub airspeed: Trust,
    /// Pitch.
    pub pitch: Trust,
    /// Positions.
    pub position: Trust,
    /// The elevator. It is no sensor, but [`ElevatorEffect`](super::ElevatorEffect) watches it.
    pub elevator: Trust,
    /// The motor. It is no sensor, but [`MotorWatch`](super::MotorWatch) watches it.
    pub motor: Trust,
}

/// The monitor of one sensor.
#[derive(Clone, Copy, Debug)]
pub struct SensorMonitor {
    trust: Trust,
    /// Ticks since the last good value.
    silent: u16,
    /// While the sensor recovers, ticks since its first good value.
    recovering: u16,
    /// Greatest time between two good values of a healthy sensor \[ticks\].
    period: u16,
}

impl SensorMonitor {
    /// The monitor of a sensor that may deliver a good value every `period` ticks.
    #[must_use]
    pub const fn new(period: u16) -> Self {
        Self {
            trust: Trust::Healthy,
            silent: 0,
            recovering: 0,
            period,
        }
    }

    /// The present trust.
    #[must_use]
    pub fn trust(&self) -> Trust {
        self.trust
    }

    /// Whether the sensor's values may be used.
    #[must_use]
    pub fn uses(&self) -> bool {
        matches!(self.trust, Trust::Healthy | Trust::Suspected)
    }

    /// Excludes the sensor at once, because something else has shown that it is wrong.
    pub fn exclude(&mut self) {
        (self.trust, self.recovering) = (Trust::Excluded, 0);
    }

    /// Takes note of one tick: whether the sensor delivered a good value (`Some(true)`), a bad one
    /// (`Some(false)`) or nothing.
    pub fn tick(&mut self, good: Option<bool>) {
        let fresh = good == Some(true);
        self.silent = if fresh {
            0
        } else {
            self.silent.saturating_add(1)
        };
        let late = self.silent.saturating_sub(self.period);
        self.recovering = match self.trust {
            Trust::Recovering => self.recovering.saturating_add(1),
            _ => 0,
        };
        self.trust = match self.trust {
            Trust::Healthy | Trust::Suspected if fresh => Trust::Healthy,
            Trust::Healthy | Trust::Suspected if late >= EXCLUDED_AFTER => Trust::Excluded,
            Trust::Healthy if late >= SUSPECTED_AFTER => Trust::Suspected,
            Trust::Excluded if fresh => Trust::Recovering,
            Trust::Recovering if good == Some(false) || late >= SUSPECTED_AFTER => Trust::Excluded,
            Trust::Recovering if fresh && self.recovering >= RECOVERED_AFTER => Trust::Healthy,
            trust => trust,
        };
    }
}
