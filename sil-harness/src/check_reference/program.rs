//! From a path to the refined trajectory: collocation points, corridor, feasibility and objective.

use super::perception::grid_with;
use super::{Comparison, worst_difference};
use mpp_core::Rules;
use mpp_core::config::SEARCH_ROW;
use mpp_core::corridor::{Corridor, Padding};
use mpp_core::map::GridPoint;
use mpp_core::plan::resample;
use mpp_core::qp::{
    Bounds, Condensed, Initial, Problem, Solution, Solver, StageModel, Status, SteadyState, Weights,
};
use mpp_core::vehicle::{AirState, Airframe, JacobianForm, Trim, linearize};
use nalgebra::Vector4;
use serde::Deserialize;

/// A recorded feasibility margin below this [m] is a tie that neither answer is wrong on.
const TIE: f64 = 1e-7;

#[derive(Deserialize)]
struct CaseFile {
    state_estimate: [f64; 4],
    og: Cells,
    path: Vec<[f64; 2]>,
    ref_points: Vec<[f64; 2]>,
    h: Vec<Vec<f64>>,
    h_thrust: Vec<f64>,
    xgoal: [f64; 6],
    tight: Recorded,
    lp_min_max_violation: f64,
    x0_fixed: Fixed,
}

#[derive(Deserialize)]
struct Cells {
    occupied: Vec<[i32; 2]>,
}

#[derive(Deserialize)]
struct Recorded {
    objective_recomputed: Option<f64>,
    primal_objective: Option<f64>,
}

#[derive(Deserialize)]
struct Fixed {
    lp_min_max_violation: f64,
    #[serde(flatten)]
    tight: Recorded,
}

pub(super) fn check_case(text: &str) -> Result<Vec<Comparison>, serde_json::Error> {
    let file: CaseFile = serde_json::from_str(text)?;
    let trim = Trim::of_authors(&Airframe::REFERENCE);
    let grid = grid_with(&file.og.occupied, SEARCH_ROW as i32);
    let path: Vec<GridPoint> = file.path.iter().map(|point| in_grid(*point)).collect();
    let points = resample(&path, Rules::Authors);
    let ours: Vec<f64> = points
        .iter()
        .flat_map(|point| [point.row - SEARCH_ROW as f64, point.col])
        .collect();
    let mut corridor = Corridor::new();
    corridor.trace(
        &grid,
        &points,
        trim.state.airspeed,
        &Padding::AUTHORS,
        Rules::Authors,
    );

    let mut comparisons = vec![
        Comparison::within(
            "collocation points",
            worst_difference(&ours, file.ref_points.iter().flatten()),
            1e-9,
        ),
        Comparison::within(
            "corridor half-planes",
            worst_difference(corridor.bounds.iter().flatten(), file.h.iter().flatten()),
            1e-9,
        ),
    ];
    let forms = [
        (
            Initial::ThroughSteadyState,
            file.lp_min_max_violation,
            &file.tight,
        ),
        (
            Initial::Estimate,
            file.x0_fixed.lp_min_max_violation,
            &file.x0_fixed.tight,
        ),
    ];
    for (initial, margin, recorded) in forms {
        comparisons.extend(compare_program(&file, &trim, initial, margin, recorded));
    }
    Ok(comparisons)
}

fn in_grid([row, col]: [f64; 2]) -> GridPoint {
    GridPoint {
        row: row + SEARCH_ROW as f64,
        col,
    }
}

/// Solves the recorded program, from the recorded half-planes, and compares verdict and objective.
fn compare_program(
    file: &CaseFile,
    trim: &Trim,
    initial: Initial,
    margin: f64,
    recorded: &Recorded,
) -> Vec<Comparison> {
    const VERDICT: &str = "QP verdict";
    const OBJECTIVE: &str = "QP objective (relative)";
    let mut shared = Box::new(Condensed::new());
    let linear = linearize(
        &Airframe::REFERENCE,
        &trim.state,
        trim.control,
        JacobianForm::Authors,
    );
    let steady = SteadyState::ZeroPitchRate;
    let model = StageModel::new(&Airframe::REFERENCE, trim, &linear, steady, initial);
    let condensed = model.is_ok_and(|model| shared.condense(&model, &Weights::PAPER).is_ok());
    if !condensed {
        return vec![Comparison::failed(VERDICT, "the model cannot be condensed")];
    };
    let mut bounds = Bounds::none();
    let mut corridor = Corridor::new();
    for (ours, theirs) in corridor
        .bounds
        .iter_mut()
        .flatten()
        .zip(file.h.iter().flatten())
    {
        *ours = *theirs;
    }
    bounds.set_corridor(&corridor);
    bounds.set_thrust(file.h_thrust.first().copied().unwrap_or(f64::NAN));
    let estimate = AirState::from_vector(&Vector4::from(file.state_estimate));
    let problem = Problem {
        initial: shared.initial_state(trim, &estimate),
        target: file.xgoal,
        bounds,
        penalty: None,
        cost_limit: f64::INFINITY,
    };
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    let mut status = solver.solve(&shared, &problem);
    if status == Status::Optimal {
        status = solver.solution(&shared, &mut solution);
    }
    let right = match status {
        Status::Optimal => margin <= TIE,
        Status::Infeasible => margin >= -TIE,
        _ => false,
    };
    let verdict = if right {
        Comparison::within(VERDICT, 0.0, 0.0)
    } else {
        Comparison::failed(
            VERDICT,
            format!("{status:?}, recorded margin {margin:.3e} m"),
        )
    };
    let mut comparisons = vec![verdict];
    let objective = recorded.objective_recomputed.or(recorded.primal_objective);
    if let (Status::Optimal, Some(theirs)) = (status, objective) {
        // The recorded objective leaves out the constant w |target|^2 / 2.
        let constant: f64 = file.xgoal.iter().map(|goal| goal * goal).sum();
        let ours = solution.cost - 0.5 * Weights::PAPER.terminal * constant;
        let error = (ours - theirs).abs() / theirs.abs().max(1.0);
        comparisons.push(Comparison::within(OBJECTIVE, error, 1e-6));
    }
    comparisons
}
