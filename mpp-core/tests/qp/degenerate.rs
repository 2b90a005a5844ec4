//! Tests rows that coincide, touch, oppose each other exactly or do nothing. The solver ends, and
//! its answer is true.

use super::conditions::{ACCEPTED, assert_contradiction, assert_optimal};
use super::dense::DenseProgram;
use super::programs::{Draw, Setup, is_constant, left_hand_side};
use super::small_programs::{any_row, difference, number};
use mpp_core::config::STAGES;
use mpp_core::qp::{
    Bounds, Dynamics, MAX_ITERATIONS, Penalty, Problem, ROWS, RowKind, Solution, Solver,
    StageControl, Status,
};

const PENALTY: Penalty = Penalty {
    linear: 50.0,
    quadratic: 200.0,
};
/// Differences of controls [elevator, N] and of relative costs between two programs that differ
/// only in the faces' directions, which are horizontal or upright to 1e-8 only.
const SAME: f64 = 1e-7;
/// Difference of relative costs where nearly every control is pinned. Multipliers are large then,
/// and rows may be missed by 1e-9.
const PINNED: f64 = 1e-5;

/// Solves, and checks any result: it came in time, and it is an optimum or a proof.
fn proved(solver: &mut Solver, setup: &Setup, problem: &Problem) -> (Status, Solution) {
    let mut solution = Solution::new();
    let status = solver.solve(&setup.shared, problem);
    assert!(solver.iterations() < MAX_ITERATIONS);
    let dense = DenseProgram::new(&[setup.model.dynamics(); STAGES], &setup.weights, problem);
    if matches!(status, Status::Infeasible | Status::TooDear) {
        assert_contradiction(&dense, solver);
    } else {
        assert_eq!(
            solver.solution(&setup.shared, &mut solution),
            Status::Optimal
        );
        assert_optimal(&dense, problem.penalty, solver, &solution, ACCEPTED);
    }
    (status, solution)
}

fn optimum(solver: &mut Solver, setup: &Setup, problem: &Problem) -> Solution {
    let (status, solution) = proved(solver, setup, problem);
    assert_eq!(status, Status::Optimal);
    solution
}

fn assert_same(a: &Solution, b: &Solution) {
    assert!((a.cost - b.cost).abs() <= SAME * b.cost.max(1.0));
    assert!(difference(&a.controls, &b.controls) <= SAME);
}

/// A program with a random start and target and no rows.
fn bare(setup: &Setup, draw: &mut Draw) -> Problem {
    Problem {
        bounds: Bounds::none(),
        hard_angle_of_attack: [false; 2],
        ..setup.program(draw)
    }
}

fn values(setup: &Setup, problem: &Problem, controls: &[StageControl; STAGES]) -> [f64; ROWS] {
    let states = setup.roll_out(&problem.initial, controls);
    core::array::from_fn(|row| left_hand_side(row, &states, controls))
}

/// Four ways to choose kinds of rows that leave one trajectory or a few.
fn is_chosen(way: usize, row: usize) -> bool {
    let kind = RowKind::of(row);
    !is_constant(row)
        && match way % 4 {
            0 => true,
            1 => matches!(kind, RowKind::Position(..)),
            2 => matches!(kind, RowKind::Position(..) | RowKind::Thrust(..)),
            _ => matches!(kind, RowKind::Attitude(knot, _) if knot % 3 == 0),
        }
}

/// Calls `check` with programs whose chosen rows are all met exactly by one flight, and with its
/// cost.
fn for_each_pinned_program(
    seed: u64,
    count: usize,
    mut check: impl FnMut(&Setup, &Problem, usize, f64, &mut Draw),
) {
    let mut draw = Draw::new(seed);
    for (index, setup) in Setup::all().iter().cycle().take(count).enumerate() {
        let mut problem = bare(setup, &mut draw);
        let controls = core::array::from_fn(|_| [0; 2].map(|_| draw.between(-0.5, 0.5)));
        let values = values(setup, &problem, &controls);
        for row in (0..ROWS).filter(|row| is_chosen(index / 3, *row)) {
            problem.bounds.0[row] = values[row];
        }
        let cost = setup.cost(&problem, &controls);
        check(setup, &problem, index / 3, cost, &mut draw);
    }
}

#[test]
fn faces_and_limits_that_touch_exactly_leave_their_one_flight() {
    let mut solver = Box::new(Solver::new());
    for_each_pinned_program(50, 180, |setup, problem, way, cost, _| {
        let best = optimum(&mut solver, setup, problem);
        assert!(best.cost <= cost * (1.0 + SAME));
        // Attitudes pin every control that affects the target; positions leave the last one free.
        assert!(way % 4 != 0 || best.cost >= cost * (1.0 - SAME));
    });
}

#[test]
fn pinned_rows_with_the_least_room_are_never_called_contradictory() {
    let mut solver = Box::new(Solver::new());
    for room in [1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4] {
        for_each_pinned_program(51, 60, |setup, problem, _, cost, draw| {
            let mut problem = *problem;
            for bound in &mut problem.bounds.0 {
                *bound += room * draw.unit();
            }
            assert!(optimum(&mut solver, setup, &problem).cost <= cost * (1.0 + SAME));
        });
    }
}

#[test]
fn attitudes_pinned_at_every_boundary_are_never_called_contradictory() {
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    let mut draw = Draw::new(59);
    let (mut programs, mut unproven) = (0, 0);
    for room in [0.0, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4, 1e-2] {
        for setup in Setup::all().iter().cycle().take(600) {
            let mut problem = bare(setup, &mut draw);
            let controls = core::array::from_fn(|_| [0; 2].map(|_| draw.between(-0.5, 0.5)));
            let values = values(setup, &problem, &controls);
            for row in (0..ROWS).filter(|row| matches!(RowKind::of(*row), RowKind::Attitude(..))) {
                problem.bounds.0[row] = values[row] + room * draw.unit();
            }
            let status = solver.solve(&setup.shared, &problem);
            assert_ne!(status, Status::Infeasible, "room {room}");
            programs += 1;
            if solver.solution(&setup.shared, &mut solution) != Status::Optimal {
                unproven += 1;
                continue;
            }
            let cost = setup.cost(&problem, &controls);
            assert!(solution.cost <= cost * (1.0 + PINNED), "room {room}");
        }
    }
    assert!(1000 * unproven <= programs, "{unproven} of {programs}");
}

#[test]
fn pinned_rows_that_cross_end_in_a_proof() {
    let mut solver = Box::new(Solver::new());
    for gap in [1e-7, 1e-6, 1e-4] {
        for_each_pinned_program(52, 60, |setup, problem, _, _, draw| {
            let mut problem = *problem;
            for bound in &mut problem.bounds.0 {
                *bound -= gap * (0.5 + draw.unit());
            }
            assert_ne!(proved(&mut solver, setup, &problem).0, Status::Optimal);
        });
    }
}

#[test]
fn pinned_soft_rows_end_in_their_optimum() {
    let mut solver = Box::new(Solver::new());
    for_each_pinned_program(53, 180, |setup, problem, _, cost, draw| {
        let mut problem = *problem;
        problem.penalty = Some(PENALTY);
        // Only some of the boundaries are used, because all of them are more rows than the solver
        // holds.
        let few = 3 + draw.below(4);
        for row in 0..ROWS {
            let (RowKind::Position(knot, _) | RowKind::Attitude(knot, _)) = RowKind::of(row) else {
                continue;
            };
            if knot % few != 0 {
                problem.bounds.0[row] = f64::INFINITY;
            }
        }
        assert!(optimum(&mut solver, setup, &problem).cost <= cost * (1.0 + SAME));
    });
}

#[test]
fn rows_that_say_the_same_count_once() {
    // The first climb and the first thrust each reach the second position alone, through one
    // number. So all its faces on one side, and a limit, are the same row.
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(54);
    for setup in Setup::all().iter().cycle().take(60) {
        let mut problem = bare(setup, &mut draw);
        let free = optimum(&mut solver, setup, &problem);
        let mut less = free.controls;
        less[0][1] += draw.between(0.05, 1.0);
        let values = values(setup, &problem, &less);
        let thrust = number(RowKind::Thrust(0, 1));
        problem.bounds.0[thrust] = values[thrust];
        let alone = optimum(&mut solver, setup, &problem);
        assert!(alone.cost > free.cost);
        for direction in 4..8 {
            let row = number(RowKind::Position(2, direction));
            problem.bounds.0[row] = values[row];
        }
        let row = number(RowKind::Attitude(1, 3));
        problem.bounds.0[row] = values[row];
        assert_same(&optimum(&mut solver, setup, &problem), &alone);
        problem.bounds.0[thrust] = f64::INFINITY;
        assert_same(&optimum(&mut solver, setup, &problem), &alone);
        problem.penalty = Some(PENALTY);
        optimum(&mut solver, setup, &problem);
    }
}

#[test]
fn a_face_through_the_corner_of_two_others_changes_nothing() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(55);
    for setup in Setup::all().iter().cycle().take(240) {
        let mut problem = bare(setup, &mut draw);
        let free = optimum(&mut solver, setup, &problem);
        let (knot, side) = (3 + draw.below(STAGES - 2), 2 * draw.below(4));
        let faces = [0, 1, 2].map(|turn| number(RowKind::Position(knot, (side + turn) % 8)));
        let values = values(setup, &problem, &free.controls);
        let [one, other] = [0; 2].map(|_| draw.between(0.01, 0.5));
        problem.bounds.0[faces[0]] = values[faces[0]] - one;
        problem.bounds.0[faces[2]] = values[faces[2]] - other;
        let corner = optimum(&mut solver, setup, &problem);
        problem.bounds.0[faces[1]] = values[faces[1]] - (one + other) / libm::sqrt(2.0);
        let cut = optimum(&mut solver, setup, &problem);
        assert_same(&cut, &corner);
    }
}

#[test]
fn rows_met_exactly_by_the_optimum_without_rows_cost_nothing() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(56);
    let mut unproven = 0;
    for setup in Setup::all().iter().cycle().take(60) {
        let mut problem = bare(setup, &mut draw);
        let free = optimum(&mut solver, setup, &problem);
        let values = values(setup, &problem, &free.controls);
        for off in [0.0, 1e-12, 1e-10] {
            for penalty in [None, Some(PENALTY)] {
                problem.penalty = penalty;
                problem.bounds = Bounds(values.map(|value| value - off));
                assert_same(&optimum(&mut solver, setup, &problem), &free);
                assert_eq!(solver.iterations(), 1);
            }
        }
        // One row cuts the optimum off, and others keep it from evading. No face above or below is
        // used: those are not quite opposite, and a flight far to the side would slip through.
        for off in [1e-8, 1e-6, 1e-4] {
            let upright = |row| matches!(RowKind::of(row), RowKind::Position(_, 0 | 4));
            let mut rows = core::iter::repeat_with(|| any_row(&mut draw));
            let cut = rows.find(|row| !upright(*row)).unwrap();
            let kept = values.map(|value| {
                if draw.unit() < 0.2 {
                    value
                } else {
                    f64::INFINITY
                }
            });
            problem.bounds = Bounds(kept);
            problem.bounds.0[cut] = values[cut] - off;
            if let RowKind::Thrust(stage, side) = RowKind::of(cut) {
                // A program with a price must not have hard rows that contradict each other.
                problem.bounds.0[number(RowKind::Thrust(stage, 1 - side))] = f64::INFINITY;
            }
            problem.penalty = None;
            if solver.solve(&setup.shared, &problem) == Status::NumericalFailure {
                // The program is nearer to the boundary of feasibility than rounding lets the
                // method see.
                unproven += 1;
            } else {
                proved(&mut solver, setup, &problem);
            }
            problem.penalty = Some(PENALTY);
            optimum(&mut solver, setup, &problem);
        }
    }
    assert!(unproven <= 3, "{unproven} of 180");
}

#[test]
fn constant_rows_may_be_met_but_not_missed() {
    let setup = Setup::all();
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(57);
    for setup in setup.iter().cycle().take(60) {
        let mut problem = bare(setup, &mut draw);
        let free = optimum(&mut solver, setup, &problem);
        let values = values(setup, &problem, &free.controls);
        for row in (0..ROWS).filter(|row| is_constant(*row)) {
            for (off, expected) in [
                (0.0, Status::Optimal),
                (1e-12, Status::Optimal),
                (1e-6, Status::Infeasible),
            ] {
                problem.bounds = Bounds::none();
                problem.bounds.0[row] = values[row] - off;
                assert_eq!(proved(&mut solver, setup, &problem).0, expected);
            }
        }
    }
}

#[test]
fn stages_that_cannot_be_steered_leave_only_thrust_rows_a_say() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(58);
    let mut setup = Setup::all().into_iter().next().unwrap();
    setup.model.b = Dynamics::at_rest().b;
    setup
        .shared
        .condense(&setup.model.dynamics(), &setup.weights)
        .unwrap();
    let still = [[0.0; 2]; STAGES];
    for _ in 0..20 {
        let mut problem = bare(&setup, &mut draw);
        let values = values(&setup, &problem, &still);
        problem.bounds = Bounds(values);
        let missed = draw.below(number(RowKind::Thrust(0, 0)));
        for (off, expected) in [
            (0.0, Status::Optimal),
            (1e-12, Status::Optimal),
            (1e-6, Status::Infeasible),
        ] {
            problem.bounds.0[missed] = values[missed] - off;
            problem.penalty = None;
            let (status, solution) = proved(&mut solver, &setup, &problem);
            assert_eq!(status, expected);
            assert!(status == Status::Infeasible || solution.controls == still);
            problem.penalty = Some(PENALTY);
            let soft = optimum(&mut solver, &setup, &problem);
            assert!(soft.controls == still && soft.violation <= 0.0);
        }
    }
}
