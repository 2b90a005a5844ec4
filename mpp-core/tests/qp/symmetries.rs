//! Tests programs that are another program in other units or upside down, and their optima.

use super::programs::{Draw, Setup};
use super::small_programs::{difference, number};
use mpp_core::config::STAGES;
use mpp_core::qp::{
    Bounds, Condensed, Penalty, Problem, ROWS, RowKind, Solution, Solver, StageControl, StageState,
    Status, Weights,
};

const PENALTY: Penalty = Penalty {
    linear: 50.0,
    quadratic: 200.0,
};

/// Hard and soft programs in turn, in equal numbers.
fn programs(seed: u64, count: usize) -> impl Iterator<Item = (Setup, Problem)> {
    let mut draw = Draw::new(seed);
    (0..count).map(move |index| {
        let [reference, paper, flight] = Setup::all();
        let setup = match index % 3 {
            0 => reference,
            1 => paper,
            _ => flight,
        };
        let problem = Problem {
            penalty: (index % 2 == 0).then_some(PENALTY),
            ..setup.program(&mut draw)
        };
        (setup, problem)
    })
}

fn solve(solver: &mut Solver, shared: &Condensed, problem: &Problem) -> (Status, Solution) {
    let mut solution = Solution::new();
    match solver.solve(shared, problem) {
        Status::Optimal => (solver.solution(shared, &mut solution), solution),
        status => (status, solution),
    }
}

/// The condensed program with weights and prices times a factor.
fn scaled(setup: &Setup, problem: &Problem, factor: f64) -> (Box<Condensed>, Problem) {
    let weights = Weights {
        control: setup.weights.control.map(|weight| factor * weight),
        terminal: factor * setup.weights.terminal,
    };
    let mut shared = Box::new(Condensed::new());
    shared.condense(&setup.model.dynamics(), &weights).unwrap();
    let penalty = problem.penalty.map(|penalty| Penalty {
        linear: factor * penalty.linear,
        quadratic: factor * penalty.quadratic,
    });
    (
        shared,
        Problem {
            penalty,
            ..*problem
        },
    )
}

#[test]
fn weights_and_prices_in_another_unit_change_nothing_but_the_cost() {
    let mut solver = Box::new(Solver::new());
    let mut optimal = [0; 2];
    for (setup, problem) in programs(60, 120) {
        let (status, best) = solve(&mut solver, &setup.shared, &problem);
        for factor in [1e-3, 0.3, 7.0, 1e4] {
            let (shared, problem) = scaled(&setup, &problem, factor);
            let (again, other) = solve(&mut solver, &shared, &problem);
            assert_eq!(again, status);
            if status == Status::Optimal {
                // Rows are chosen in the same order, so that only rounding differs.
                assert!((other.cost / factor - best.cost).abs() <= 1e-9 * best.cost);
                assert!(difference(&other.controls, &best.controls) <= 1e-9);
                optimal[usize::from(problem.penalty.is_some())] += 1;
            }
        }
    }
    assert!(optimal[0] >= 80 && optimal[1] == 240);
}

#[test]
fn sixteen_times_the_weights_give_the_same_bits() {
    // Nothing is rounded differently: the fourth root of sixteen is a power of two as well.
    let mut solver = Box::new(Solver::new());
    for (setup, problem) in programs(61, 90) {
        let (status, best) = solve(&mut solver, &setup.shared, &problem);
        let iterations = solver.iterations();
        let multipliers: Vec<_> = solver.multipliers().collect();
        for factor in [16.0, 1.0 / 16.0] {
            let (shared, problem) = scaled(&setup, &problem, factor);
            let (again, mut other) = solve(&mut solver, &shared, &problem);
            assert_eq!((again, solver.iterations()), (status, iterations));
            if status == Status::Optimal {
                other.cost /= factor;
                assert_eq!(other, best);
                let unscaled = solver.multipliers().map(|(row, y)| (row, y / factor));
                assert_eq!(unscaled.collect::<Vec<_>>(), multipliers);
            }
        }
    }
}

/// Turns a state upside down: height, pitch, pitch rate and flight path change sign.
fn mirrored_state([x, z, v, pitch, rate, path]: StageState) -> StageState {
    [x, -z, v, -pitch, -rate, -path]
}

/// Turns a control upside down: the elevator changes sign.
fn mirrored_control([elevator, thrust]: StageControl) -> StageControl {
    [-elevator, thrust]
}

/// The row that means for the mirrored flight what this row means for the flight itself.
fn mirrored_row(row: usize) -> usize {
    number(match RowKind::of(row) {
        RowKind::Position(knot, direction) => RowKind::Position(knot, (12 - direction) % 8),
        RowKind::Attitude(knot, which) => RowKind::Attitude(knot, (which + 2) % 4),
        RowKind::Thrust(stage, side) => RowKind::Thrust(stage, side),
    })
}

fn mirrored(setup: &Setup, problem: &Problem) -> (Box<Condensed>, Problem) {
    let mut model = setup.model;
    for row in 0..6 {
        let sign = |index: usize| mirrored_state([1.0; 6])[index];
        for col in 0..6 {
            model.a[(row, col)] *= sign(row) * sign(col);
        }
        for col in 0..2 {
            model.b[(row, col)] *= sign(row) * mirrored_control([1.0; 2])[col];
        }
    }
    let mut shared = Box::new(Condensed::new());
    shared.condense(&model.dynamics(), &setup.weights).unwrap();
    let mut bounds = Bounds::none();
    for row in 0..ROWS {
        bounds.0[mirrored_row(row)] = problem.bounds.0[row];
    }
    let [hard_up, hard_down] = problem.hard_angle_of_attack;
    let problem = Problem {
        initial: mirrored_state(problem.initial),
        target: mirrored_state(problem.target),
        bounds,
        hard_angle_of_attack: [hard_down, hard_up],
        ..*problem
    };
    (shared, problem)
}

#[test]
fn the_mirrored_program_has_the_mirrored_optimum() {
    let mut solver = Box::new(Solver::new());
    // The face above leans by 1e-8 and the face below does not. Over tens of metres, mirrored faces
    // are up to 1e-6 m away from their right places.
    let mut optimal = [0; 2];
    for (setup, problem) in programs(62, 240) {
        let (status, best) = solve(&mut solver, &setup.shared, &problem);
        let (shared, reflection) = mirrored(&setup, &problem);
        let (again, other) = solve(&mut solver, &shared, &reflection);
        // The leaning face decides whether a contradiction is one up to rounding.
        let none = |status| matches!(status, Status::Infeasible | Status::TooDear);
        assert!(again == status || none(again) && none(status));
        if status == Status::Optimal {
            let back: [StageControl; STAGES] = other.controls.map(mirrored_control);
            assert!((other.cost - best.cost).abs() <= 1e-7 * best.cost);
            assert!(difference(&back, &best.controls) <= 1e-6);
            optimal[usize::from(problem.penalty.is_some())] += 1;
        }
    }
    assert!(optimal[0] >= 80 && optimal[1] == 120);
}
