//! Checks of the steps from a path to the refined trajectory: collocation points, corridor,
//! feasibility and objective.

use super::perception::grid_with;
use super::report::{Comparison, worst_difference};
use crate::instance::{Instance, InstanceError};
use mpp_core::config::DIRECTIONS;
use mpp_core::corridor::Corridor;
use mpp_core::paper::config::SEARCH_ROW;
use mpp_core::paper::{GridPoint, Initial, ModelError, Padding, Rules, StageModel, resample};
use mpp_core::qp::{Bounds, Problem, Solution, Solver, Status, Weights};
use mpp_core::vehicle::{Airframe, JacobianForm, Trim};
use nalgebra::{Vector4, Vector6};
use serde::Deserialize;

/// A recorded feasibility margin below this \[m\] is a tie: neither answer is wrong.
const TIE: f64 = 1e-7;

#[derive(Deserialize)]
struct CaseFile {
    state_estimate: [f64; 4],
    og: Cells,
    path: Vec<[f64; 2]>,
    ref_points: Vec<[f64; 2]>,
    h: Vec<[f64; DIRECTIONS]>,
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
    match instances_of("case", &file) {
        Ok(instances) => {
            comparisons.extend(instances.iter().flat_map(compare_program));
        }
        Err(ModelError) => comparisons.push(Comparison::failed("QP verdict", "no model")),
    }
    Ok(comparisons)
}

fn in_grid([row, col]: [f64; 2]) -> GridPoint {
    GridPoint {
        row: row + SEARCH_ROW as f64,
        col,
    }
}

/// The programs of a recorded case (`case_*`), with both forms of the first state.
///
/// # Errors
/// [`InstanceError`] when the text is no recorded case, or does not fit the core's sizes.
pub fn recorded_instances(name: &str, text: &str) -> Result<Vec<Instance>, InstanceError> {
    let file: CaseFile = serde_json::from_str(text)?;
    let instances = instances_of(name, &file)
        .map_err(|ModelError| InstanceError::NoSteadyState(name.to_owned()))?;
    instances.iter().try_for_each(Instance::check)?;
    Ok(instances)
}

fn instances_of(name: &str, file: &CaseFile) -> Result<Vec<Instance>, ModelError> {
    let forms = [
        (
            "authors",
            Initial::ThroughSteadyState,
            file.lp_min_max_violation,
            &file.tight,
        ),
        (
            "fixed",
            Initial::Estimate,
            file.x0_fixed.lp_min_max_violation,
            &file.x0_fixed.tight,
        ),
    ];
    let airframe = &Airframe::REFERENCE;
    let trim = Trim::of_authors(airframe);
    let deviation = Vector4::from(file.state_estimate) - trim.state.to_vector();
    let mut corridor = Corridor::new();
    for (ours, theirs) in corridor.bounds.iter_mut().zip(&file.h) {
        *ours = *theirs;
    }
    let mut bounds = Bounds::none();
    bounds.set_corridor(&corridor);
    bounds.set_thrust([
        f64::INFINITY,
        file.h_thrust.first().copied().unwrap_or(f64::NAN),
    ]);
    let instance = |(form, initial, margin, recorded): (&str, Initial, f64, &Recorded)| {
        let model = StageModel::new(airframe, &trim, JacobianForm::Authors, initial)?;
        let [v, pitch, pitch_rate, path]: [f64; 4] = deviation.into();
        let problem = Problem {
            initial: (model.initial * Vector6::new(0.0, 0.0, v, pitch, pitch_rate, path)).into(),
            target: file.xgoal,
            bounds,
            ..Problem::EMPTY
        };
        // The recorded objective leaves out the constant w |target|^2 / 2.
        let squared: f64 = file.xgoal.iter().map(|goal| goal * goal).sum();
        let constant = 0.5 * Weights::PAPER.terminal * squared;
        let objective = recorded.objective_recomputed.or(recorded.primal_objective);
        let name = format!("{name}-{form}");
        Ok(Instance {
            margin: Some(margin),
            cost: objective
                .filter(|_| margin < 0.0)
                .map(|objective| objective + constant),
            ..Instance::of_program(name, &[model.dynamics()], &Weights::PAPER, &problem)
        })
    };
    forms.into_iter().map(instance).collect()
}

/// Solves a recorded program and compares verdict and objective.
fn compare_program(instance: &Instance) -> Vec<Comparison> {
    const VERDICT: &str = "QP verdict";
    let Ok(shared) = instance.condense() else {
        return vec![Comparison::failed(VERDICT, "the model cannot be condensed")];
    };
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    let mut status = solver.solve(&shared, &instance.problem());
    if status == Status::Optimal {
        status = solver.solution(&shared, &mut solution);
    }
    let margin = instance.margin.unwrap_or(f64::NAN);
    let right = match status {
        Status::Optimal => margin <= TIE,
        Status::Infeasible | Status::TooDear => margin >= -TIE,
        Status::Dominated | Status::IterationLimit | Status::NumericalFailure => false,
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
    if let (Status::Optimal, Some(cost)) = (status, instance.cost) {
        let error = (solution.cost - cost).abs() / cost.abs().max(1.0);
        comparisons.push(Comparison::within("QP objective (relative)", error, 1e-6));
    }
    comparisons
}
