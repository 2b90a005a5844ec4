//! A verdict of infeasibility is about the rows alone: no weight of the cost changes it.

use super::conditions::assert_contradiction;
use super::dense::DenseProgram;
use super::programs::{Draw, Setup};
use mpp_core::config::STAGES;
use mpp_core::qp::{MAX_ITERATIONS, Problem, Solution, Solver, Status};

/// Terminal weights over twelve decades.
const DECADES: core::ops::RangeInclusive<i32> = -6..=6;
/// Programs under each weight.
const PROGRAMS: usize = 780;

#[test]
fn no_weight_makes_a_program_with_a_solution_infeasible() {
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    let mut draw = Draw::new(71);
    let (mut optimal, mut infeasible, mut dear) = (0, 0, 0);
    for index in 0..PROGRAMS {
        let mut setup = Setup::all().into_iter().nth(index % 3).unwrap();
        let problem = setup.program(&mut draw);
        // Every second target is far outside of what the aircraft reaches.
        let far = if index % 2 == 0 { 1.0 } else { 500.0 };
        let problem = Problem {
            target: problem.target.map(|value| far * value),
            ..problem
        };
        let mut verdicts = [false; 2];
        for decade in DECADES {
            setup.weights.terminal = 10.0_f64.powi(decade);
            setup
                .shared
                .condense(&setup.model.dynamics(), &setup.weights)
                .unwrap();
            let mut status = solver.solve(&setup.shared, &problem);
            assert!(solver.iterations() <= MAX_ITERATIONS);
            if status == Status::Optimal {
                status = solver.solution(&setup.shared, &mut solution);
            }
            match status {
                Status::Optimal => {
                    verdicts[0] = true;
                    optimal += 1;
                }
                Status::Infeasible => {
                    let model = [setup.model.dynamics(); STAGES];
                    assert_contradiction(
                        &DenseProgram::new(&model, &setup.weights, &problem),
                        &solver,
                    );
                    verdicts[1] = true;
                    infeasible += 1;
                }
                Status::TooDear => dear += 1,
                other => panic!("{other:?}"),
            }
        }
        assert!(
            verdicts != [true; 2],
            "program {index} has a solution, and a proof that it has none"
        );
    }
    println!("optimal {optimal}, infeasible {infeasible}, too dear {dear}");
    assert!(optimal > 7_000 && infeasible > 1_700);
}
