//! The lateral motion about steady level flight, to first order.

use super::{Airframe, GRAVITY, LateralAirframe, Trim};
use mpp_data::Derivatives;
use nalgebra::{Matrix4, Matrix4x2};

/// Linear model `d/dt x = a x + b u` of the lateral motion. The order of the state is sideslip, roll rate, yaw rate, bank;
/// that of the control is aileron, rudder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateralLinearization {
    /// State Jacobian, 4 x 4.
    pub a: Matrix4<f64>,
    /// Control Jacobian, 4 x 2.
    pub b: Matrix4x2<f64>,
}

/// Linearises the lateral motion about a level trim, in body axes.
#[must_use]
pub fn linearize_lateral(
    airframe: &Airframe,
    lateral: &LateralAirframe,
    trim: &Trim,
) -> LateralLinearization {
    let speed = trim.state.airspeed;
    let (sin, cos) = libm::sincos(trim.state.angle_of_attack());
    let pressure_area = 0.5 * airframe.air_density * (speed * speed) * airframe.wing_area;
    let per_rate = lateral.span / (2.0 * speed);
    // By sideslip, roll rate, yaw rate, aileron, rudder.
    let effects = |of: &Derivatives| {
        [
            of.sideslip,
            of.roll_rate * per_rate,
            of.yaw_rate * per_rate,
            of.aileron,
            of.rudder,
        ]
    };
    let side = effects(&lateral.side).map(|it| it * pressure_area / (airframe.mass * speed));
    let arm = pressure_area * lateral.span;
    let (roll, yaw) = (effects(&lateral.roll), effects(&lateral.yaw));
    let mut turns = [[0.0; 2]; 5];
    for (turn, (roll, yaw)) in turns.iter_mut().zip(roll.iter().zip(&yaw)) {
        *turn = lateral.acceleration([arm * roll, arm * yaw]);
    }
    let [slip, p, r, aileron, rudder] = turns;
    let [side_slip, side_p, side_r, side_aileron, side_rudder] = side;
    // Thrust and drag hold each other, so that the sideslip alone turns neither.
    #[rustfmt::skip]
    let a = Matrix4::new(
        side_slip, side_p + sin, side_r - cos, GRAVITY * cos / speed,
        slip[0],   p[0],         r[0],         0.0,
        slip[1],   p[1],         r[1],         0.0,
        0.0,       1.0,          sin / cos,    0.0,
    );
    #[rustfmt::skip]
    let b = Matrix4x2::new(
        side_aileron, side_rudder,
        aileron[0],   rudder[0],
        aileron[1],   rudder[1],
        0.0,          0.0,
    );
    LateralLinearization { a, b }
}
