//! Tests the conditions of Karush, Kuhn and Tucker, evaluated with the model alone.

use super::programs::{Draw, Setup, is_constant, left_hand_side, priced, softens, violations};
use mpp_core::config::STAGES;
use mpp_core::qp::{Penalty, Problem, ROWS, Solution, Solver};

/// Largest entry of a gradient that should vanish, relative to the largest term of its sum.
const STATIONARY: f64 = 1e-7;
/// Limit up to which rows with a multiplier are tight, and other rows hold [m, rad, N].
const TIGHT: f64 = 1e-7;

/// Checks that cost and weighted rows balance.
fn assert_stationary(setup: &Setup, problem: &Problem, solution: &Solution, solver: &Solver) {
    let controls = &solution.controls;
    let mut sum = setup.gradient(controls, |controls| setup.cost(problem, controls));
    let mut scale = sum
        .iter()
        .fold(1.0_f64, |most, entry| most.max(entry.abs()));
    for (row, multiplier) in solver.multipliers() {
        let gradient = setup.gradient(controls, |controls| {
            left_hand_side(row, &setup.roll_out(&problem.initial, controls), controls)
        });
        for (sum, entry) in sum.iter_mut().zip(&gradient) {
            *sum += multiplier * entry;
            scale = scale.max((multiplier * entry).abs());
        }
    }
    let rest = sum
        .iter()
        .fold(0.0_f64, |most, entry| most.max(entry.abs()));
    assert!(rest <= STATIONARY * scale, "{rest} is left of {scale}");
}

fn multipliers(solver: &Solver) -> [f64; ROWS] {
    let mut all = [0.0; ROWS];
    for (row, multiplier) in solver.multipliers() {
        all[row] += multiplier;
    }
    all
}

#[test]
fn hard_optima_meet_the_optimality_conditions() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(10);
    let mut optimal = 0;
    for setup in Setup::all().iter().cycle().take(300) {
        let problem = setup.program(&mut draw);
        let Some(solution) = setup.optimum(&mut solver, &problem) else {
            continue;
        };
        optimal += 1;
        assert_stationary(setup, &problem, &solution, &solver);
        let multipliers = multipliers(&solver);
        for (row, violation) in violations(&problem, &solution).into_iter().enumerate() {
            assert!(
                multipliers[row] >= 0.0 && violation <= TIGHT,
                "row {row}: {violation}"
            );
            assert!(
                multipliers[row] <= 0.0 || violation >= -TIGHT,
                "row {row}: {violation}"
            );
        }
    }
    assert!(optimal >= 100);
}

#[test]
fn soft_optima_meet_the_optimality_conditions() {
    let penalty = Penalty {
        linear: 50.0,
        quadratic: 200.0,
    };
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(11);
    let (mut tight, mut yielding) = (0, 0);
    for setup in Setup::all().iter().cycle().take(300) {
        let problem = Problem {
            penalty: Some(penalty),
            ..setup.program(&mut draw)
        };
        let solution = setup.optimum(&mut solver, &problem).unwrap();
        assert_stationary(setup, &problem, &solution, &solver);
        let multipliers = multipliers(&solver);
        for (row, violation) in violations(&problem, &solution).into_iter().enumerate() {
            let multiplier = multipliers[row];
            if is_constant(row) {
                assert!(multiplier == 0.0, "row {row} is a constant");
            } else if softens(&problem, row) && violation > TIGHT {
                let price = penalty.linear + penalty.quadratic * violation;
                assert!(
                    (multiplier - price).abs() <= STATIONARY * price,
                    "row {row}"
                );
                yielding += 1;
            } else {
                assert!(
                    violation <= TIGHT && multiplier >= 0.0,
                    "row {row}: {violation}"
                );
                assert!(
                    !softens(&problem, row) || multiplier <= penalty.linear * (1.0 + STATIONARY)
                );
                assert!(
                    multiplier == 0.0 || violation >= -TIGHT,
                    "row {row}: {violation}"
                );
                tight += usize::from(multiplier > 0.0);
            }
        }
    }
    assert!(tight >= 100 && yielding >= 100);
}

#[test]
fn the_optimum_without_rows_costs_less_than_any_controls_near_it() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(12);
    for setup in &Setup::all() {
        let problem = Problem {
            bounds: mpp_core::qp::Bounds::none(),
            ..setup.program(&mut draw)
        };
        let solution = setup.optimum(&mut solver, &problem).unwrap();
        assert_eq!(solver.iterations(), 1);
        assert!((setup.cost(&problem, &solution.controls) - solution.cost).abs() < 1e-9);
        for _ in 0..200 {
            let mut moved = solution.controls;
            moved[draw.below(STAGES)][draw.below(2)] += draw.between(-0.5, 0.5);
            assert!(setup.cost(&problem, &moved) >= solution.cost);
        }
    }
}

#[test]
fn a_price_above_every_multiplier_keeps_the_hard_optimum() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(13);
    let mut compared = 0;
    for setup in Setup::all().iter().cycle().take(150) {
        let problem = setup.program(&mut draw);
        let Some(hard) = setup.optimum(&mut solver, &problem) else {
            continue;
        };
        let dearest = solver
            .multipliers()
            .fold(0.0_f64, |most, (_, y)| most.max(y));
        let penalty = Penalty {
            linear: 1.01 * dearest + 1.0,
            quadratic: 10.0,
        };
        let softened = Problem {
            penalty: Some(penalty),
            ..problem
        };
        let soft = setup.optimum(&mut solver, &softened).unwrap();
        assert!((priced(&problem, &soft, &penalty) - hard.cost).abs() <= 1e-8 * hard.cost.max(1.0));
        assert!(soft.violation <= TIGHT);
        compared += 1;
    }
    assert!(compared >= 50);
}
