//! Tests the equations of motion against physics, Jacobians against differences, and trim against
//! both.

use crate::common::seeded::{named, seeded};
use mpp_core::vehicle::{
    AirState, Airframe, Control, GRAVITY, JacobianForm, Linearization, Trim, TrimError,
    VehicleState, air_rate, linearize, vehicle_rate,
};
use nalgebra::{Matrix4, Matrix4x2, Vector4};
use proptest::prelude::*;

/// Half a step of the central differences. Their error is its square times third derivatives.
const STEP: f64 = 1e-4;
/// Error of differences, relative to the largest entry of their row.
const DIFFERENCE: f64 = 1e-6;
/// Error of sums of a few rounded terms, relative to the largest term.
const ROUNDING: f64 = 1e-12;

fn states() -> impl Strategy<Value = AirState> {
    (6.0..25.0, -0.6..0.6, -2.0..2.0, -0.6..0.6).prop_map(|(v, pitch, rate, path)| AirState {
        airspeed: v,
        pitch,
        pitch_rate: rate,
        flight_path: path,
    })
}

fn controls() -> impl Strategy<Value = Control> {
    (0.0..20.0, -10.0..20.0).prop_map(|(thrust, elevator)| Control { thrust, elevator })
}

/// Both named airframes with every parameter up to 30 % wrong, an elevator with lift, a damping by the pitch
/// rate, and lift by rates.
fn airframes() -> impl Strategy<Value = Airframe> {
    let factors = prop::array::uniform::<_, { Airframe::COUNT }>(0.7..1.3);
    let more = (-0.03..0.03, -1.0..0.0, -0.1..0.2, -0.1..0.2);
    (named(), factors, more).prop_map(
        |(base, factors, (lift_elevator, moment_pitch_rate, lift_alpha_rate, lift_pitch_rate))| {
            let mut numbers = base.numbers();
            for (number, factor) in numbers.iter_mut().zip(factors) {
                *number *= factor;
            }
            Airframe {
                lift_elevator,
                moment_pitch_rate,
                lift_alpha_rate,
                lift_pitch_rate,
                ..Airframe::of_numbers(numbers)
            }
        },
    )
}

fn rate_at(airframe: &Airframe, state: Vector4<f64>, control: [f64; 2]) -> Vector4<f64> {
    let control = Control {
        thrust: control[0],
        elevator: control[1],
    };
    air_rate(airframe, &AirState::from_vector(&state), control).to_vector()
}

/// The Jacobians by central differences.
fn differences(airframe: &Airframe, state: &AirState, control: Control) -> Linearization {
    let at = state.to_vector();
    let controls = [control.thrust, control.elevator];
    let mut a = Matrix4::zeros();
    let mut b = Matrix4x2::zeros();
    for index in 0..4 {
        let mut step = Vector4::zeros();
        step[index] = STEP;
        let change =
            rate_at(airframe, at + step, controls) - rate_at(airframe, at - step, controls);
        a.set_column(index, &(change / (2.0 * STEP)));
    }
    for index in 0..2 {
        let (mut above, mut below) = (controls, controls);
        above[index] += STEP;
        below[index] -= STEP;
        let change = rate_at(airframe, at, above) - rate_at(airframe, at, below);
        b.set_column(index, &(change / (2.0 * STEP)));
    }
    Linearization { a, b }
}

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn the_exact_jacobian_equals_central_differences(
        airframe in airframes(), state in states(), control in controls(),
    ) {
        let exact = linearize(&airframe, &state, control, JacobianForm::Exact);
        let expected = differences(&airframe, &state, control);
        for row in 0..4 {
            let scale = expected.a.row(row).amax().max(expected.b.row(row).amax()).max(1.0);
            for col in 0..4 {
                let error = (exact.a[(row, col)] - expected.a[(row, col)]).abs();
                prop_assert!(error <= DIFFERENCE * scale, "a[{row}, {col}] is off by {error}");
            }
            for col in 0..2 {
                let error = (exact.b[(row, col)] - expected.b[(row, col)]).abs();
                prop_assert!(error <= DIFFERENCE * scale, "b[{row}, {col}] is off by {error}");
            }
        }
    }

    #[test]
    fn the_authors_jacobian_leaves_out_what_it_says_and_nothing_else(
        airframe in airframes(), state in states(), control in controls(),
    ) {
        // The authors' airframe has no lift by rates.
        let airframe = Airframe { lift_alpha_rate: 0.0, lift_pitch_rate: 0.0, ..airframe };
        let exact = linearize(&airframe, &state, control, JacobianForm::Exact);
        let mut expected = exact;
        let path_rate = air_rate(&airframe, &state, control).flight_path;
        expected.a[(3, 0)] += path_rate / state.airspeed;
        // One damping acts on theta' - gamma', so gamma' brings its share into theta''.
        let dampings = airframe.moment_alpha_rate + airframe.moment_pitch_rate;
        let share = airframe.moment_alpha_rate / dampings;
        expected.a[(2, 0)] += exact.a[(2, 2)] * share * exact.a[(3, 0)];
        expected.a[(2, 2)] = 0.0;
        expected.b[(2, 0)] = 0.0;
        let authors = linearize(&airframe, &state, control, JacobianForm::Authors);
        let scale = exact.a.amax();
        prop_assert!((authors.a - expected.a).amax() <= ROUNDING * scale);
        prop_assert!((authors.b - expected.b).amax() <= ROUNDING * scale);
    }

    #[test]
    fn only_thrust_and_drag_change_the_energy(
        airframe in airframes(), state in states(), control in controls(),
    ) {
        let lift_coefficient = airframe.lift_zero
            + airframe.lift_alpha * state.angle_of_attack()
            + airframe.lift_elevator * control.elevator;
        let drag_coefficient =
            airframe.drag_zero + airframe.drag_induced * lift_coefficient * lift_coefficient;
        let v = state.airspeed;
        let drag = 0.5 * airframe.air_density * v * v * airframe.wing_area * drag_coefficient;
        let power = (control.thrust * libm::cos(state.angle_of_attack()) - drag) * v;
        let vehicle = VehicleState { x: 3.0, z: 7.0, air: state };
        let rate = vehicle_rate(&airframe, &vehicle, control);
        prop_assert!((libm::hypot(rate.x, rate.z) - v).abs() <= ROUNDING * v);
        prop_assert!((libm::atan2(rate.z, rate.x) - state.flight_path).abs() <= ROUNDING);
        let change = airframe.mass * (v * rate.air.airspeed + GRAVITY * rate.z);
        let scale = airframe.mass * GRAVITY * v + drag * v;
        prop_assert!((power - change).abs() <= ROUNDING * scale, "{power} against {change}");
    }

    #[test]
    fn forces_across_the_path_bend_it(
        airframe in airframes(), state in states(), control in controls(),
    ) {
        // This is the acceleration in world coordinates, projected upwards: lift, weight, thrust
        // and drag as vectors.
        let v = state.airspeed;
        let pressure_area = 0.5 * airframe.air_density * v * v * airframe.wing_area;
        let lift_coefficient = airframe.lift_zero
            + airframe.lift_alpha * state.angle_of_attack()
            + airframe.lift_elevator * control.elevator;
        let rate = air_rate(&airframe, &state, control);
        let rate_lift = airframe.lift_pitch_rate * state.pitch_rate
            + airframe.lift_alpha_rate * (state.pitch_rate - rate.flight_path);
        let lift = pressure_area * (lift_coefficient + rate_lift);
        let drag = pressure_area
            * (airframe.drag_zero + airframe.drag_induced * lift_coefficient * lift_coefficient);
        let (sin_path, cos_path) = libm::sincos(state.flight_path);
        let up = lift * cos_path - drag * sin_path + control.thrust * libm::sin(state.pitch)
            - airframe.mass * GRAVITY;
        let change = airframe.mass * (rate.airspeed * sin_path + v * rate.flight_path * cos_path);
        prop_assert!((up - change).abs() <= ROUNDING * (lift.abs() + drag + 100.0));
    }

    #[test]
    fn trim_stands_still_at_any_speed_and_slope(
        airframe in airframes(), airspeed in 13.0..25.0, path in -0.5..0.5,
    ) {
        let trim = Trim::at_speed(&airframe, airspeed, path);
        prop_assert!(trim.is_ok(), "{trim:?}");
        let Ok(trim) = trim else { return Ok(()) };
        prop_assert!((trim.state.airspeed - airspeed).abs() < ROUNDING);
        prop_assert!((trim.state.flight_path - path).abs() < ROUNDING);
        let rate = air_rate(&airframe, &trim.state, trim.control).to_vector();
        prop_assert!(rate.amax() < 1e-9, "{rate:?}");
    }
}

#[test]
fn the_elevator_of_level_trim_is_the_known_number() {
    // The elevator is 3.85 in the authors' code and in every flight recorded from it.
    let trim = Trim::of_authors(&Airframe::REFERENCE);
    assert!((trim.control.elevator - 3.854_277_848_009_655).abs() < 1e-9);
    let rate = air_rate(&Airframe::REFERENCE, &trim.state, trim.control).to_vector();
    assert!(
        rate.x < -0.02 && rate.x > -0.04,
        "not quite steady: {}",
        rate.x
    );
    assert!(rate.w.abs() < 1e-3, "{rate:?}");
}

#[test]
fn nonsense_has_no_trim() {
    let nonsense = [0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for airspeed in nonsense {
        assert!(
            Trim::at_speed(&Airframe::PAPER, airspeed, 0.0).is_err(),
            "{airspeed} m/s"
        );
    }
    for path in [f64::NAN, f64::INFINITY] {
        assert!(
            Trim::at_speed(&Airframe::PAPER, 12.0, path).is_err(),
            "{path} rad"
        );
    }
    for broken in [
        Airframe {
            mass: f64::NAN,
            ..Airframe::PAPER
        },
        Airframe {
            lift_alpha: 0.0,
            ..Airframe::PAPER
        },
        Airframe {
            wing_area: 0.0,
            ..Airframe::PAPER
        },
        Airframe {
            moment_elevator: 0.0,
            ..Airframe::PAPER
        },
    ] {
        assert!(Trim::at_speed(&broken, 12.0, 0.0).is_err(), "{broken:?}");
    }
}

#[test]
fn a_failed_trim_names_its_cause() {
    let paper = Airframe::PAPER;
    for airspeed in [-12.0, 0.0, f64::NAN, f64::INFINITY] {
        let failed = Trim::at_speed(&paper, airspeed, 0.0);
        assert_eq!(failed, Err(TrimError::Airspeed));
    }
    let failed = Trim::at_speed(&paper, 12.0, f64::NAN);
    assert_eq!(failed, Err(TrimError::Angle));
    let heavy = Airframe {
        mass: f64::NAN,
        ..paper
    };
    let failed = Trim::at_speed(&heavy, 12.0, 0.0);
    assert_eq!(failed, Err(TrimError::Airframe));
    let loose = Airframe {
        moment_elevator: 0.0,
        ..paper
    };
    let failed = Trim::at_speed(&loose, 12.0, 0.0);
    assert_eq!(failed, Err(TrimError::NoElevator));
    let failed = Trim::at_angle_of_attack(&paper, -0.5);
    assert_eq!(failed, Err(TrimError::NotCarried));
    let failed = Trim::at_speed(&paper, 1.0, 0.0);
    assert_eq!(failed, Err(TrimError::NotConverged));
}
