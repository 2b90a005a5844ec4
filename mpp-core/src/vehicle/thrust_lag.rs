//! The lag of the thrust over the stages of a plan. The thrust follows a command at the start of a stage with
//! a lag, and the plan must know how fast the aircraft really is.

use super::ActuatorLimits;

/// First-order lag of the thrust in a time that is divided into stages of equal length.
///
/// With the time constant `tau`, the stage's length `T` and the command `c`, a thrust that starts at `g` is
/// `c + (g - c) exp(-t / tau)`. It ends the stage with the share `exp(-T / tau)` of its distance from the command,
/// and its mean over the stage has the share `tau / T (1 - exp(-T / tau))`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrustLag {
    /// Length of a stage in time constants [-]; infinite without a lag.
    stage: f64,
    /// Share of the distance from the command at the end of a stage [-].
    at_end: f64,
    /// Share of the distance from the command in the mean over a stage [-].
    in_mean: f64,
}

impl ThrustLag {
    /// A thrust that follows its command at once.
    pub const NONE: Self = Self {
        stage: f64::INFINITY,
        at_end: 0.0,
        in_mean: 0.0,
    };

    /// Its numbers, in the order of the fields.
    pub(crate) fn numbers(&self) -> [f64; 3] {
        [self.stage, self.at_end, self.in_mean]
    }

    /// The lag of these actuators over stages of the length `period`, in the unit of time of the actuators.
    #[must_use]
    pub fn new(actuators: &ActuatorLimits, period: f64) -> Self {
        actuators.thrust_lag.map_or(Self::NONE, |lag| {
            let stage = period / lag;
            let at_end = libm::exp(-stage);
            Self {
                stage,
                at_end,
                in_mean: (1.0 - at_end) / stage,
            }
        })
    }

    /// The thrust at the end of a stage that starts with the thrust `given`.
    #[must_use]
    pub fn end(&self, given: f64, command: f64) -> f64 {
        command + self.at_end * (given - command)
    }

    /// The mean thrust of a stage that starts with the thrust `given`.
    #[must_use]
    pub fn mean(&self, given: f64, command: f64) -> f64 {
        command + self.in_mean * (given - command)
    }

    /// The thrust at a share of a stage that has this mean thrust.
    #[must_use]
    pub fn within(&self, share: f64, mean: f64, command: f64) -> f64 {
        if self.in_mean > 0.0 {
            command + libm::exp(-share * self.stage) / self.in_mean * (mean - command)
        } else {
            command
        }
    }
}
