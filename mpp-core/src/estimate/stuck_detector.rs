//! Detection of values that a sensor repeats, and of refused values that show a steady turn.

use super::MeasurementStatus;
use crate::tuning::sensors::{BELIEVED_AFTER, FROZEN_TICKS, MOST_TURN};

/// Detects that a sensor repeats one measured value.
#[derive(Clone, Copy, Debug)]
pub struct StuckDetector {
    last: f64,
    repeats: u8,
}

impl StuckDetector {
    /// A detector that has seen no value.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            last: f64::NAN,
            repeats: 0,
        }
    }

    /// Takes the value of a tick. Gives NaN, a missing value, once the sensor has repeated it to the last bit
    /// in [`FROZEN_TICKS`] ticks; the first other value is given again.
    pub fn take(&mut self, value: f64) -> f64 {
        if value.is_finite() && value.to_bits() == self.last.to_bits() {
            self.repeats = self.repeats.saturating_add(1);
        } else {
            self.repeats = 0;
        }
        self.last = value;
        if self.repeats >= FROZEN_TICKS {
            f64::NAN
        } else {
            value
        }
    }

    /// Whether the value is frozen.
    #[must_use]
    pub fn frozen(&self) -> bool {
        self.repeats >= FROZEN_TICKS
    }
}

/// Detects a steady turn in values that the filter refuses. An aircraft that does not turn as its model gives such
/// values: the first of them follows steadily on one that the filter used. A sensor that jumps does not.
#[derive(Clone, Copy, Debug, Default)]
pub struct SteadyTurn {
    last: Option<f64>,
    /// Values refused in a row, each within a turn of the one before; `None` after a jump.
    refused: Option<u8>,
}

impl SteadyTurn {
    /// Takes the pitch of a tick \[rad\] and the filter's verdict on it. Gives true once the filter has refused
    /// [`BELIEVED_AFTER`] values in a row that change steadily: the filter is wrong then.
    pub fn take(&mut self, pitch: f64, verdict: MeasurementStatus) -> bool {
        let before = self.last.replace(pitch);
        let is_steady = before.is_none_or(|before| libm::fabs(pitch - before) < MOST_TURN);
        self.refused = match verdict {
            MeasurementStatus::Gated if is_steady && before.is_none() => Some(1),
            MeasurementStatus::Gated if is_steady => self.refused.map(|it| it.saturating_add(1)),
            MeasurementStatus::Gated => None,
            _ => Some(0),
        };
        self.refused
            .is_some_and(|refused| refused >= BELIEVED_AFTER)
    }
}
