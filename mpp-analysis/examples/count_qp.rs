//! The QP solver's work on one recorded case, in functions of their own. `.ci/budget` counts their instructions.
//!
//! ```text
//! count_qp tests/reference/case_001.json
//! ```

use mpp_analysis::check_reference::recorded_instances;
use mpp_analysis::instance::Instance;
use mpp_core::qp::{CondenseError, Condensed, Problem, Solution, Solver, Status};
use std::error::Error;

/// Runs of one program.
const RUNS: usize = 50;

#[expect(clippy::disallowed_methods, reason = "an example is a program")]
fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args()
        .nth(1)
        .ok_or("count_qp: give a recorded case")?;
    let text = std::fs::read_to_string(&path)?;
    let (mut solver, mut solution) = (Box::new(Solver::new()), Box::new(Solution::new()));
    for instance in recorded_instances("case", &text)? {
        let mut condensed = instance.condense()?;
        let problem = instance.problem();
        for _ in 0..RUNS {
            condense(&instance, &mut condensed)?;
            candidate(&mut solver, &condensed, &problem, &mut solution);
        }
    }
    Ok(())
}

/// Does the work that a cycle does once.
#[inline(never)]
fn condense(instance: &Instance, condensed: &mut Condensed) -> Result<(), CondenseError> {
    instance.condense_to(condensed)
}

/// Does the work of one candidate.
#[inline(never)]
fn candidate(
    solver: &mut Solver,
    condensed: &Condensed,
    problem: &Problem,
    solution: &mut Solution,
) -> Status {
    match solver.solve(condensed, problem) {
        Status::Optimal => solver.solution(condensed, solution),
        status => status,
    }
}
