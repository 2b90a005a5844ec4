//! An aircraft behind an autopilot that holds a commanded pitch. The elevator of such an aircraft is the commanded angle of attack,
//! and its moments are those of the closed pitch loop.
//!
//! The loop is `theta'' = -w^2 (theta - command) - 2 zeta w theta'`. With the command `delta + gamma` and the angle of attack
//! `alpha = theta - gamma` that is `theta'' = -w^2 (alpha - delta) - 2 zeta w theta'`, which are moments.

use serde::Deserialize;

/// A number that the text does not have.
pub(super) fn absent() -> f64 {
    f64::NEG_INFINITY
}

/// The closed pitch loop of the autopilot.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PitchLoop {
    /// Natural frequency [rad/s].
    pub frequency: f64,
    /// Damping ratio [-].
    pub damping: f64,
    /// Dead time \[s\].
    pub delay: Option<f64>,
    /// Least commanded angle of attack \[rad\].
    pub min: Option<f64>,
    /// Greatest commanded angle of attack \[rad\].
    pub max: Option<f64>,
}

impl PitchLoop {
    /// What is wrong with it, and what to give.
    pub(super) fn doubt(&self) -> Option<&'static str> {
        if !(0.5..=60.0).contains(&self.frequency) {
            return Some("`pitch_loop.frequency`: give 0.5 to 60 rad/s");
        }
        (!(0.05..=5.0).contains(&self.damping)).then_some("`pitch_loop.damping`: give 0.05 to 5")
    }
}
