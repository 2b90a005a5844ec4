//! The discrete model of the paper's program: forward Euler at the stage period, with the rotation in steady
//! state (paper, section III-D).

use crate::config::STAGE_PERIOD;
use crate::inverse::inverse;
use crate::qp::{Dynamics, MOTION, PITCH, POSITION, STATES, StageControl, StageState};
use crate::vehicle::{AirState, Airframe, JacobianForm, Linearization, Trim, linearize};
use nalgebra::{ArrayStorage, Matrix6, Matrix6x2, Vector6};

/// The rule that gives the plan's first state from the estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Initial {
    /// The first state is the estimate (the paper).
    Estimate,
    /// The first state is the estimate after multiplication by the steady-state rows (the authors'
    /// code). Pitch and pitch rate of the plan then differ from the estimate.
    ThroughSteadyState,
}

/// Model of a stage, `x_{k+1} = a x_k + b u_k`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageModel {
    /// State matrix, 6 x 6.
    pub a: Matrix6<f64>,
    /// Control matrix, 6 x 2.
    pub b: Matrix6x2<f64>,
    /// Matrix that maps the estimated deviation to the plan's first state, 6 x 6.
    pub initial: Matrix6<f64>,
}

/// The steady-state rows have no solution: the airframe has no pitch stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the plan's model has no steady state: check the pitch stiffness of the airframe")]
pub struct ModelError;

const PITCH_RATE: usize = PITCH + 1;
const FLIGHT_PATH: usize = STATES - 1;

impl StageModel {
    /// A model of zeros, to be filled.
    pub(crate) const fn at_rest() -> Self {
        let nothing = Matrix6::from_array_storage(ArrayStorage([[0.0; STATES]; STATES]));
        Self {
            a: nothing,
            b: Dynamics::at_rest().b,
            initial: nothing,
        }
    }

    /// Linearises the aircraft about level trim and discretises it. Pitch and pitch rate are too fast for the stage
    /// period, so they are in steady state (the paper): `(I - A) x_{k+1} = B u_k` holds for both. This makes
    /// the pitch rate zero.
    ///
    /// # Errors
    /// [`ModelError`] if the model has no steady state. The planner then does not start.
    pub fn new(
        airframe: &Airframe,
        trim: &Trim,
        form: JacobianForm,
        initial: Initial,
    ) -> Result<Self, ModelError> {
        let linear = linearize(airframe, &trim.state, trim.control, form);
        let (a, b) = euler(trim, &linear);
        let (left, a, b) = zero_pitch_rate(a, b);
        let inverse = inverse(&left).ok_or(ModelError)?;
        let model = Self {
            a: inverse * a,
            b: inverse * b,
            initial: match initial {
                Initial::Estimate => Matrix6::identity(),
                Initial::ThroughSteadyState => inverse,
            },
        };
        let entries = model.a.iter().chain(&model.b);
        if entries.copied().all(f64::is_finite) {
            Ok(model)
        } else {
            Err(ModelError)
        }
    }

    /// The dynamics of one stage by this model.
    #[must_use]
    pub fn dynamics(&self) -> Dynamics {
        Dynamics {
            motion: self.a.fixed_columns::<MOTION>(POSITION).into_owned(),
            b: self.b,
            offset: Vector6::zeros(),
        }
    }

    /// The state after a stage.
    #[must_use]
    pub fn step(&self, state: &StageState, control: &StageControl) -> StageState {
        self.dynamics().step(state, control)
    }

    /// The plan's first state for an estimated motion: the deviation from trim, at the origin.
    #[must_use]
    pub fn initial_state(&self, trim: &Trim, estimate: &AirState) -> StageState {
        let d = estimate.to_vector() - trim.state.to_vector();
        (self.initial * Vector6::new(0.0, 0.0, d.x, d.y, d.z, d.w)).into()
    }
}

/// The matrices `I + dt A_c` and `dt B_c`, with the rows of the position.
fn euler(trim: &Trim, linear: &Linearization) -> (Matrix6<f64>, Matrix6x2<f64>) {
    let mut a = Matrix6::identity();
    a[(0, 2)] = STAGE_PERIOD;
    a[(1, FLIGHT_PATH)] = trim.state.airspeed * STAGE_PERIOD;
    let mut b = Matrix6x2::zeros();
    for row in 0..4 {
        for col in 0..4 {
            a[(row + 2, col + 2)] += linear.a[(row, col)] * STAGE_PERIOD;
        }
        b[(row + 2, 0)] = linear.b[(row, 1)] * STAGE_PERIOD;
        b[(row + 2, 1)] = linear.b[(row, 0)] * STAGE_PERIOD;
    }
    (a, b)
}

type Implicit = (Matrix6<f64>, Matrix6<f64>, Matrix6x2<f64>);

fn zero_pitch_rate(mut a: Matrix6<f64>, b: Matrix6x2<f64>) -> Implicit {
    let mut left = Matrix6::identity();
    for row in PITCH..=PITCH_RATE {
        for col in 0..6 {
            left[(row, col)] -= a[(row, col)];
            a[(row, col)] = 0.0;
        }
    }
    (left, a, b)
}
