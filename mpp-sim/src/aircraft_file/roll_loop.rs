//! An aircraft behind an autopilot that holds a commanded bank, beside its pitch loop. The aileron of such an aircraft is the
//! commanded bank, and its lateral table is that of the closed loop.
//!
//! The loop turns the bank that is missing into a roll rate, `p_c = w / (2 zeta) (command - bank)`, at most `max_rate`, and the
//! roll rate follows with `p' = 2 zeta w (p_c - p)`. With the missing bank, at most `2 zeta / w max_rate`, as a deflection that
//! is a rolling moment and a damping. The autopilot coordinates its turns: the deflection of the rudder is the yaw rate of the
//! turn, and a yaw loop of the same frequency follows it.

use serde::{Deserialize, Serialize};

/// The closed roll loop of the autopilot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RollLoop {
    /// Span of the wing \[m\].
    pub span: f64,
    /// Natural frequency [rad/s].
    pub frequency: f64,
    /// Damping ratio [-].
    pub damping: f64,
    /// Dead time \[s\].
    #[serde(default)]
    pub delay: f64,
    /// Greatest bank \[rad\].
    pub max_bank: f64,
    /// Greatest roll rate [rad/s].
    pub max_rate: f64,
}

impl RollLoop {
    /// Greatest missing bank that the loop answers \[rad\]: more rolls no faster.
    #[must_use]
    pub fn most_missing(&self) -> f64 {
        2.0 * self.damping / self.frequency * self.max_rate
    }
}
