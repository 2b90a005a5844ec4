//! Tests the point mass against the equations of motion, differences, and its own limit of small
//! steps.

use crate::common::seeded::{named, seeded};
use mpp_core::vehicle::{
    Airframe, PathControl, PathState, Trim, VehicleState, air_rate, vehicle_rate,
};
use nalgebra::{Matrix5, SMatrix, Vector5};
use proptest::prelude::*;

type Vector = Vector5<f64>;

/// Half a step of the central differences.
const STEP: f64 = 1e-4;

/// The named airframes, with lift by rates.
fn airframes() -> impl Strategy<Value = Airframe> {
    let numbers = (-0.1..0.2, -0.1..0.2);
    (named(), numbers).prop_map(|(base, (lift_alpha_rate, lift_pitch_rate))| Airframe {
        lift_alpha_rate,
        lift_pitch_rate,
        ..base
    })
}

fn states() -> impl Strategy<Value = PathState> {
    (8.0..20.0, -0.6..0.6, -0.2..0.4).prop_map(|(airspeed, flight_path, angle_of_attack)| {
        PathState {
            x: 3.0,
            z: 50.0,
            airspeed,
            flight_path,
            angle_of_attack,
        }
    })
}

fn controls() -> impl Strategy<Value = PathControl> {
    (-1.0..1.0, 0.0..20.0).prop_map(|(angle_of_attack_rate, thrust)| PathControl {
        angle_of_attack_rate,
        thrust,
    })
}

fn vector(state: &PathState) -> Vector {
    Vector::new(
        state.x,
        state.z,
        state.airspeed,
        state.flight_path,
        state.angle_of_attack,
    )
}

fn state(vector: &Vector) -> PathState {
    let [x, z, airspeed, flight_path, angle_of_attack] = (*vector).into();
    PathState {
        x,
        z,
        airspeed,
        flight_path,
        angle_of_attack,
    }
}

fn input(control: [f64; 2]) -> PathControl {
    PathControl {
        angle_of_attack_rate: control[0],
        thrust: control[1],
    }
}

/// Derivatives of a function of state and control by central differences.
fn differences(
    function: impl Fn(&PathState, &PathControl) -> PathState,
    at: &PathState,
    control: &PathControl,
) -> (Matrix5<f64>, SMatrix<f64, 5, 2>) {
    let controls = [control.angle_of_attack_rate, control.thrust];
    let of = |x: Vector, u: [f64; 2]| vector(&function(&state(&x), &input(u)));
    let (mut a, mut b) = (Matrix5::zeros(), SMatrix::<f64, 5, 2>::zeros());
    for index in 0..5 {
        let mut step = Vector::zeros();
        step[index] = STEP;
        let change = of(vector(at) + step, controls) - of(vector(at) - step, controls);
        a.set_column(index, &(change / (2.0 * STEP)));
    }
    for index in 0..2 {
        let (mut above, mut below) = (controls, controls);
        above[index] += STEP;
        below[index] -= STEP;
        let change = of(vector(at), above) - of(vector(at), below);
        b.set_column(index, &(change / (2.0 * STEP)));
    }
    (a, b)
}

proptest! {
    #![proptest_config(seeded())]

    /// The balanced reference moves as the whole vehicle does, and its moments are in balance.
    #[test]
    fn the_reference_is_a_motion_of_the_vehicle_with_moments_in_balance(
        airframe in airframes(), at in states(), control in controls(),
    ) {
        let rate = at.rate(&airframe, &control);
        let (whole, feedforward) = at.reference(&airframe, &control);
        prop_assert_eq!((whole.x, whole.z), (at.x, at.z));
        let back = PathState::of(&whole);
        prop_assert!((vector(&back) - vector(&at)).amax() < 1e-15);
        let moved = vehicle_rate(&airframe, &whole, feedforward);
        for (point_mass, vehicle) in [
            (rate.x, moved.x),
            (rate.z, moved.z),
            (rate.airspeed, moved.air.airspeed),
            (rate.flight_path, moved.air.flight_path),
            (rate.flight_path + rate.angle_of_attack, moved.air.pitch),
        ] {
            prop_assert!((point_mass - vehicle).abs() < 1e-11, "{point_mass} {vehicle}");
        }
        // The angular acceleration is 0. The elevator alone would give hundreds.
        prop_assert!(moved.air.pitch_rate.abs() < 1e-9, "{}", moved.air.pitch_rate);
        let mut more = feedforward;
        more.elevator += 0.1;
        prop_assert!(air_rate(&airframe, &whole.air, more).pitch_rate > 0.1);
    }

    #[test]
    fn the_jacobian_equals_central_differences(
        airframe in airframes(), at in states(), control in controls(),
    ) {
        let rate = |x: &PathState, u: &PathControl| x.rate(&airframe, u);
        let (a, b) = at.jacobian(&airframe, &control);
        let (expected_a, expected_b) = differences(rate, &at, &control);
        let scale = expected_a.amax().max(1.0);
        prop_assert!((a - expected_a).amax() < 1e-7 * scale, "{a} {expected_a}");
        prop_assert!((b - expected_b).amax() < 1e-7 * scale, "{b} {expected_b}");
    }

    /// The method is of second order: its error over one stage is of the third order in the length.
    #[test]
    fn the_sensitivity_is_of_second_order(
        airframe in airframes(), at in states(), control in controls(),
    ) {
        let error = |dt: f64| {
            let end = |x: &PathState, u: &PathControl| x.after(&airframe, u, dt, 40);
            let (a, b) = at.sensitivity(&end(&at, &control), &airframe, &control, dt);
            let (expected_a, expected_b) = differences(end, &at, &control);
            [(a - expected_a).amax(), (b - expected_b).amax()]
        };
        let (coarse, fine) = (error(0.05), error(0.025));
        prop_assert!(fine[0] < 0.2 * coarse[0], "{coarse:?} -> {fine:?}");
        // With a method of the first order it would be 1e-3 and more.
        prop_assert!(fine[1] < 1e-4, "{fine:?}");
    }

    #[test]
    fn the_roll_out_is_of_fourth_order(
        airframe in airframes(), at in states(), control in controls(),
    ) {
        let after = |steps: u8| vector(&at.after(&airframe, &control, 0.25, steps));
        let exact = after(200);
        let error = |steps: u8| (after(steps) - exact).amax();
        // Plans are made with one step a stage.
        prop_assert!(error(1) < 5e-3, "{}", error(1));
        prop_assert!(error(2) < error(1) / 6.0 + 1e-12, "{} {}", error(1), error(2));
        prop_assert!(error(8) < error(4) / 10.0 + 1e-12, "{} {}", error(4), error(8));
    }

    #[test]
    fn roll_outs_in_a_row_are_one_roll_out(
        airframe in airframes(), at in states(), control in controls(),
    ) {
        let half = at.after(&airframe, &control, 0.1, 3);
        let whole = at.after(&airframe, &control, 0.2, 6);
        let twice = half.after(&airframe, &control, 0.1, 3);
        prop_assert!((vector(&twice) - vector(&whole)).amax() < 1e-11);
        prop_assert_eq!(at.after(&airframe, &control, 0.2, 0), at.after(&airframe, &control, 0.2, 1));
    }
}

#[test]
fn trim_stays_trim() {
    let airframe = Airframe::REFERENCE;
    let trim = Trim::at_speed(&airframe, 12.0, 0.0).unwrap();
    let start = PathState::of(&VehicleState {
        x: 0.0,
        z: 50.0,
        air: trim.state,
    });
    let control = PathControl {
        angle_of_attack_rate: 0.0,
        thrust: trim.control.thrust,
    };
    let end = start.after(&airframe, &control, 4.5, 36);
    assert!((end.x - 54.0).abs() < 1e-9 && (end.z - 50.0).abs() < 1e-9);
    assert!((start.reference(&airframe, &control).1.elevator - trim.control.elevator).abs() < 1e-9);
}

#[test]
fn stopping_in_the_air_stays_finite() {
    let still = PathState {
        flight_path: 1.5,
        airspeed: 3.0,
        ..PathState::default()
    };
    let end = still.after(&Airframe::PAPER, &PathControl::default(), 2.0, 16);
    assert!(vector(&end).iter().all(|value| value.is_finite()));
    assert!(end.airspeed >= 3.0);
}
