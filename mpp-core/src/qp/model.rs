//! The discrete model of the planner: forward Euler at the stage period, rotation in steady state
//! (paper, section III-D).

use super::{StageControl, StageState};
use crate::config::STAGE_PERIOD;
use crate::inverse::inverse;
use crate::vehicle::{Airframe, Linearization, Trim};
use nalgebra::{Matrix6, Matrix6x2, Vector2, Vector6};

/// How pitch and pitch rate, too fast for the stage period, are replaced by steady state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SteadyState {
    /// The paper: `(I - A) x_{k+1} = B u_k` for both, which makes the pitch rate zero and lets the
    /// damping act against the turning path: 0.0309 rad of angle of attack per unit of elevator.
    ZeroPitchRate,
    /// Balance of moments at a constant angle of attack, the pitch turning with the path:
    /// 0.0249 rad per unit of elevator, as the aircraft flies.
    MomentBalance,
}

/// How the plan's first state follows from the estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Initial {
    /// The estimate itself (the paper).
    Estimate,
    /// The authors' code, which sends the estimate through the steady-state rows, so that its
    /// pitch and pitch rate are not the plan's.
    ThroughSteadyState,
}

/// `x_{k+1} = a x_k + b u_k`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageModel {
    /// 6 x 6.
    pub a: Matrix6<f64>,
    /// 6 x 2.
    pub b: Matrix6x2<f64>,
    /// From the estimated deviation to the plan's first state, 6 x 6.
    pub initial: Matrix6<f64>,
}

/// The steady-state rows have no solution: the airframe has no pitch stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelError;

const PITCH: usize = 3;
const PITCH_RATE: usize = 4;
const FLIGHT_PATH: usize = 5;

impl StageModel {
    /// A model that stands still: a place for one.
    #[must_use]
    pub const fn at_rest() -> Self {
        let zero = [[0.0; 6]; 6];
        Self {
            a: Matrix6::from_array_storage(nalgebra::ArrayStorage(zero)),
            b: Matrix6x2::from_array_storage(nalgebra::ArrayStorage([[0.0; 6]; 2])),
            initial: Matrix6::from_array_storage(nalgebra::ArrayStorage(zero)),
        }
    }

    /// Discretises the linearised aircraft about level trim.
    ///
    /// # Errors
    /// [`ModelError`]: the planner does not start.
    pub fn new(
        airframe: &Airframe,
        trim: &Trim,
        linear: &Linearization,
        steady: SteadyState,
        initial: Initial,
    ) -> Result<Self, ModelError> {
        let (a, b) = euler(trim, linear);
        let (left, a, b) = match steady {
            SteadyState::ZeroPitchRate => zero_pitch_rate(a, b),
            SteadyState::MomentBalance => moment_balance(airframe, a, b),
        };
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

    /// The model as one stage's dynamics.
    #[must_use]
    pub fn dynamics(&self) -> Dynamics {
        Dynamics {
            a: self.a,
            b: self.b,
            offset: Vector6::zeros(),
        }
    }

    /// The state after a stage.
    #[must_use]
    pub fn step(&self, state: &StageState, control: &StageControl) -> StageState {
        self.dynamics().step(state, control)
    }
}

/// `x_{k+1} = a x_k + b u_k + offset`: one stage, as linearised about any trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// 6 x 6.
    pub a: Matrix6<f64>,
    /// 6 x 2.
    pub b: Matrix6x2<f64>,
    /// Where the state goes from zero without control.
    pub offset: Vector6<f64>,
}

impl Dynamics {
    /// Dynamics that stand still: a place for some.
    #[must_use]
    pub const fn at_rest() -> Self {
        Self {
            a: StageModel::at_rest().a,
            b: StageModel::at_rest().b,
            offset: Vector6::from_array_storage(nalgebra::ArrayStorage([[0.0; 6]])),
        }
    }

    /// The state after the stage.
    #[must_use]
    pub fn step(&self, state: &StageState, control: &StageControl) -> StageState {
        self.step_with(state, control, &self.offset)
    }

    /// The same with another offset.
    pub(super) fn step_with(
        &self,
        state: &StageState,
        control: &StageControl,
        offset: &Vector6<f64>,
    ) -> StageState {
        let [elevator, thrust] = *control;
        let control = self.b * Vector2::new(elevator, thrust);
        (self.a * Vector6::from(*state) + control + offset).into()
    }
}

/// `I + dt A_c` and `dt B_c` with the position rows.
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

fn moment_balance(airframe: &Airframe, mut a: Matrix6<f64>, mut b: Matrix6x2<f64>) -> Implicit {
    let mut left = Matrix6::identity();
    left[(PITCH, FLIGHT_PATH)] = -1.0;
    for row in PITCH..=PITCH_RATE {
        for col in 0..6 {
            a[(row, col)] = 0.0;
        }
        for col in 0..2 {
            b[(row, col)] = 0.0;
        }
    }
    b[(PITCH, 0)] = -airframe.moment_elevator / airframe.moment_alpha;
    (left, a, b)
}
