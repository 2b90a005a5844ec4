//! The lateral regulator: it holds a bank, coordinates the turn, and damps the yaw.

use super::{RiccatiError, solve_riccati};
use crate::config::TICK_PERIOD;
use crate::tuning::lateral::{BANDWIDTH, INTEGRAL_SHARE, INTEGRAL_TIME, RUDDER, SIDESLIP};
use crate::units::Units;
use crate::vehicle::{
    Airframe, GRAVITY, LateralAirframe, LateralControl, LateralLinearization, Nose, Trim,
    linearize_lateral, within,
};
use nalgebra::{Matrix2, Matrix2x4, Matrix4, Vector2, Vector4};

/// No gain holds a bank.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no gain of the lateral regulator holds a bank: check the lateral table of the aircraft")]
pub struct NoLateralGain(#[from] pub RiccatiError);

/// What the regulator knows of the lateral motion.
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
    /// Sideslip \[rad\]. Nothing measures it, and only a wing whose nose runs away needs it.
    pub sideslip: f64,
}

/// State feedback `u = u_turn - K (x - x_turn) + integral` about a coordinated turn, designed in level flight. Its gains fall
/// with the dynamic pressure, because the surfaces grow with it; the deflections of the turn fall with the airspeed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateralRegulator {
    /// Gain `K` of aileron and rudder on sideslip (0 if the nose stays), roll rate, yaw rate, bank.
    pub gain: Matrix2x4<f64>,
    /// Deflections that hold a roll rate and a yaw rate, per rad/s, and the sideslip then.
    hold: Matrix2<f64>,
    slip: Vector2<f64>,
    nose: Option<Nose>,
    /// Airspeed [m/s] and pitch \[rad\] of the design.
    airspeed: f64,
    pitch: (f64, f64),
    /// Greatest deflections \[rad\].
    limits: [f64; 2],
    /// Aileron of the integral, and its limit \[rad\]; 0 if the nose runs away: a lasting aileron then banks to the other side.
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
        let [aileron, rudder] = limits;
        let nose = Nose::of(&linear).filter(|_| rudder <= 0.0);
        let by_slip = nose.map_or(0.0, |_| k.m11);
        let gain = Matrix2x4::new(by_slip, k.m12, k.m13, k.m14, 0.0, k.m22, k.m23, k.m24);
        // A closed loop that grows has no Lyapunov function.
        let closed = linear.a - linear.b * gain;
        solve_riccati(&closed, &Matrix4::zeros(), &q)?;
        let (hold, slip) = match nose {
            Some(_) => turn(&linear),
            None => (hold(&linear, limits), Vector2::zeros()),
        };
        if !hold.iter().all(|it| it.is_finite()) {
            return Err(RiccatiError::Singular.into());
        }
        Ok(Self {
            gain,
            hold,
            slip,
            nose,
            airspeed: trim.state.airspeed,
            pitch: libm::sincos(trim.state.pitch),
            limits,
            integral: 0.0,
            most_integral: if nose.is_some() {
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
    /// what is left, and minds the nose if it runs away.
    #[must_use]
    pub fn follow(&self, motion: &LateralMotion, bank: f64, bank_rate: f64) -> LateralControl {
        let command = match &self.nose {
            Some(nose) => self.rolled(nose, motion, bank, bank_rate),
            None => self.deflections(motion, bank, bank_rate),
        };
        self.limited(command.unwrap_or_default())
    }

    /// The aileron that rolls to a bank whatever the nose does.
    fn rolled(
        &self,
        nose: &Nose,
        motion: &LateralMotion,
        bank: f64,
        bank_rate: f64,
    ) -> Option<LateralControl> {
        let ratio = self.airspeed / motion.airspeed.max(0.5 * self.airspeed);
        let (sin_pitch, cos_pitch) = self.pitch;
        let roll_rate = bank_rate - motion.yaw_rate * sin_pitch / cos_pitch;
        let [slip, roll, yaw] = nose.aileron;
        let held = slip * motion.sideslip + (roll * roll_rate + yaw * motion.yaw_rate) * ratio;
        let off =
            self.gain.m12 * (motion.roll_rate - roll_rate) + self.gain.m14 * (motion.bank - bank);
        let aileron = held - off * (ratio * ratio);
        aileron.is_finite().then_some(LateralControl {
            aileron,
            rudder: 0.0,
        })
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
            motion.sideslip,
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
            motion.sideslip - self.slip.dot(&steady) * ratio,
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

/// As [`hold`], for a wing whose nose runs away, with the sideslip \[rad\] per rad/s that leaves no moment with the aileron alone.
fn turn(linear: &LateralLinearization) -> (Matrix2<f64>, Vector2<f64>) {
    let (a, b) = (&linear.a, &linear.b);
    let determinant = a.m21 * b.m31 - a.m31 * b.m21;
    let slip =
        Vector2::new(b.m21 * a.m32 - b.m31 * a.m22, b.m21 * a.m33 - b.m31 * a.m23) / determinant;
    let aileron =
        Vector2::new(a.m31 * a.m22 - a.m21 * a.m32, a.m31 * a.m23 - a.m21 * a.m33) / determinant;
    (Matrix2::new(aileron.x, aileron.y, 0.0, 0.0), slip)
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
