//! Checks of plant, linearisation, regulator, trim and estimator.

use super::report::{Comparison, worst_difference};
use mpp_core::control::{Lqr, LqrWeights};
use mpp_core::estimate::{Ekf, EkfTuning};
use mpp_core::paper::{Initial, StageModel};
use mpp_core::sense::Measurement;
use mpp_core::vehicle::{
    AirState, Airframe, Control, JacobianForm, Linearization, Trim, VehicleState, linearize,
    vehicle_rate,
};
use mpp_sim::dynamics::{Aerodynamics, Dynamics};
use nalgebra::{Matrix4, Matrix6, Matrix6x2, Vector4};
use serde::Deserialize;

const AIRFRAME: Airframe = Airframe::REFERENCE;

fn air(values: &[f64; 4]) -> AirState {
    AirState::from_vector(&Vector4::from(*values))
}

fn vehicle(values: &[f64; 6]) -> VehicleState {
    let [x, z, rest @ ..] = values;
    VehicleState {
        x: *x,
        z: *z,
        air: air(rest),
    }
}

fn flat(state: &VehicleState) -> [f64; 6] {
    let air = state.air.to_vector();
    [state.x, state.z, air.x, air.y, air.z, air.w]
}

#[derive(Deserialize)]
struct RecordedTrim {
    v: f64,
    theta: f64,
    thrust: f64,
    delta_e: f64,
}

/// Compares the authors' operating point with the recorded one.
fn compare_operating_point(recorded: &RecordedTrim) -> Comparison {
    let trim = Trim::of_authors(&AIRFRAME);
    let ours = [
        trim.state.airspeed,
        trim.state.pitch,
        trim.control.thrust,
        trim.control.elevator,
    ];
    let theirs = [
        recorded.v,
        recorded.theta,
        recorded.thrust,
        recorded.delta_e,
    ];
    Comparison::within("operating point", worst_difference(&ours, &theirs), 1e-12)
}

#[derive(Deserialize)]
struct PlantFile {
    dt: f64,
    trim: RecordedTrim,
    controls: Vec<[f64; 2]>,
    states: Vec<[f64; 6]>,
    derivatives: Vec<[f64; 6]>,
}

/// Checks 600 forward-Euler steps from the recorded start, and each recorded derivative.
pub(super) fn check_plant(text: &str) -> Result<Vec<Comparison>, serde_json::Error> {
    let file: PlantFile = serde_json::from_str(text)?;
    let control = |[thrust, elevator]: [f64; 2]| Control { thrust, elevator };
    let mut rate_error = 0.0_f64;
    for ((state, command), recorded) in file
        .states
        .iter()
        .zip(&file.controls)
        .zip(&file.derivatives)
    {
        let rate = vehicle_rate(&AIRFRAME, &vehicle(state), control(*command));
        let scale = recorded
            .iter()
            .fold(1.0_f64, |scale, value| scale.max(value.abs()));
        rate_error = rate_error.max(worst_difference(&flat(&rate), recorded) / scale);
    }
    let Some(first) = file.states.first() else {
        return Ok(vec![Comparison::failed("plant open loop", "no states")]);
    };
    let mut plant = Dynamics {
        airframe: AIRFRAME,
        more: Aerodynamics::NONE,
        state: vehicle(first),
    };
    let mut path_error = 0.0_f64;
    for (command, recorded) in file.controls.iter().zip(file.states.iter().skip(1)) {
        if let Err(error) = plant.step_euler(control(*command), file.dt) {
            return Ok(vec![Comparison::failed(
                "plant open loop",
                error.to_string(),
            )]);
        }
        path_error = path_error.max(worst_difference(&flat(&plant.state), recorded));
    }
    Ok(vec![
        Comparison::within("plant open loop", path_error, 1e-9),
        Comparison::within("plant derivative", rate_error, 1e-11),
        compare_operating_point(&file.trim),
    ])
}

#[derive(Deserialize)]
struct LinearizationFile {
    points: Vec<OperatingPoint>,
    planner: PlannerModel,
}

#[derive(Deserialize)]
#[allow(non_snake_case, reason = "names of the recorded file")]
struct OperatingPoint {
    state: [f64; 4],
    control: [f64; 2],
    A_reference: [[f64; 4]; 4],
    B_elevator_reference: [[f64; 1]; 4],
    A_numeric_of_plant: [[f64; 4]; 4],
    B_numeric_of_plant_thrust_elevator: [[f64; 2]; 4],
}

#[derive(Deserialize)]
#[allow(non_snake_case, reason = "names of the recorded file")]
struct PlannerModel {
    B_discrete: [[f64; 2]; 6],
    A_used: [[f64; 6]; 6],
    E: [[f64; 6]; 6],
}

/// Worst difference relative to the recorded entry, or absolute where the entry is below 1: entries
/// differ by orders of magnitude.
fn relative<const R: usize, const C: usize>(
    ours: impl Fn(usize, usize) -> f64,
    recorded: &[[f64; C]; R],
) -> f64 {
    let mut worst = 0.0_f64;
    for (row, values) in recorded.iter().enumerate() {
        for (col, value) in values.iter().enumerate() {
            worst = worst.max((ours(row, col) - value).abs() / value.abs().max(1.0));
        }
    }
    worst
}

pub(super) fn check_linearization(text: &str) -> Result<Vec<Comparison>, serde_json::Error> {
    let file: LinearizationFile = serde_json::from_str(text)?;
    let mut comparisons = Vec::new();
    for point in &file.points {
        let [thrust, elevator] = point.control;
        let control = Control { thrust, elevator };
        let at = |form| linearize(&AIRFRAME, &air(&point.state), control, form);
        let (authors, exact) = (at(JacobianForm::Authors), at(JacobianForm::Exact));
        let a = relative(|row, col| authors.a[(row, col)], &point.A_reference);
        let b = relative(|row, _| authors.b[(row, 1)], &point.B_elevator_reference);
        comparisons.push(Comparison::within(
            "linearisation, authors'",
            a.max(b),
            1e-11,
        ));
        let a = relative(|row, col| exact.a[(row, col)], &point.A_numeric_of_plant);
        let b = relative(
            |row, col| exact.b[(row, col)],
            &point.B_numeric_of_plant_thrust_elevator,
        );
        // Central differences are good to about 1e-6 of the largest entries.
        comparisons.push(Comparison::within("linearisation, exact", a.max(b), 1e-5));
    }
    comparisons.push(compare_model(&file.planner));
    Ok(comparisons)
}

/// Our model is solved for `x_{k+1}`. Multiplied by the recorded `E`, it must be the recorded
/// model.
fn compare_model(recorded: &PlannerModel) -> Comparison {
    const KIND: &str = "planner model";
    let trim = Trim::of_authors(&AIRFRAME);
    let (form, initial) = (JacobianForm::Authors, Initial::ThroughSteadyState);
    match StageModel::new(&AIRFRAME, &trim, form, initial) {
        Ok(model) => {
            let left = Matrix6::from_fn(|row, col| recorded.E[row][col]);
            let (a, b): (Matrix6<f64>, Matrix6x2<f64>) = (left * model.a, left * model.b);
            let error = relative(|row, col| a[(row, col)], &recorded.A_used)
                .max(relative(|row, col| b[(row, col)], &recorded.B_discrete));
            Comparison::within(KIND, error, 1e-11)
        }
        Err(error) => Comparison::failed(KIND, error.to_string()),
    }
}

#[derive(Deserialize)]
#[allow(non_snake_case, reason = "names of the recorded file")]
struct RegulatorFile {
    trim: RecordedTrim,
    linearized_with_thrust: f64,
    A: [[f64; 4]; 4],
    B: [[f64; 1]; 4],
    K: [[f64; 4]; 1],
}

pub(super) fn check_regulator(text: &str) -> Result<Vec<Comparison>, serde_json::Error> {
    let file: RegulatorFile = serde_json::from_str(text)?;
    let mut comparisons = vec![compare_operating_point(&file.trim)];
    let recorded = Linearization {
        a: Matrix4::from_fn(|row, col| file.A[row][col]),
        b: nalgebra::Matrix4x2::from_fn(|row, col| if col == 1 { file.B[row][0] } else { 0.0 }),
    };
    let mut compare = |kind, linear: &Linearization| {
        comparisons.push(match Lqr::design(linear, &LqrWeights::PAPER) {
            Ok(lqr) => Comparison::within(kind, relative(|_, col| lqr.gain[col], &file.K), 1e-8),
            Err(error) => Comparison::failed(kind, error.to_string()),
        });
    };
    compare("LQR gain, recorded model", &recorded);
    let trim = Trim::of_authors(&AIRFRAME);
    let control = Control {
        thrust: file.linearized_with_thrust,
        ..trim.control
    };
    let own = linearize(&AIRFRAME, &trim.state, control, JacobianForm::Authors);
    compare("LQR gain, own model", &own);
    Ok(comparisons)
}

#[derive(Deserialize)]
struct SteadyFlightFile {
    cases: Vec<SteadyFlight>,
}

#[derive(Deserialize)]
struct SteadyFlight {
    thrust: f64,
    gamma: f64,
    result: [f64; 4],
    delta_e: f64,
    plant_derivatives: [f64; 6],
}

/// If the recorded point is steady, our point at its airspeed must be the same. If it is not
/// steady, there is no point to agree with.
pub(super) fn check_steady_flight(text: &str) -> Result<Vec<Comparison>, serde_json::Error> {
    let file: SteadyFlightFile = serde_json::from_str(text)?;
    let compare = |case: &SteadyFlight| {
        let [_, _, acceleration, _, _, path_rate] = case.plant_derivatives;
        let steady = acceleration.abs() < 1e-9 && path_rate.abs() < 1e-9;
        let trim = match Trim::at_speed(&AIRFRAME, case.result[0], case.gamma) {
            Ok(trim) if steady => trim,
            Ok(trim) => {
                let difference = (trim.state.pitch - case.result[1]).abs();
                return Comparison::by_design("steady flight, not steady", difference);
            }
            Err(_) if !steady => {
                return Comparison::by_design("steady flight, not steady", 0.0);
            }
            Err(error) => return Comparison::failed("steady flight", error.to_string()),
        };
        let ours = [trim.state.pitch, trim.control.thrust, trim.control.elevator];
        let theirs = [case.result[1], case.thrust, case.delta_e];
        Comparison::within("steady flight", worst_difference(&ours, &theirs), 1e-9)
    };
    Ok(file.cases.iter().map(compare).collect())
}

#[derive(Deserialize)]
#[allow(non_snake_case, reason = "names of the recorded file")]
struct EstimatorFile {
    dt: f64,
    initial_estimate: [f64; 4],
    controls_thrust_delta_e: Vec<[f64; 2]>,
    measurements_v_theta: Vec<[f64; 2]>,
    estimates: Vec<[f64; 4]>,
    P: Vec<[[f64; 4]; 4]>,
}

pub(super) fn check_estimator(text: &str) -> Result<Vec<Comparison>, serde_json::Error> {
    let file: EstimatorFile = serde_json::from_str(text)?;
    let mut ekf = Ekf::new(AIRFRAME, EkfTuning::AUTHORS, air(&file.initial_estimate));
    let (mut estimate_error, mut covariance_error) = (0.0_f64, 0.0_f64);
    let steps = file
        .controls_thrust_delta_e
        .iter()
        .zip(&file.measurements_v_theta);
    for ((control, measured), (estimate, covariance)) in
        steps.zip(file.estimates.iter().zip(&file.P))
    {
        let [thrust, elevator] = *control;
        if ekf.predict(Control { thrust, elevator }, file.dt).is_err() {
            return Ok(vec![Comparison::failed("EKF estimates", "diverged")]);
        }
        let [airspeed, pitch] = *measured;
        ekf.update(&Measurement { airspeed, pitch });
        let ours = ekf.estimate().to_vector();
        estimate_error = estimate_error.max(worst_difference(&ours, estimate));
        let ours = ekf.covariance();
        covariance_error = covariance_error.max(relative(|row, col| ours[(row, col)], covariance));
    }
    Ok(vec![
        Comparison::within("EKF estimates", estimate_error, 1e-9),
        Comparison::within("EKF covariance", covariance_error, 1e-9),
    ])
}
