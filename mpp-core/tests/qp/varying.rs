//! Tests stages that each have a model of their own, with offsets.

use super::conditions::{assert_contradiction, assert_optimal};
use super::dense::{DenseProgram, Stages, cost, roll_out};
use super::programs::{Draw, Setup};
use super::small_programs::difference;
use mpp_core::config::STAGES;
use mpp_core::qp::{Bounds, CondenseError, Condensed, Penalty, Problem, Solution, Solver, Status};

const PENALTY: Penalty = Penalty {
    linear: 50.0,
    quadratic: 200.0,
};
/// Violation that rounding leaves of a row [m, rad, N].
const TIGHT: f64 = 1e-7;

/// All results of a solve.
type Trace = (Status, usize, Vec<(usize, f64)>, Status, Solution);

fn trace(shared: &Condensed, problem: &Problem) -> Trace {
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    let status = solver.solve(shared, problem);
    let accepted = solver.solution(shared, &mut solution);
    let multipliers = solver.multipliers().collect();
    (status, solver.iterations(), multipliers, accepted, solution)
}

/// A preset's model, changed at random in each stage by a tenth, and with an offset.
fn bent(setup: &Setup, draw: &mut Draw) -> Stages {
    core::array::from_fn(|_| {
        let mut dynamics = setup.model.dynamics();
        let entries = dynamics.motion.iter_mut();
        for entry in entries.chain(dynamics.b.iter_mut()) {
            *entry *= draw.between(0.9, 1.1);
        }
        let push = [0.1, 0.1, 0.1, 0.01, 0.01, 0.01];
        dynamics.offset = push.map(|push| draw.between(-push, push)).into();
        dynamics
    })
}

fn condense(shared: &mut Condensed, stages: &Stages, setup: &Setup) -> Result<(), CondenseError> {
    shared.condense_varying(&setup.weights, |dynamics| *dynamics = *stages)
}

fn condensed(setup: &Setup, stages: &Stages) -> Box<Condensed> {
    let mut shared = Box::new(Condensed::new());
    condense(&mut shared, stages, setup).unwrap();
    shared
}

#[test]
fn the_same_model_in_every_stage_is_the_model_to_the_bit() {
    let mut draw = Draw::new(70);
    for (index, setup) in Setup::all().iter().cycle().take(60).enumerate() {
        let problem = Problem {
            penalty: (index % 2 == 0).then_some(PENALTY),
            ..setup.program(&mut draw)
        };
        let shared = condensed(setup, &[setup.model.dynamics(); STAGES]);
        assert_eq!(trace(&shared, &problem), trace(&setup.shared, &problem));
    }
}

#[test]
fn a_workspace_forgets_what_it_condensed_before() {
    let mut draw = Draw::new(71);
    let mut used = Box::new(Condensed::new());
    for setup in Setup::all().iter().cycle().take(12) {
        let problem = setup.program(&mut draw);
        let stages = bent(setup, &mut draw);
        let mut broken = stages;
        broken[draw.below(STAGES)].motion[(2, 0)] = f64::NAN;
        let failed = condense(&mut used, &broken, setup);
        assert_eq!(failed, Err(CondenseError));
        condense(&mut used, &stages, setup).unwrap();
        let fresh = condensed(setup, &stages);
        assert_eq!(trace(&used, &problem), trace(&fresh, &problem));
        used.condense(&setup.model.dynamics(), &setup.weights)
            .unwrap();
        assert_eq!(trace(&used, &problem), trace(&setup.shared, &problem));
    }
}

#[test]
fn optima_over_stages_of_their_own_meet_the_optimality_conditions() {
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    let mut draw = Draw::new(72);
    let (mut optimal, mut infeasible, mut several_active) = ([0; 2], 0, 0);
    for (index, setup) in Setup::all().iter().cycle().take(300).enumerate() {
        let stages = bent(setup, &mut draw);
        let shared = condensed(setup, &stages);
        let soft = index % 2 == 0;
        let mut problem = setup.program(&mut draw);
        problem.penalty = soft.then(|| Penalty {
            linear: libm::exp10(draw.between(-2.0, 3.0)),
            quadratic: libm::exp10(draw.between(0.0, 3.0)),
        });
        // The prices are below the cost of thrust rows, which are still hard.
        let sides = [draw.between(0.2, 2.0), draw.between(0.2, 1.0)];
        problem
            .bounds
            .set_thrust(sides.map(|side| side * setup.thrust));
        let dense = DenseProgram::new(&stages, &setup.weights, &problem);
        let status = solver.solve(&shared, &problem);
        if matches!(status, Status::Infeasible | Status::TooDear) {
            assert_contradiction(&dense, &solver);
            infeasible += 1;
            continue;
        }
        assert_eq!(solver.solution(&shared, &mut solution), Status::Optimal);
        assert_optimal(&dense, problem.penalty, &solver, &solution, TIGHT);
        let expected = cost(&stages, &setup.weights, &problem, &solution.controls);
        assert!((solution.cost - expected).abs() <= 1e-12 * expected);
        let states = roll_out(&stages, &problem.initial, &solution.controls);
        for (state, expected) in solution
            .states
            .iter()
            .flatten()
            .zip(states.iter().flatten())
        {
            assert!((state - expected).abs() <= 1e-12 * expected.abs().max(1.0));
        }
        optimal[usize::from(soft)] += 1;
        several_active += usize::from(solver.multipliers().count() >= 3);
    }
    println!("hard and soft optima: {optimal:?}, contradictions: {infeasible}");
    assert!(optimal[0] >= 100 && optimal[1] == 150 && infeasible >= 15 && several_active >= 200);
}

#[test]
fn offsets_alone_are_a_drift_that_the_optimum_meets() {
    // Without rows, an offset in the last stage equals a target that is moved the other way.
    let mut draw = Draw::new(73);
    for setup in Setup::all().iter().cycle().take(30) {
        let mut stages = [setup.model.dynamics(); STAGES];
        let push = [0; 6].map(|_| draw.between(-1.0, 1.0));
        stages[STAGES - 1].offset = push.into();
        let mut problem = setup.program(&mut draw);
        problem.bounds = Bounds::none();
        let (_, _, _, _, pushed) = trace(&condensed(setup, &stages), &problem);
        for (target, push) in problem.target.iter_mut().zip(&push) {
            *target -= push;
        }
        let (_, _, _, accepted, moved) = trace(&setup.shared, &problem);
        assert_eq!(accepted, Status::Optimal);
        assert!((pushed.cost - moved.cost).abs() <= 1e-9 * moved.cost.max(1.0));
        assert!(difference(&pushed.controls, &moved.controls) <= 1e-9);
    }
}
