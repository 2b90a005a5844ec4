//! Tests changes of a program that must not change the result, or that must change it in a known
//! way.

use super::programs::{Draw, Setup, is_constant, violations};
use super::small_programs::difference;
use mpp_core::qp::{MAX_ITERATIONS, Penalty, Problem, ROWS, Solution, Solver, Status};

/// Relative error that rounding leaves when the method takes another way to the same optimum.
const SAME: f64 = 1e-8;

fn same_cost(a: &Solution, b: &Solution) -> bool {
    (a.cost - b.cost).abs() <= SAME * a.cost.abs().max(1.0)
}

/// Calls `check` with feasible programs and their optima.
fn for_each_optimum(
    seed: u64,
    mut check: impl FnMut(&mut Solver, &Setup, &Problem, &Solution, &mut Draw),
) {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(seed);
    let mut checked = 0;
    for setup in Setup::all().iter().cycle().take(150) {
        let problem = setup.program(&mut draw);
        if let Some(best) = setup.optimum(&mut solver, &problem) {
            check(&mut solver, setup, &problem, &best, &mut draw);
            checked += 1;
        }
    }
    assert!(checked >= 50, "only {checked} were feasible");
}

/// All results of a solve.
type Trace = (Status, usize, Vec<(usize, f64)>, Status, Solution);

fn trace(solver: &Solver, setup: &Setup, status: Status) -> Trace {
    let mut solution = Solution::new();
    let accepted = solver.solution(&setup.shared, &mut solution);
    (
        status,
        solver.iterations(),
        solver.multipliers().collect(),
        accepted,
        solution,
    )
}

#[test]
fn steps_taken_in_any_slices_end_in_the_same_bits() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(30);
    for (index, setup) in Setup::all().iter().cycle().take(120).enumerate() {
        let penalty = Penalty {
            linear: 1e3,
            quadratic: 1e2,
        };
        let problem = Problem {
            penalty: (index % 2 == 0).then_some(penalty),
            ..setup.program(&mut draw)
        };
        let whole = {
            // This workspace has solved nothing before.
            let mut fresh = Box::new(Solver::new());
            let status = fresh.solve(&setup.shared, &problem);
            trace(&fresh, setup, status)
        };
        for slice in [1, 2, 7] {
            solver.start(&setup.shared, &problem);
            let status = (0..=MAX_ITERATIONS + 1)
                .find_map(|_| solver.advance(&setup.shared, slice))
                .unwrap();
            assert_eq!(trace(&solver, setup, status), whole);
        }
    }
}

#[test]
fn an_interrupted_solve_has_no_status_and_no_accepted_solution() {
    let mut solver = Box::new(Solver::new());
    let mut draw = Draw::new(31);
    let mut interrupted = 0;
    for setup in Setup::all().iter().cycle().take(60) {
        let problem = setup.program(&mut draw);
        solver.start(&setup.shared, &problem);
        if solver.advance(&setup.shared, 1).is_none() {
            let status = solver.solution(&setup.shared, &mut Solution::new());
            assert_eq!(status, Status::IterationLimit);
            interrupted += 1;
        }
    }
    assert!(interrupted >= 10);
}

#[test]
fn a_program_twice_the_size_has_twice_the_optimum() {
    for_each_optimum(32, |solver, setup, problem, best, draw| {
        let scale = draw.between(0.5, 3.0);
        let mut scaled = *problem;
        scaled.initial.iter_mut().for_each(|value| *value *= scale);
        scaled.target.iter_mut().for_each(|value| *value *= scale);
        scaled.bounds.0.iter_mut().for_each(|bound| *bound *= scale);
        let mut large = setup.optimum(solver, &scaled).unwrap();
        large
            .controls
            .iter_mut()
            .flatten()
            .for_each(|value| *value /= scale);
        assert!(difference(&large.controls, &best.controls) < 1e-6);
        assert!((large.cost / (scale * scale) - best.cost).abs() <= SAME * best.cost.max(1.0));
    });
}

#[test]
fn rows_without_a_say_can_go() {
    for_each_optimum(33, |solver, setup, problem, best, _| {
        let _ = solver.solve(&setup.shared, problem);
        let mut needed = [false; ROWS];
        solver.multipliers().for_each(|(row, _)| needed[row] = true);
        let mut fewer = *problem;
        for row in (0..ROWS).filter(|row| !needed[*row]) {
            fewer.bounds.0[row] = f64::INFINITY;
        }
        let again = setup.optimum(solver, &fewer).unwrap();
        assert!(same_cost(&again, best) && difference(&again.controls, &best.controls) < 1e-6);
    });
}

#[test]
fn rows_that_just_admit_the_optimum_change_nothing() {
    for_each_optimum(34, |solver, setup, problem, best, draw| {
        let room = violations(problem, best).map(|violation| -violation);
        let mut tight = *problem;
        for row in (0..ROWS).filter(|row| !is_constant(*row) && room[*row].is_finite()) {
            if draw.unit() < 0.2 {
                tight.bounds.0[row] -= (room[row] - 1e-7).max(0.0);
            }
        }
        let again = setup.optimum(solver, &tight).unwrap();
        assert!(same_cost(&again, best) && difference(&again.controls, &best.controls) < 1e-5);
    });
}

#[test]
fn stricter_rows_never_cost_less() {
    for_each_optimum(35, |solver, setup, problem, best, draw| {
        let mut strict = *problem;
        for bound in &mut strict.bounds.0 {
            *bound -= draw.between(0.0, 0.3);
        }
        if let Some(dearer) = setup.optimum(solver, &strict) {
            assert!(dearer.cost >= best.cost * (1.0 - SAME));
        }
    });
}

#[test]
fn every_row_binds_its_own_output() {
    // A single row that cuts off the optimum without rows is met exactly and costs something.
    for_each_optimum(36, |solver, setup, problem, _, draw| {
        let mut bare = *problem;
        bare.bounds = mpp_core::qp::Bounds::none();
        let free = setup.optimum(solver, &bare).unwrap();
        let row = (0..)
            .map(|_| draw.below(ROWS))
            .find(|row| !is_constant(*row))
            .unwrap();
        bare.bounds.0[row] = 0.0;
        bare.bounds.0[row] = violations(&bare, &free)[row] - 0.05;
        let bound = setup.optimum(solver, &bare).unwrap();
        assert!(violations(&bare, &bound)[row].abs() < 1e-7 && bound.cost > free.cost);
        assert_eq!(
            solver.multipliers().map(|(row, _)| row).collect::<Vec<_>>(),
            [row]
        );
    });
}
