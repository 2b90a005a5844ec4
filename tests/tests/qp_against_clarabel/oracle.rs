//! Clarabel's answers. The benchmark's `FullForm` writes the program in full, with states and
//! controls as variables. It shares nothing with the solver under test.

use super::instances::{Instance, Preset};
use clarabel::solver::{IPSolver, SolverStatus};
use mpp_analysis::bench::{Form, FullForm};
use mpp_analysis::instance;
use mpp_core::qp::{Penalty, Solution};

/// Clarabel's run on one program.
pub(crate) struct ClarabelRun {
    pub(crate) status: SolverStatus,
    pub(crate) cost: f64,
}

fn full_form(
    preset: &Preset,
    instance: &Instance,
    penalty: Option<Penalty>,
    form: Form,
) -> FullForm {
    let problem = instance.problem(penalty);
    let stages = [preset.model.dynamics()];
    let program = instance::Instance::of_program(String::new(), &stages, &preset.weights, &problem);
    FullForm::new(&program, form)
}

fn ask(full: &FullForm) -> ClarabelRun {
    let mut solver = full.clarabel().unwrap();
    solver.solve();
    ClarabelRun {
        status: solver.solution.status,
        cost: solver.solution.obj_val + full.constant,
    }
}

/// Solves the program with hard rows, or with a slack for each soft row that the controls can
/// change.
pub(crate) fn solve(preset: &Preset, instance: &Instance, penalty: Option<Penalty>) -> ClarabelRun {
    ask(&full_form(preset, instance, penalty, Form::Optimum))
}

/// The least `t` [m, rad, N] for which all rows, relaxed by `t`, can hold. It is negative where the
/// program has room and positive where rows contradict each other.
pub(crate) fn margin(preset: &Preset, instance: &Instance) -> f64 {
    let answer = ask(&full_form(preset, instance, None, Form::Margin));
    assert_eq!(
        answer.status,
        SolverStatus::Solved,
        "the relaxed program always has an optimum"
    );
    answer.cost
}

/// Cost of a solution with the price of its violations, and its worst violation of a hard row.
pub(crate) fn priced(
    preset: &Preset,
    instance: &Instance,
    solution: &Solution,
    penalty: Option<Penalty>,
) -> (f64, f64) {
    full_form(preset, instance, penalty, Form::Optimum).evaluate(solution)
}
