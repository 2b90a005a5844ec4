//! The nose of a wing without a rudder that does not turn into the wind by itself.
//!
//! Whatever holds the bank of such a wing, its nose runs away from the flow: with the ailerons that give a wanted bank `phi` a
//! sum of sideslip and yaw rate grows, `eta' = growth eta + by_bank phi`. It is the zero of the aileron's effect on the bank, in
//! the right half plane. No surface stops it, but a bank to the other side does: so plans have to.

use super::LateralLinearization;
use crate::config::STAGE_PERIOD;

/// Greatest runaway that counts \[rad\]: that of a sideslip at which no equation holds.
const MOST: f64 = 3.0;

/// The runaway of a nose, about level flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nose {
    /// The runaway of a radian of sideslip is 1: that of roll rate and yaw rate \[s\], and of the bank [-].
    by: [f64; 3],
    /// Growth of the runaway over a stage [-], and its change in a stage by a radian of the bank [-].
    stage: [f64; 2],
    /// Aileron per radian of sideslip, and per rad/s of roll rate and yaw rate, that leaves no rolling moment [-, s].
    pub(crate) aileron: [f64; 3],
}

impl Nose {
    /// The nose of an aircraft without a rudder; `None` if it does not run away.
    #[must_use]
    pub fn of(linear: &LateralLinearization) -> Option<Self> {
        let (a, b) = (&linear.a, &linear.b);
        // The ailerons that hold the roll rate turn the nose with them.
        let turn = b.m31 / b.m21;
        let [slip, roll, yaw] =
            [(a.m31, a.m21), (a.m32, a.m22), (a.m33, a.m23)].map(|(of, other)| of - turn * other);
        let half = 0.5 * (a.m11 + yaw);
        let growth = half + libm::sqrt(half * half - a.m11 * yaw + a.m13 * slip);
        let runs = slip < 0.0 && growth > 0.0;
        if !runs {
            return None;
        }
        let share = (growth - a.m11) / slip;
        // What a change of the bank itself turns.
        let (slipped, turned) = (a.m12 + a.m13 * turn, roll + yaw * turn);
        let by_bank =
            a.m14 + a.m11 * slipped + a.m13 * turned + share * (slip * slipped + yaw * turned);
        let grown = libm::exp(growth * STAGE_PERIOD);
        Some(Self {
            by: [-share * turn, share, -slipped - share * turned],
            stage: [grown, by_bank * (grown - 1.0) / growth],
            aileron: [a.m21, a.m22, a.m23].map(|it| -it / b.m21),
        })
    }

    /// The runaway \[rad\] at a sideslip \[rad\], roll rate and yaw rate [rad/s], and bank \[rad\].
    #[must_use]
    pub fn runaway(&self, sideslip: f64, [roll_rate, yaw_rate]: [f64; 2], bank: f64) -> f64 {
        let [roll, yaw, banked] = self.by;
        let runaway = sideslip + roll * roll_rate + yaw * yaw_rate + banked * bank;
        runaway.clamp(-MOST, MOST)
    }

    /// The runaway \[rad\] after a stage with a mean bank \[rad\].
    #[must_use]
    pub fn after_stage(&self, runaway: f64, bank: f64) -> f64 {
        let [grown, by_bank] = self.stage;
        grown * runaway + by_bank * bank
    }
}
