//! Motion of the point mass: the equations of motion with the rotation in balance. The aircraft reaches
//! this balance within a tenth of a second. Roll-outs of plans use this model.
//!
//! The angle of attack is a state, and its rate is a control. A plan therefore never asks for a jump of
//! the lift. The airframe of these functions is a [balanced](Airframe::balanced) one.

use super::{AirState, Airframe, Control, GRAVITY, VehicleState, Wind};
use nalgebra::{Matrix3, Matrix5, SMatrix};

/// Least airspeed of a roll-out [m/s]. It keeps the divisor of the equations away from zero, also in
/// the motion of an aircraft that cruises at 3 m/s.
const LEAST_AIRSPEED: f64 = 0.5;

/// State of the point mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathState {
    /// Downrange distance \[m\].
    pub x: f64,
    /// Height \[m\].
    pub z: f64,
    /// Airspeed [m/s].
    pub airspeed: f64,
    /// Flight path angle \[rad\].
    pub flight_path: f64,
    /// Angle of attack \[rad\].
    pub angle_of_attack: f64,
}

/// Control of the point mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathControl {
    /// Rate of the angle of attack [rad/s].
    pub angle_of_attack_rate: f64,
    /// Thrust \[N\]: in the equations of motion the thrust that acts, in a plan the command.
    pub thrust: f64,
}

impl PathState {
    /// The point mass of a vehicle with this state.
    #[must_use]
    pub fn of(state: &VehicleState) -> Self {
        Self {
            x: state.x,
            z: state.z,
            airspeed: state.air.airspeed,
            flight_path: state.air.flight_path,
            angle_of_attack: state.air.angle_of_attack(),
        }
    }

    /// The state after `dt` \[s\] under a constant control, by `steps` steps of the classic Runge-Kutta
    /// method.
    #[must_use]
    pub fn after(&self, airframe: &Airframe, control: &PathControl, dt: f64, steps: u8) -> Self {
        let h = dt / f64::from(steps.max(1));
        let mut state = *self;
        for _ in 0..steps.max(1) {
            state = state.runge_kutta(airframe, control, h);
        }
        state
    }

    /// The state after `dt` \[s\] in moving air; otherwise like [`Self::after`].
    #[must_use]
    pub fn after_in(
        &self,
        wind: &Wind,
        airframe: &Airframe,
        control: &PathControl,
        dt: f64,
        steps: u8,
    ) -> Self {
        let still = self.after(airframe, control, dt, steps);
        Self {
            x: still.x + wind.x * dt,
            z: still.z + wind.z * dt,
            ..still
        }
    }

    fn runge_kutta(&self, airframe: &Airframe, control: &PathControl, h: f64) -> Self {
        let k1 = self.rate(airframe, control);
        let second = self.moved(&k1, 0.5 * h);
        // The third state has the same angle of attack.
        let alpha = libm::sincos(second.angle_of_attack);
        let k2 = second.rate_at(alpha, airframe, control);
        let k3 = (self.moved(&k2, 0.5 * h)).rate_at(alpha, airframe, control);
        let k4 = self.moved(&k3, h).rate(airframe, control);
        let ends = self.moved(&k1, h / 6.0).moved(&k4, h / 6.0);
        ends.moved(&k2, h / 3.0).moved(&k3, h / 3.0)
    }

    /// Time derivative of the state.
    #[must_use]
    pub fn rate(&self, airframe: &Airframe, control: &PathControl) -> Self {
        self.rate_at(libm::sincos(self.angle_of_attack), airframe, control)
    }

    /// Does the work of [`Self::rate`] with sine and cosine of the angle of attack.
    fn rate_at(
        &self,
        (sin_alpha, cos_alpha): (f64, f64),
        airframe: &Airframe,
        control: &PathControl,
    ) -> Self {
        let a = airframe;
        let (sin_path, cos_path) = libm::sincos(self.flight_path);
        let v = self.airspeed;
        let pressure_area = 0.5 * a.air_density * (v * v) * a.wing_area;
        let lift = a.lift_zero + a.lift_alpha * self.angle_of_attack;
        let drag = a.drag_zero + a.drag_induced * (lift * lift);
        Self {
            x: v * cos_path,
            z: v * sin_path,
            airspeed: (control.thrust * cos_alpha - pressure_area * drag) / a.mass
                - GRAVITY * sin_path,
            flight_path: turn_rate(
                a,
                v,
                (pressure_area * lift + control.thrust * sin_alpha) / (a.mass * v)
                    - GRAVITY * cos_path / v,
                control.angle_of_attack_rate,
            ),
            angle_of_attack: control.angle_of_attack_rate,
        }
    }

    /// `self + h rate`, with at least the least airspeed.
    fn moved(&self, rate: &Self, h: f64) -> Self {
        Self {
            x: self.x + h * rate.x,
            z: self.z + h * rate.z,
            airspeed: (self.airspeed + h * rate.airspeed).max(LEAST_AIRSPEED),
            flight_path: self.flight_path + h * rate.flight_path,
            angle_of_attack: self.angle_of_attack + h * rate.angle_of_attack,
        }
    }

    /// The state of the whole vehicle, and the controls that keep its rotation in balance.
    #[must_use]
    pub fn reference(&self, airframe: &Airframe, control: &PathControl) -> (VehicleState, Control) {
        let a = airframe;
        let alpha = self.angle_of_attack;
        let rate = self.rate(airframe, control);
        let turn = rate.flight_path + rate.angle_of_attack;
        let moment = a.moment_zero
            + a.moment_alpha * alpha
            + a.moment_alpha_rate * rate.angle_of_attack
            + a.moment_pitch_rate * turn;
        let state = VehicleState {
            x: self.x,
            z: self.z,
            air: AirState {
                airspeed: self.airspeed,
                pitch: self.flight_path + alpha,
                pitch_rate: turn,
                flight_path: self.flight_path,
            },
        };
        let feedforward = Control {
            thrust: control.thrust,
            elevator: -moment / a.moment_elevator,
        };
        (state, feedforward)
    }

    /// Derivatives of the state `end` after `dt` \[s\]: 5 x 5 with respect to `(x, z, v, gamma, alpha)` and 5 x 2
    /// with respect to `(alpha rate, thrust)`. They come from the matrix exponential (to the fourth order) of
    /// the Jacobian halfway, at the mean of both states.
    #[must_use]
    pub fn sensitivity(
        &self,
        end: &Self,
        airframe: &Airframe,
        control: &PathControl,
        dt: f64,
    ) -> (Matrix5<f64>, SMatrix<f64, 5, 2>) {
        let middle = Self {
            airspeed: (0.5 * (self.airspeed + end.airspeed)).max(LEAST_AIRSPEED),
            flight_path: 0.5 * (self.flight_path + end.flight_path),
            angle_of_attack: 0.5 * (self.angle_of_attack + end.angle_of_attack),
            // The Jacobian does not depend on the position.
            ..*self
        };
        let (state, input) = middle.jacobian(airframe, control);
        // The position changes nothing, so the exponential is that of the other three states. `second` is the
        // mean of the mean over the time.
        let by_motion = state.fixed_columns::<3>(2) * dt;
        let position = by_motion.fixed_rows::<2>(0).into_owned();
        let motion = by_motion.fixed_rows::<3>(2).into_owned();
        let pushes = input.fixed_rows::<3>(2) * dt;
        let identity = Matrix3::identity();
        let second = identity * 0.5 + motion * (identity * (1.0 / 6.0) + motion * (1.0 / 24.0));
        let mean = identity + motion * second;
        let mut state = Matrix5::identity();
        let mut rows = state.fixed_columns_mut::<3>(2);
        rows.fixed_rows_mut::<2>(0).copy_from(&(position * mean));
        let moved = identity + motion * mean;
        rows.fixed_rows_mut::<3>(2).copy_from(&moved);
        let mut input = SMatrix::<f64, 5, 2>::zeros();
        let passed = position * (second * pushes);
        input.fixed_rows_mut::<2>(0).copy_from(&passed);
        input.fixed_rows_mut::<3>(2).copy_from(&(mean * pushes));
        (state, input)
    }

    /// Jacobian of [`Self::rate`] with respect to state and control.
    #[must_use]
    pub fn jacobian(
        &self,
        airframe: &Airframe,
        control: &PathControl,
    ) -> (Matrix5<f64>, SMatrix<f64, 5, 2>) {
        let a = airframe;
        let (sin_path, cos_path) = libm::sincos(self.flight_path);
        let (sin_alpha, cos_alpha) = libm::sincos(self.angle_of_attack);
        let v = self.airspeed;
        let density_area = a.air_density * a.wing_area;
        let pressure_area = 0.5 * density_area * (v * v);
        let lift = a.lift_zero + a.lift_alpha * self.angle_of_attack;
        let drag = a.drag_zero + a.drag_induced * (lift * lift);
        let slow_rate = (pressure_area * lift + control.thrust * sin_alpha) / (a.mass * v)
            - GRAVITY * cos_path / v;
        let alpha_rate = control.angle_of_attack_rate;
        let path_rate = turn_rate(a, v, slow_rate, alpha_rate);
        // Lift by rates, as a share of the path rate; it grows with `v`.
        let per_rate = pressure_area / (a.mass * v);
        let gain = a.turn_gain(v);
        let path_input = gain * per_rate * (a.lift_alpha_rate + a.lift_pitch_rate);
        let path_v = gain
            * (density_area * lift / a.mass - slow_rate / v
                + per_rate / v * (a.lift_pitch_rate * path_rate))
            + path_input / v * alpha_rate;
        let speed_alpha = (-control.thrust * sin_alpha
            - 2.0 * pressure_area * a.drag_induced * lift * a.lift_alpha)
            / a.mass;
        let path_alpha =
            gain * (pressure_area * a.lift_alpha + control.thrust * cos_alpha) / (a.mass * v);
        #[rustfmt::skip]
        let state = Matrix5::new(
            0.0, 0.0, cos_path,                                     -v * sin_path,          0.0,
            0.0, 0.0, sin_path,                                     v * cos_path,           0.0,
            0.0, 0.0, -density_area * v * drag / a.mass,            -GRAVITY * cos_path,    speed_alpha,
            0.0, 0.0, path_v,                                       gain * GRAVITY * sin_path / v, path_alpha,
            0.0, 0.0, 0.0,                                          0.0,                    0.0,
        );
        #[rustfmt::skip]
        let input = SMatrix::<f64, 5, 2>::new(
            0.0, 0.0,
            0.0, 0.0,
            0.0, cos_alpha / a.mass,
            path_input, gain * sin_alpha / (a.mass * v),
            1.0, 0.0,
        );
        (state, input)
    }
}

/// Rate of the flight path [rad/s], of its rate without the lift by rates and the rate of the angle of attack
/// [rad/s]. The pitch rate is the sum of both rates, so the path rate stands on both sides of the balance.
fn turn_rate(a: &Airframe, airspeed: f64, without: f64, angle_of_attack_rate: f64) -> f64 {
    let per_rate = 0.5 * a.air_density * airspeed * a.wing_area / a.mass;
    let pushed = per_rate * ((a.lift_alpha_rate + a.lift_pitch_rate) * angle_of_attack_rate);
    (without + pushed) * a.turn_gain(airspeed)
}
