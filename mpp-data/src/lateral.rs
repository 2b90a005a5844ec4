//! The lateral part of an airframe: what a vertical plane does not know.

use serde::{Deserialize, Serialize};

/// The lateral coefficients of an airframe, beside its longitudinal [`Airframe`](crate::Airframe).
///
/// Body axes: x ahead, y to the right, z down. Bank, roll rate, yaw rate and moments are positive to the right; the
/// sideslip is positive when the air comes from the right. A positive command of aileron or rudder turns the aircraft to
/// the right.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LateralAirframe {
    /// Wing span `b` \[m\], the reference length of the lateral coefficients.
    pub span: f64,
    /// Moment of inertia in roll `J_x` [kg m^2].
    pub roll_inertia: f64,
    /// Moment of inertia in yaw `J_z` [kg m^2].
    pub yaw_inertia: f64,
    /// Product of inertia `J_xz` [kg m^2].
    pub product_inertia: f64,
    /// Side force `C_Y`, positive to the right.
    pub side: Derivatives,
    /// Rolling moment `C_l`.
    pub roll: Derivatives,
    /// Yawing moment `C_n`.
    pub yaw: Derivatives,
}

/// The derivatives of one lateral coefficient.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Derivatives {
    /// By the sideslip `beta` [1/rad].
    pub sideslip: f64,
    /// By the roll rate as `p b / 2v` [-].
    pub roll_rate: f64,
    /// By the yaw rate as `r b / 2v` [-].
    pub yaw_rate: f64,
    /// By the aileron [1/rad].
    pub aileron: f64,
    /// By the rudder [1/rad].
    pub rudder: f64,
}

/// The commands to the lateral surfaces \[rad\], positive to the right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LateralControl {
    /// Aileron `delta_a`.
    pub aileron: f64,
    /// Rudder `delta_r`.
    pub rudder: f64,
}

impl Derivatives {
    /// The coefficient [-] at a sideslip \[rad\], at roll rate and yaw rate times `b / 2v` [-], and under a control.
    #[must_use]
    pub fn coefficient(
        &self,
        sideslip: f64,
        [roll, yaw]: [f64; 2],
        control: LateralControl,
    ) -> f64 {
        self.sideslip * sideslip
            + self.roll_rate * roll
            + self.yaw_rate * yaw
            + self.aileron * control.aileron
            + self.rudder * control.rudder
    }
}

impl LateralAirframe {
    /// Number of its numbers.
    pub const COUNT: usize = 4 + 3 * 5;

    /// Roll and yaw acceleration [rad/s^2] of a rolling and a yawing moment [N m].
    #[must_use]
    pub fn acceleration(&self, [roll, yaw]: [f64; 2]) -> [f64; 2] {
        let (x, z, xz) = (self.roll_inertia, self.yaw_inertia, self.product_inertia);
        let determinant = x * z - xz * xz;
        [
            (z * roll + xz * yaw) / determinant,
            (xz * roll + x * yaw) / determinant,
        ]
    }
}
