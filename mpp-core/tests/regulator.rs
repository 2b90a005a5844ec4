//! Tests the Riccati solution against its equation, and the regulator against its properties.

use crate::common::seeded::{named, seeded};
use mpp_core::control::{Lqr, LqrWeights, RiccatiError, solve_riccati};
use mpp_core::vehicle::{
    AirState, Airframe, Control, JacobianForm, Linearization, Trim, linearize,
};
use nalgebra::{Matrix4, Vector4};
use proptest::prelude::*;

/// Residual of the Riccati equation, relative to its largest term.
const RESIDUAL: f64 = 1e-9;

fn largest_real_part(matrix: &Matrix4<f64>) -> f64 {
    matrix
        .complex_eigenvalues()
        .iter()
        .map(|value| value.re)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Largest entry of `A'X + XA - XGX + Q`, relative to the largest term.
fn residual(a: &Matrix4<f64>, g: &Matrix4<f64>, q: &Matrix4<f64>, x: &Matrix4<f64>) -> f64 {
    let scale = (x * a).amax().max((x * g * x).amax()).max(q.amax());
    (a.transpose() * x + x * a - x * g * x + q).amax() / scale
}

/// The linearised aircraft about steady flight.
fn aircraft(airframe: &Airframe, airspeed: f64, path: f64) -> Option<Linearization> {
    let trim = Trim::at_speed(airframe, airspeed, path).ok()?;
    Some(linearize(
        airframe,
        &trim.state,
        trim.control,
        JacobianForm::Exact,
    ))
}

fn flights() -> impl Strategy<Value = Linearization> {
    (named(), 10.0..20.0, -0.3..0.3).prop_filter_map("no trim", |(airframe, v, path)| {
        aircraft(&airframe, v, path)
    })
}

fn matrices(size: f64) -> impl Strategy<Value = Matrix4<f64>> {
    prop::array::uniform16(-size..size).prop_map(|entries| Matrix4::from_row_slice(&entries))
}

fn closed_loop(linear: &Linearization, lqr: &Lqr) -> Matrix4<f64> {
    linear.a - linear.b.column(1) * lqr.gain
}

/// The cost of a gain from a state on: the integral of `x'Qx + R u^2` by Runge and Kutta's rule.
fn cost_of(linear: &Linearization, lqr: &Lqr, weights: &LqrWeights, start: Vector4<f64>) -> f64 {
    const PERIOD: f64 = 2e-3;
    let loop_matrix = closed_loop(linear, lqr);
    let price = |x: &Vector4<f64>| {
        let elevator = (lqr.gain * x).x;
        let states: f64 = x.iter().zip(&weights.state).map(|(x, q)| q * x * x).sum();
        states + weights.elevator * elevator * elevator
    };
    let (mut x, mut cost) = (start, 0.0);
    for _ in 0..20_000 {
        let k1 = loop_matrix * x;
        let middle = x + k1 * (PERIOD / 2.0);
        let k2 = loop_matrix * middle;
        let k3 = loop_matrix * (x + k2 * (PERIOD / 2.0));
        let end = x + k3 * PERIOD;
        let k4 = loop_matrix * end;
        let next = x + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (PERIOD / 6.0);
        cost += PERIOD / 6.0 * (price(&x) + 4.0 * price(&((x + next) * 0.5)) + price(&next));
        x = next;
    }
    cost
}

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn the_solution_satisfies_the_equation_and_stabilises(linear in flights()) {
        let b: Vector4<f64> = linear.b.column(1).into();
        let q = Matrix4::from_diagonal(&Vector4::from(LqrWeights::PAPER.state));
        let g = b * b.transpose() / LqrWeights::PAPER.elevator;
        let solution = solve_riccati(&linear.a, &g, &q);
        prop_assert!(solution.is_ok(), "{solution:?}");
        let Ok(x) = solution else { return Ok(()) };
        prop_assert!(residual(&linear.a, &g, &q, &x) < RESIDUAL);
        prop_assert!(x == x.transpose());
        prop_assert!(x.cholesky().is_some(), "a cost-to-go is positive");
        prop_assert!(largest_real_part(&(linear.a - g * x)) < 0.0);
    }

    #[test]
    fn random_controllable_pairs_are_solved(
        a in matrices(3.0), b in prop::array::uniform4(0.3..2.0), root in matrices(2.0),
    ) {
        let b = Vector4::from(b);
        let reach = Matrix4::from_columns(&[b, a * b, a * a * b, a * a * a * b]);
        prop_assume!(reach.determinant().abs() > 1.0);
        let q = root * root.transpose() + Matrix4::identity() * 0.1;
        let g = b * b.transpose();
        let solution = solve_riccati(&a, &g, &q);
        prop_assert!(solution.is_ok(), "{solution:?}");
        let Ok(x) = solution else { return Ok(()) };
        let residual = residual(&a, &g, &q, &x);
        prop_assert!(residual < 1e-6, "residual {residual}");
        prop_assert!(largest_real_part(&(a - g * x)) < 0.0);
    }

    #[test]
    fn an_unstable_mode_out_of_reach_has_no_solution(
        growth in 0.05..3.0, rest in prop::array::uniform3(-3.0..1.0), turn in matrices(1.0),
    ) {
        // In coordinates where this is plain, the input does not touch the growing mode.
        let turn = turn + Matrix4::identity() * 5.0;
        let Some(back) = turn.try_inverse() else { return Ok(()) };
        let a = turn * Matrix4::from_diagonal(&Vector4::new(growth, rest[0], rest[1], rest[2])) * back;
        let b = turn * Vector4::new(0.0, 1.0, 1.0, 1.0);
        let solution = solve_riccati(&a, &(b * b.transpose()), &Matrix4::identity());
        prop_assert!(solution.is_err(), "{solution:?}");
    }
}

#[test]
fn a_stable_plant_without_an_input_has_the_cost_of_waiting() {
    // A'X + XA + Q = 0 with A = -1: X = Q / 2.
    let q = Matrix4::from_diagonal(&Vector4::new(1.0, 2.0, 3.0, 4.0));
    let x = solve_riccati(&-Matrix4::identity(), &Matrix4::zeros(), &q).unwrap();
    assert!((x - q * 0.5).amax() < 1e-12);
}

#[test]
fn numbers_that_are_none_are_refused() {
    let one = Matrix4::identity();
    let not = one * f64::NAN;
    for (a, g, q) in [(not, one, one), (one, not, one), (one, one, not)] {
        assert_eq!(solve_riccati(&a, &g, &q), Err(RiccatiError::NotFinite));
    }
    let endless = solve_riccati(&(one * f64::INFINITY), &one, &one);
    assert_eq!(endless, Err(RiccatiError::NotFinite));
}

#[test]
fn an_elevator_without_effect_gives_no_gain() {
    let airframe = Airframe::REFERENCE;
    let mut linear = aircraft(&airframe, 12.0, 0.0).unwrap();
    linear.b.fill(0.0);
    linear.a[(0, 0)] = 0.5;
    let refused: Result<Lqr, RiccatiError> = Lqr::design(&linear, &LqrWeights::PAPER);
    assert_eq!(refused, Err(RiccatiError::NotStabilising));
}

#[test]
fn no_other_gain_costs_less() {
    let weights = LqrWeights::PAPER;
    for airframe in [Airframe::PAPER, Airframe::REFERENCE] {
        let linear = aircraft(&airframe, 12.0, 0.0).unwrap();
        let lqr = Lqr::design(&linear, &weights).unwrap();
        for start in [
            Vector4::new(1.0, 0.0, 0.0, 0.0),
            Vector4::new(0.0, 0.2, 0.0, 0.0),
            Vector4::new(-0.5, 0.1, 0.5, 0.1),
        ] {
            let best = cost_of(&linear, &lqr, &weights, start);
            for index in 0..4 {
                for factor in [0.9, 1.1] {
                    let mut other = lqr;
                    other.gain[index] *= factor;
                    let cost = cost_of(&linear, &other, &weights, start);
                    assert!(cost >= best * (1.0 - 1e-6), "gain {index}: {cost} < {best}");
                }
            }
        }
    }
}

#[test]
fn the_cost_to_go_is_what_is_still_to_be_paid() {
    let weights = LqrWeights::PAPER;
    let linear = aircraft(&Airframe::REFERENCE, 12.0, 0.0).unwrap();
    let lqr = Lqr::design(&linear, &weights).unwrap();
    let b: Vector4<f64> = linear.b.column(1).into();
    let q = Matrix4::from_diagonal(&Vector4::from(weights.state));
    let to_go = solve_riccati(&linear.a, &(b * b.transpose() / weights.elevator), &q).unwrap();
    let mut x = Vector4::new(0.5, 0.1, -0.3, 0.15);
    let paid = cost_of(&linear, &lqr, &weights, x);
    let promised = (x.transpose() * to_go * x).x;
    // The slowest mode has not quite ended after the 40 s of the sum.
    assert!(
        (paid - promised).abs() < 1e-3 * promised,
        "{paid} against {promised}"
    );
    let mut last = promised;
    for _ in 0..2_000 {
        x += closed_loop(&linear, &lqr) * x * 1e-3;
        let cost = (x.transpose() * to_go * x).x;
        assert!(cost < last, "the cost-to-go rose from {last} to {cost}");
        last = cost;
    }
}

#[test]
fn the_elevator_works_against_the_error_and_thrust_passes() {
    let linear = aircraft(&Airframe::REFERENCE, 12.0, 0.0).unwrap();
    let lqr = Lqr::design(&linear, &LqrWeights::PAPER).unwrap();
    let feedforward = Control {
        thrust: 4.5,
        elevator: 3.0,
    };
    let level = AirState {
        airspeed: 12.0,
        ..AirState::default()
    };
    assert_eq!(lqr.track(&level, &level, feedforward), feedforward);
    let sinking = AirState {
        flight_path: -0.1,
        ..level
    };
    let corrected = lqr.track(&sinking, &level, feedforward);
    assert!(
        corrected.elevator > feedforward.elevator,
        "a sinking aircraft is pitched up"
    );
    assert!((corrected.thrust - feedforward.thrust).abs() < 1e-15);
}
