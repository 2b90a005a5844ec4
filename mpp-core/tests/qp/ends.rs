//! Tests how solves end: limits, caps, constants, contradictions and values that are no numbers.

use super::programs::{Draw, Setup, priced, violations};
use mpp_core::config::DIRECTIONS;
use mpp_core::corridor::DIRECTION_VECTORS;
use mpp_core::qp::{MAX_ITERATIONS, Penalty, Problem, ROWS, RowKind, Solution, Solver, Status};

const PENALTY: Penalty = Penalty {
    linear: 1e4,
    quadratic: 1e3,
};

fn row(kind: RowKind) -> usize {
    (0..ROWS).find(|row| RowKind::of(*row) == kind).unwrap()
}

/// Whether a solve stops at its cost limit. An optimum without rows is found before the limit is
/// checked.
fn is_dominated(solver: &mut Solver, setup: &Setup, problem: &Problem) -> bool {
    match solver.solve(&setup.shared, problem) {
        Status::Dominated => true,
        Status::Optimal => solver.iterations() == 1,
        _ => false,
    }
}

#[test]
fn a_cost_limit_dominates_exactly_the_optima_above_it() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(20);
    let mut limited = 0;
    for setup in Setup::all().iter().cycle().take(200) {
        let problem = setup.program(&mut draw);
        let Some(best) = setup.optimum(&mut solver, &problem) else {
            continue;
        };
        for share in [0.5, 0.99, 1.0 - 1e-7] {
            let below = Problem {
                cost_limit: share * best.cost,
                ..problem
            };
            assert!(is_dominated(&mut solver, setup, &below));
            limited += usize::from(solver.iterations() > 1);
        }
        for share in [1.0 + 1e-7, 1.5] {
            let above = Problem {
                cost_limit: share * best.cost,
                ..problem
            };
            assert_eq!(setup.optimum(&mut solver, &above), Some(best));
        }
    }
    assert!(limited >= 100);
}

#[test]
fn a_cost_limit_never_dominates_a_soft_program_below_it() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(21);
    for setup in Setup::all().iter().cycle().take(200) {
        let problem = Problem {
            penalty: Some(PENALTY),
            ..setup.program(&mut draw)
        };
        let best = setup.optimum(&mut solver, &problem).unwrap();
        let price = priced(&problem, &best, &PENALTY);
        let above = Problem {
            cost_limit: price * (1.0 + 1e-7),
            ..problem
        };
        assert_eq!(setup.optimum(&mut solver, &above), Some(best));
        let below = Problem {
            cost_limit: price * (1.0 - 1e-7),
            ..problem
        };
        assert!(is_dominated(&mut solver, setup, &below));
    }
}

#[test]
fn no_random_program_comes_near_the_cap() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(22);
    let (mut worst, mut full) = ([0; 2], 0);
    for (index, setup) in Setup::all().iter().cycle().take(6_000).enumerate() {
        let problem = Problem {
            penalty: (index % 2 == 1).then_some(PENALTY),
            ..setup.program(&mut draw)
        };
        let status = solver.solve(&setup.shared, &problem);
        let kinds = problem.bounds.0.iter().enumerate();
        let most_thrust = kinds
            .filter(|(_, bound)| bound.is_finite())
            .any(|(row, _)| matches!(RowKind::of(row), RowKind::Thrust(_, 0)));
        match status {
            Status::Optimal | Status::Infeasible | Status::TooDear => {}
            // Where all faces yield and thrusts meet their limits, there can be more active rows than there is room for.
            Status::IterationLimit if index % 2 == 1 && most_thrust => full += 1,
            other => panic!("{other:?}"),
        }
        worst[index % 2] = worst[index % 2].max(solver.iterations());
    }
    println!("worst iterations, hard and soft: {worst:?}; without room: {full}");
    assert!(full <= 1 && 2 * worst[0] <= MAX_ITERATIONS && worst[1] < MAX_ITERATIONS);
}

#[test]
fn hard_rows_that_contradict_each_other_have_no_optimum_with_a_price() {
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    for setup in Setup::all() {
        let mut no_thrust = Problem::EMPTY;
        no_thrust.bounds.set_thrust([-1.0, -1.0]);
        let mut no_attack = Problem::EMPTY;
        (no_attack.bounds).set_attitude([-0.1, f64::INFINITY], [0.1, f64::NEG_INFINITY]);
        no_attack.hard_angle_of_attack = [true; 2];
        for mut problem in [no_thrust, no_attack] {
            problem.penalty = Some(PENALTY);
            solver.solve(&setup.shared, &problem);
            assert!(solver.iterations() <= MAX_ITERATIONS);
            let status = solver.solution(&setup.shared, &mut solution);
            assert!(
                matches!(
                    status,
                    Status::Infeasible | Status::NumericalFailure | Status::IterationLimit
                ),
                "{status:?}"
            );
        }
    }
}

#[test]
fn rows_that_no_control_changes_decide_at_once() {
    let setup = Setup::paper();
    let mut solver = Box::new(Solver::new());
    for knot in 0..2 {
        for (direction, [up, forward]) in DIRECTION_VECTORS.iter().enumerate() {
            let mut problem = Problem::EMPTY;
            problem.initial = [0.5, -0.25, 0.0, 0.0, 0.0, 0.0];
            let value = forward * 0.5 - up * 0.25;
            let row = row(RowKind::Position(knot, direction));
            problem.bounds.0[row] = value + 1e-6;
            assert_eq!(solver.solve(&setup.shared, &problem), Status::Optimal);
            problem.bounds.0[row] = value - 1e-6;
            assert_eq!(solver.solve(&setup.shared, &problem), Status::Infeasible);
            assert_eq!(solver.iterations(), 0);
            assert_eq!(solver.multipliers().collect::<Vec<_>>(), [(row, 1.0)]);

            problem.penalty = Some(PENALTY);
            let soft = setup.optimum(&mut solver, &problem).unwrap();
            assert!(
                soft.violation == 0.0,
                "a constant is not the plan's to violate"
            );
        }
    }
}

#[test]
fn opposite_faces_may_touch_but_not_cross() {
    for setup in &Setup::all() {
        let mut solver = Box::new(Solver::new());
        for (knot, face) in (3..=18).flat_map(|knot| (0..4).map(move |face| (knot, face))) {
            let opposite = row(RowKind::Position(knot, face + DIRECTIONS / 2));
            // The faces above and below are opposite to 1e-8 only. Where they cross by less than
            // 1e-5, there is room far to the side.
            let least = if face == 0 {
                Status::Optimal
            } else {
                Status::Infeasible
            };
            let face = row(RowKind::Position(knot, face));
            let mut problem = Problem::EMPTY;
            problem.bounds.0[face] = 0.4;
            for (gap, expected) in [
                (1e-3, Status::Optimal),
                (1e-7, Status::Optimal),
                (-1e-7, least),
                (-1e-3, Status::Infeasible),
            ] {
                problem.bounds.0[opposite] = gap - 0.4;
                let status = solver.solve(&setup.shared, &problem);
                assert_eq!(status, expected, "knot {knot}, gap {gap}");
            }
            problem.bounds.0[opposite] = -0.4;
            problem.bounds.0[face] = -0.2;
            problem.penalty = Some(PENALTY);
            let soft = setup.optimum(&mut solver, &problem).unwrap();
            let violations = violations(&problem, &soft);
            assert!((violations[face] + violations[opposite] - 0.6).abs() < 1e-7);
            assert!(
                violations[face] > 0.25 && violations[opposite] > 0.25,
                "both give way"
            );
        }
    }
}

#[test]
fn numbers_that_are_none_fail_and_do_not_stick() {
    let setup = Setup::flight();
    let mut solver = Box::new(Solver::new());
    let problem = setup.program(&mut Draw::new(23));
    let healthy = solver.solve(&setup.shared, &problem);
    let mut broken = vec![];
    for index in 0..6 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut initial = problem;
            initial.initial[index] = bad;
            let mut target = problem;
            target.target[index] = bad;
            broken.extend([initial, target]);
        }
    }
    for row in 0..ROWS {
        let mut bound = problem;
        bound.bounds.0[row] = f64::NAN;
        broken.push(bound);
    }
    for problem in &broken {
        assert_eq!(
            solver.solve(&setup.shared, problem),
            Status::NumericalFailure
        );
        assert_ne!(
            solver.solution(&setup.shared, &mut Solution::new()),
            Status::Optimal
        );
    }
    assert_eq!(solver.solve(&setup.shared, &problem), healthy);
}

#[test]
fn a_bound_of_minus_infinity_is_never_kept() {
    let setup = Setup::flight();
    let mut solver = Box::new(Solver::new());
    for row in 0..ROWS {
        let mut problem = Problem::EMPTY;
        problem.bounds.0[row] = f64::NEG_INFINITY;
        assert_eq!(
            solver.solve(&setup.shared, &problem),
            Status::Infeasible,
            "row {row}"
        );
    }
}
