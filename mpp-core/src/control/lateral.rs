//! The lateral regulator: it holds a bank, coordinates the turn, and damps the yaw.

use super::{RiccatiError, solve_riccati};
use crate::config::TICK_PERIOD;
use crate::tuning::lateral::{BANDWIDTH, INTEGRAL_SHARE, INTEGRAL_TIME, RUDDER, SIDESLIP};
use crate::units::Units;
use crate::vehicle::{
    Airframe, GRAVITY, LateralAirframe, LateralControl, LateralLinearization, Trim,
    linearize_lateral, within,
};
use nalgebra::{Matrix2, Matrix2x4, Matrix4, Vector2, Vector4};

/// No gain holds a bank.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no gain of the lateral regulator holds a bank: check the lateral table of the aircraft")]
pub struct NoLateralGain(#[from] pub RiccatiError);

/// What the regulator knows of the lateral motion. Nothing measures the sideslip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateralMotion {
    /// Airspeed [m/s].
    pub airspeed: f64,
    /// Bank \[rad\], to the right positive.
    pub bank: f64,
    /// Roll rate [rad/s].
    pub roll_rate: f64,
    /// Yaw rate [rad/s].
    pub yaw_rate: f64,
}

/// State feedback `u = u_turn - K (x - x_turn) + integral` about a coordinated turn, designed in level flight. Its gains fall
/// with the dynamic pressure, because the surfaces grow with it; the deflections of the turn fall with the airspeed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateralRegulator {
    /// Gain `K` of aileron and rudder on sideslip (always 0), roll rate, yaw rate, bank.
    pub gain: Matrix2x4<f64>,
    /// Deflections that hold a roll rate and a yaw rate, per rad/s.
    hold: Matrix2<f64>,
    /// Airspeed [m/s] and pitch \[rad\] of the design.
    airspeed: f64,
    pitch: (f64, f64),
    /// Greatest deflections \[rad\].
    limits: [f64; 2],
    /// Aileron of the integral, and its limit \[rad\]; 0 for a wing whose ailerons alone hold no turn.
    integral: f64,
    most_integral: f64,
}

impl LateralRegulator {
    /// The regulator of an aircraft in its level trim, with the greatest deflections \[rad\] of aileron and rudder; 0 if there is
    /// no rudder.
    ///
    /// # Errors
    /// [`NoLateralGain`] if no gain stabilises the aircraft, or if the gain without the sideslip does not.
    pub fn design(
        airframe: &Airframe,
        lateral: &LateralAirframe,
        trim: &Trim,
        limits: [f64; 2],
    ) -> Result<Self, NoLateralGain> {
        let linear = linearize_lateral(airframe, lateral, trim);
        // A steady roll rate for each radian of the aileron.
        let authority = linear.b.m21 / -linear.a.m22;
        let time = Units::of(trim.state.airspeed, airframe.mass).time;
        let aileron = authority * time / BANDWIDTH;
        let q = Matrix4::from_diagonal(&Vector4::new(SIDESLIP, 0.0, 0.0, 1.0));
        let inverse = Matrix2::new(1.0 / (aileron * aileron), 0.0, 0.0, 1.0 / RUDDER);
        let g = linear.b * inverse * linear.b.transpose();
        let cost = solve_riccati(&linear.a, &g, &q)?;
        let k = inverse * linear.b.transpose() * cost;
        let gain = Matrix2x4::new(0.0, k.m12, k.m13, k.m14, 0.0, k.m22, k.m23, k.m24);
        // A closed loop that grows has no Lyapunov function.
        let closed = linear.a - linear.b * gain;
        solve_riccati(&closed, &Matrix4::zeros(), &q)?;
        let hold = hold(&linear, limits);
        if !hold.iter().all(|it| it.is_finite()) {
            return Err(RiccatiError::Singular.into());
        }
        let [aileron, rudder] = limits;
        // Ailerons that hold the bank of such a wing let the nose run away: a lasting aileron banks it to the other side.
        let stiffness = linear.a.m31 - linear.a.m21 * linear.b.m31 / linear.b.m21;
        let departs = rudder <= 0.0 && stiffness < 0.0;
        Ok(Self {
            gain,
            hold,
            airspeed: trim.state.airspeed,
            pitch: libm::sincos(trim.state.pitch),
            limits,
            integral: 0.0,
            most_integral: if departs {
                0.0
            } else {
                aileron * INTEGRAL_SHARE
            },
        })
    }

    /// The command of this tick that brings the aircraft to a bank \[rad\] and holds it there. A motion or a bank that is not
    /// finite gives neutral surfaces.
    pub fn step(&mut self, motion: &LateralMotion, bank: f64) -> LateralControl {
        let Some(mut command) = self.deflections(motion, bank, 0.0) else {
            return LateralControl::default();
        };
        let pull = self.gain.m14 * (motion.bank - bank) * TICK_PERIOD / INTEGRAL_TIME;
        self.integral = within(self.integral - pull, self.most_integral);
        command.aileron += self.integral;
        self.limited(command)
    }

    /// The command that follows a bank \[rad\] which changes at a rate [rad/s]. It has no integral: whoever plans the bank corrects
    /// what is left.
    #[must_use]
    pub fn follow(&self, motion: &LateralMotion, bank: f64, bank_rate: f64) -> LateralControl {
        let command = self.deflections(motion, bank, bank_rate);
        self.limited(command.unwrap_or_default())
    }

    fn limited(&self, command: LateralControl) -> LateralControl {
        let [aileron, rudder] = self.limits;
        LateralControl {
            aileron: within(command.aileron, aileron),
            rudder: within(command.rudder, rudder),
        }
    }

    /// Deflections without limits; `None` if a number is not finite.
    fn deflections(
        &self,
        motion: &LateralMotion,
        bank: f64,
        bank_rate: f64,
    ) -> Option<LateralControl> {
        let known = [
            motion.airspeed,
            motion.bank,
            motion.roll_rate,
            motion.yaw_rate,
            bank,
            bank_rate,
        ];
        if !known.iter().all(|it| it.is_finite()) {
            return None;
        }
        let ratio = self.airspeed / motion.airspeed.max(0.5 * self.airspeed);
        let (sin_bank, cos_bank) = libm::sincos(bank);
        let turn = GRAVITY * sin_bank / (cos_bank.max(0.1) * ratio.recip() * self.airspeed);
        let (sin_pitch, cos_pitch) = self.pitch;
        let roll = -turn * sin_pitch + bank_rate;
        let steady = Vector2::new(roll, turn * cos_pitch * cos_bank);
        let error = Vector4::new(
            0.0,
            motion.roll_rate - steady.x,
            motion.yaw_rate - steady.y,
            motion.bank - bank,
        );
        let command = self.hold * steady * ratio - self.gain * error * (ratio * ratio);
        Some(LateralControl {
            aileron: command.x,
            rudder: command.y,
        })
    }
}

/// Deflections per steady roll and yaw rate that leave no moment without sideslip. Without a rudder they leave no rolling
/// moment, and the nose finds its sideslip itself.
fn hold(linear: &LateralLinearization, limits: [f64; 2]) -> Matrix2<f64> {
    let moments = Matrix2::new(linear.a.m22, linear.a.m23, linear.a.m32, linear.a.m33);
    let surfaces = Matrix2::new(linear.b.m21, linear.b.m22, linear.b.m31, linear.b.m32);
    let [_, rudder] = limits;
    if rudder <= 0.0 {
        let aileron = -1.0 / surfaces.m11;
        return Matrix2::new(aileron * moments.m11, aileron * moments.m12, 0.0, 0.0);
    }
    let determinant = surfaces.m11 * surfaces.m22 - surfaces.m12 * surfaces.m21;
    let adjugate = Matrix2::new(surfaces.m22, -surfaces.m12, -surfaces.m21, surfaces.m11);
    adjugate * moments * (-1.0 / determinant)
}
