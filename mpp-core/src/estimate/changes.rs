//! Values that a sensor repeats.

use crate::tuning::sensors::FROZEN_TICKS;

/// Watches one measured value for repetitions.
#[derive(Clone, Copy, Debug)]
pub struct Changes {
    last: f64,
    repeats: u8,
}

impl Changes {
    /// A watch that has seen no value.
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

impl Default for Changes {
    fn default() -> Self {
        Self::new()
    }
}
