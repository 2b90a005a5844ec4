//! The program of one candidate in the paper's notation, and its text.
//!
//! Lists of programs are written as JSON lines: `bench qp --export` makes them, other solvers read
//! them.

use mpp_core::config::{DIRECTIONS, KNOTS, STAGES};
use mpp_core::corridor::{Corridor, DIRECTION_VECTORS};
use mpp_core::qp::{
    Bounds, CondenseError, Condensed, Dynamics, POSITION, Penalty, Problem, RowKind, Weights,
};
use nalgebra::{Matrix6x2, SMatrix};
use serde::{Deserialize, Serialize};

/// One program: everything that a solver needs.
///
/// States are `(x, z, v, theta, theta', gamma)` and controls `(elevator, thrust)`, deviations from
/// level flight; SI units and radians. Programs of the flight planner are in its own units and tenths of radians, with the
/// states `(x, z, v, theta, thrust, gamma)` and the controls `(rate of the angle of attack, thrust)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Instance {
    /// Origin of the program.
    pub name: String,
    /// Matrix of the states in `x_{k+1} = a x_k + b u_k + offset`: 6 x 6, rows; one for each stage,
    /// or one for all.
    pub a: Vec<[[f64; 6]; 6]>,
    /// Matrix of the controls: 6 x 2, rows; as many as of `a`.
    pub b: Vec<[[f64; 2]; 6]>,
    /// Offset of the dynamics; as many as of `a`.
    pub offset: Vec<[f64; 6]>,
    /// Weights of squared controls.
    pub control_weight: [f64; 2],
    /// Weight of the squared distance from the target.
    pub terminal_weight: f64,
    /// First state.
    pub initial: [f64; 6],
    /// Target of the last state.
    pub target: [f64; 6],
    /// Unit vectors `(x, z)` of the half-planes.
    pub directions: [[f64; 2]; DIRECTIONS],
    /// Bounds in `directions[i] . (x_k, z_k) <= position_bounds[k][i]`.
    pub position_bounds: Vec<[f64; DIRECTIONS]>,
    /// Largest amount by which thrust may rise \[N\], if bounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust_rise: Option<f64>,
    /// Largest amount by which thrust may fall \[N\].
    pub thrust_reserve: f64,
    /// Limits of `(angle of attack, flight path)`, upper then lower, if bounded.
    pub attitude: Option<[[f64; 2]; 2]>,
    /// `(linear, quadratic)` price of violating position and attitude rows; `None` makes them hard.
    pub penalty: Option<[f64; 2]>,
    /// Whether the upper and the lower rows of the angle of attack are hard although there is a penalty.
    #[serde(default)]
    pub hard_angle_of_attack: [bool; 2],
    /// The least uniform relaxation of all rows that makes the program feasible, if recorded.
    pub margin: Option<f64>,
    /// The optimal cost, if recorded.
    pub cost: Option<f64>,
}

impl Instance {
    /// A program from the planner's data. `stages` holds the dynamics of every stage, or one for
    /// all. The bounds are read back from the rows.
    #[must_use]
    pub fn of_program(
        name: String,
        stages: &[Dynamics],
        weights: &Weights,
        problem: &Problem,
    ) -> Self {
        let mut position_bounds = vec![[f64::INFINITY; DIRECTIONS]; KNOTS];
        let mut limits = [f64::INFINITY; 4];
        let [mut thrust_rise, mut thrust_reserve] = [f64::INFINITY; 2];
        for (row, bound) in problem.bounds.0.iter().enumerate() {
            match RowKind::of(row) {
                RowKind::Position(knot, direction) => position_bounds[knot][direction] = *bound,
                RowKind::Attitude(_, side) => limits[side] = *bound,
                RowKind::Thrust(_, 0) => thrust_rise = *bound,
                RowKind::Thrust(..) => thrust_reserve = *bound,
            }
        }
        let [attack, path, minus_attack, minus_path] = limits;
        let bounded = limits.iter().all(|limit| limit.is_finite());
        Self {
            name,
            a: stages.iter().map(|stage| rows_of(&stage.a())).collect(),
            b: stages.iter().map(|stage| rows_of(&stage.b)).collect(),
            offset: stages.iter().map(|stage| stage.offset.into()).collect(),
            control_weight: weights.control,
            terminal_weight: weights.terminal,
            initial: problem.initial,
            target: problem.target,
            directions: DIRECTION_VECTORS.map(|[up, forward]| [forward, up]),
            position_bounds,
            thrust_rise: thrust_rise.is_finite().then_some(thrust_rise),
            thrust_reserve,
            attitude: bounded.then_some([[attack, path], [-minus_attack, -minus_path]]),
            penalty: problem
                .penalty
                .map(|penalty| [penalty.linear, penalty.quadratic]),
            hard_angle_of_attack: problem.hard_angle_of_attack,
            margin: None,
            cost: None,
        }
    }

    /// Index of a stage among the dynamics.
    pub(super) fn place(&self, stage: usize) -> usize {
        stage.min(self.a.len() - 1)
    }

    /// The dynamics of a stage.
    fn dynamics(&self, stage: usize) -> Dynamics {
        let at = self.place(stage);
        Dynamics {
            motion: SMatrix::from_fn(|row, col| self.a[at][row][col + POSITION]),
            b: Matrix6x2::from_fn(|row, col| self.b[at][row][col]),
            offset: self.offset[at].into(),
        }
    }

    /// The program's weights.
    #[must_use]
    pub fn weights(&self) -> Weights {
        Weights {
            control: self.control_weight,
            terminal: self.terminal_weight,
        }
    }

    /// Condenses model and weights.
    ///
    /// # Errors
    /// [`CondenseError`] when the Hessian is not positive definite.
    pub fn condense(&self) -> Result<Box<Condensed>, CondenseError> {
        let mut shared = Box::new(Condensed::new());
        self.condense_to(&mut shared)?;
        Ok(shared)
    }

    /// Condenses model and weights in an existing workspace, just as the planner of the program
    /// does it.
    ///
    /// # Errors
    /// [`CondenseError`] when the Hessian is not positive definite.
    pub fn condense_to(&self, shared: &mut Condensed) -> Result<(), CondenseError> {
        if self.a.len() == 1 {
            shared.condense(&self.dynamics(0), &self.weights())
        } else {
            shared.condense_varying(&self.weights(), |stages| {
                for (stage, place) in stages.iter_mut().enumerate() {
                    *place = self.dynamics(stage);
                }
            })
        }
    }

    /// Whether two programs share model and weights.
    #[must_use]
    pub fn shares_model(&self, other: &Self) -> bool {
        let bits = |instance: &Self| {
            let model = instance.a.as_flattened().as_flattened().iter();
            let model = model.chain(instance.b.as_flattened().as_flattened());
            let model = model.chain(instance.offset.as_flattened());
            let weights = instance
                .control_weight
                .iter()
                .chain([&instance.terminal_weight]);
            model
                .chain(weights)
                .map(|value| value.to_bits())
                .collect::<Vec<_>>()
        };
        bits(self) == bits(other)
    }

    /// The program as the core takes it.
    #[must_use]
    pub fn problem(&self) -> Problem {
        let mut corridor = Corridor::new();
        for (ours, theirs) in corridor.bounds.iter_mut().zip(&self.position_bounds) {
            *ours = *theirs;
        }
        let mut bounds = Bounds::none();
        bounds.set_corridor(&corridor);
        let rise = self.thrust_rise.unwrap_or(f64::INFINITY);
        bounds.set_thrust([rise, self.thrust_reserve]);
        if let Some([upper, lower]) = self.attitude {
            bounds.set_attitude(upper, lower);
        }
        Problem {
            initial: self.initial,
            target: self.target,
            bounds,
            penalty: self
                .penalty
                .map(|[linear, quadratic]| Penalty { linear, quadratic }),
            hard_angle_of_attack: self.hard_angle_of_attack,
            cost_limit: f64::INFINITY,
        }
    }

    /// The programs of a text with one JSON object per line.
    ///
    /// # Errors
    /// [`InstanceError`] of the first line that is no program of the core's sizes.
    pub fn of_lines(text: &str) -> Result<Vec<Self>, InstanceError> {
        let lines = text.lines().filter(|line| !line.trim().is_empty());
        lines
            .map(|line| {
                let instance: Self = serde_json::from_str(line)?;
                instance.check()?;
                Ok(instance)
            })
            .collect()
    }

    /// Checks a program against the sizes and directions of the core.
    ///
    /// # Errors
    /// [`InstanceError::Stages`], [`InstanceError::Dynamics`], [`InstanceError::Position`] or
    /// [`InstanceError::Directions`].
    pub fn check(&self) -> Result<(), InstanceError> {
        if self.position_bounds.len() != KNOTS {
            let found = self.position_bounds.len();
            return Err(InstanceError::Stages(self.name.clone(), found));
        }
        let stages = self.a.len();
        if ![1, STAGES].contains(&stages) || self.b.len() != stages || self.offset.len() != stages {
            return Err(InstanceError::Dynamics(self.name.clone(), stages));
        }
        // Bits are compared so that no number that is none passes. The sum makes -0 to 0.
        let bits = |row: &[f64; 6]| row.map(|entry| (entry + 0.0).to_bits());
        let differs = |(at, a): (usize, &[[f64; 6]; 6])| {
            a.map(|row| bits(&row)) != rows_of(&self.dynamics(at).a()).map(|row| bits(&row))
        };
        if self.a.iter().enumerate().any(differs) {
            return Err(InstanceError::Position(self.name.clone()));
        }
        let vectors = DIRECTION_VECTORS.map(|[up, forward]| [forward, up]);
        let far = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) > 1e-9;
        if self.directions.iter().zip(&vectors).any(|(a, b)| far(a, b)) {
            return Err(InstanceError::Directions(self.name.clone()));
        }
        Ok(())
    }
}

/// The rows of a matrix.
fn rows_of<const COLS: usize>(matrix: &SMatrix<f64, 6, COLS>) -> [[f64; COLS]; 6] {
    core::array::from_fn(|row| core::array::from_fn(|col| matrix[(row, col)]))
}

/// The reason why a text holds no programs.
#[derive(Debug, thiserror::Error)]
pub enum InstanceError {
    /// The text is not the JSON that it should be.
    #[error("{0}")]
    Json(#[source] serde_json::Error),
    /// The program of this name has another number of stage boundaries than the core.
    #[error("{0}: position_bounds has {1} stages instead of {KNOTS}")]
    Stages(String, usize),
    /// The program of this name has dynamics for another number of stages than one or all.
    #[error("{0}: a, b and offset have {1} stages instead of 1 or {STAGES}")]
    Dynamics(String, usize),
    /// The program of this name has a motion that depends on the position.
    #[error(
        "{0}: the first two columns of a must be those of the identity, because the core takes it that a \
         motion does not depend on the position"
    )]
    Position(String),
    /// The program of this name has other directions than the core.
    #[error("{0}: directions are not the eight of this crate")]
    Directions(String),
    /// The recorded case of this name has a model without steady state.
    #[error("{0}: the plan's model has no steady state")]
    NoSteadyState(String),
}

impl From<serde_json::Error> for InstanceError {
    fn from(error: serde_json::Error) -> Self {
        Self::Json(error)
    }
}

#[cfg(test)]
mod tests {
    use super::{Instance, InstanceError};
    use mpp_core::qp::{Bounds, Dynamics, MOTION, Penalty, Problem, STATES, Weights};
    use nalgebra::SMatrix;

    fn program() -> (Dynamics, Problem) {
        let model = Dynamics {
            motion: SMatrix::<f64, STATES, MOTION>::from_fn(|row, col| (row + 6 * col) as f64),
            ..Dynamics::at_rest()
        };
        let mut bounds = Bounds::none();
        bounds.set_thrust([12.0, 3.0]);
        bounds.set_attitude([0.2, 0.6], [-0.1, -0.5]);
        let problem = Problem {
            initial: [1.0; STATES],
            target: [2.0; STATES],
            bounds,
            penalty: Some(Penalty {
                linear: 10.0,
                quadratic: 20.0,
            }),
            hard_angle_of_attack: [true, false],
            cost_limit: f64::INFINITY,
        };
        (model, problem)
    }

    #[test]
    fn a_program_keeps_its_model_and_rows() {
        let (model, problem) = program();
        let instance = Instance::of_program("a".into(), &[model], &Weights::PAPER, &problem);
        assert_eq!(instance.dynamics(0), model);
        assert_eq!(instance.problem(), problem);
        instance.check().unwrap();
    }

    #[test]
    fn a_model_that_depends_on_the_position_is_refused() {
        let (model, problem) = program();
        let mut instance = Instance::of_program("a".into(), &[model], &Weights::PAPER, &problem);
        instance.a[0][2][1] = 1e-3;
        let refusal = instance.check().unwrap_err();
        assert!(matches!(&refusal, InstanceError::Position(name) if name == "a"));
        assert!(
            refusal
                .to_string()
                .starts_with("a: the first two columns of a must be")
        );
    }
}
