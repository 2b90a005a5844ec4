//! A program: the quadratic program of a straight path with one half-plane in its way, condensed, solved, and read.

use mpp_core::corridor::Corridor;
use mpp_core::paper::{Initial, StageModel};
use mpp_core::qp::{Condensed, Problem, Solution, Solver, Status, Weights};
use mpp_core::vehicle::{Airframe, JacobianForm, Trim};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let airframe = Airframe::REFERENCE;
    let trim = Trim::at_speed(&airframe, 12.0, 0.0)?;
    // Condensing depends on the model alone: once for all candidates.
    let mut shared = Box::new(Condensed::new());
    let model = StageModel::new(&airframe, &trim, JacobianForm::Exact, Initial::Estimate)?;
    shared.condense(&model.dynamics(), &Weights::PAPER)?;

    // At stages 9 to 11 the aircraft must be 2 m above level flight. Direction 4 points down: -z <= -2.
    let mut corridor = Corridor::new();
    for stage in 9..=11 {
        corridor.bounds[stage][4] = -2.0;
    }
    let mut problem = Problem::EMPTY;
    problem.bounds.set_corridor(&corridor);
    problem
        .bounds
        .set_thrust([f64::INFINITY, trim.control.thrust]);

    let mut solver = Box::new(Solver::new());
    let status = solver.solve(&shared, &problem);
    let mut solution = Solution::new();
    solver.solution(&shared, &mut solution);
    println!(
        "{status:?} after {} steps, cost {:.3}",
        solver.iterations(),
        solution.cost
    );
    for (stage, state) in solution.states.iter().enumerate().step_by(3) {
        println!("stage {stage:2}: z {:+.3} m", state[1]);
    }
    assert_eq!(status, Status::Optimal);
    assert!((solution.states[10][1] - 2.0).abs() < 0.3);
    Ok(())
}
