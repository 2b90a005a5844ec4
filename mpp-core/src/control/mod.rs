//! Linear quadratic regulator of the flight path by the elevator (paper, II-B).

mod lateral;
mod riccati;
mod sampled;
mod space;

use crate::vehicle::{AirState, Control, Linearization};
pub use lateral::{LateralMotion, LateralRegulator, NoLateralGain};
use nalgebra::{Matrix4, RowVector4, Vector4};
pub use riccati::{RiccatiError, solve_riccati};
pub(crate) use sampled::holds;
pub(crate) use space::follow;
pub use space::{SpaceMotion, SpaceRegulator};

/// Weights of the regulator: `Q` on `(v, theta, theta', gamma)` and `R` on the elevator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LqrWeights {
    /// Diagonal of `Q`.
    pub state: [f64; 4],
    /// Weight `R` of the elevator.
    pub elevator: f64,
}

impl LqrWeights {
    /// The paper's `Q = diag(1, 1, 0, 1000)`, `R = 1/2`.
    pub const PAPER: Self = Self {
        state: [1.0, 1.0, 0.0, 1000.0],
        elevator: 0.5,
    };
}

/// State feedback `delta_e = delta_e_ff - K (x - x_ref)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lqr {
    /// Gain `K`, 1 x 4, elevator per unit of `(v, theta, theta', gamma)`.
    pub gain: RowVector4<f64>,
}

impl Lqr {
    /// The optimal gain `K = R^-1 B' X` for a linearised aircraft.
    ///
    /// # Errors
    /// [`RiccatiError`] if the solver finds no stabilising solution. The vehicle then does not start.
    pub fn design(linear: &Linearization, weights: &LqrWeights) -> Result<Self, RiccatiError> {
        let elevator: Vector4<f64> = linear.b.column(1).into();
        let q = Matrix4::from_diagonal(&Vector4::from(weights.state));
        let g = elevator * elevator.transpose() / weights.elevator;
        let cost = solve_riccati(&linear.a, &g, &q)?;
        Ok(Self {
            gain: elevator.transpose() * cost / weights.elevator,
        })
    }

    /// The control whose elevator drives `estimate` to `reference`. The thrust is that of `feedforward`.
    #[must_use]
    pub fn track(
        &self,
        estimate: &AirState,
        reference: &AirState,
        feedforward: Control,
    ) -> Control {
        let error = estimate.to_vector() - reference.to_vector();
        Control {
            thrust: feedforward.thrust,
            elevator: feedforward.elevator - (self.gain * error).x,
        }
    }
}
