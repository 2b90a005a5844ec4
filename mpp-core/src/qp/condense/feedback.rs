//! The feedback that is optimal without rows, by Riccati's recursion (Bertsekas: "Dynamic Programming and
//! Optimal Control", volume 1, section 4.1).
//!
//! Let `x' S x / 2 + s' x` be the cost from the next stage on. With `M = R + B' S B` and `T T' = M^-1` the
//! cost of a stage is least at `u = -F x - g`, and it rises by `v' v / 2` at
//!
//! ```text
//! u = -F x - g + T v        F = M^-1 B' S A        g = M^-1 B' (S d + s)
//! ```
//!
//! The vector `v` holds the *normalised controls*. In all normalised controls of the horizon the Hessian is
//! the identity.

use crate::config::STAGES;
use crate::qp::controls::ControlVector;
use crate::qp::{Dynamics, MOTION, POSITION, STATES, StageControl, StageState, Weights};
use nalgebra::{ArrayStorage, Matrix2, SMatrix, SVector, Vector2};

/// Feedback of one stage.
#[derive(Clone, Copy, Debug)]
pub(super) struct Feedback {
    /// `F`, 2 x 6.
    pub(super) gain: SMatrix<f64, 2, STATES>,
    /// `T`, 2 x 2, lower triangular.
    pub(super) scale: Matrix2<f64>,
    /// `S d`: the part of the slope `s` that the offset of the stage adds.
    offset_slope: SVector<f64, STATES>,
}

impl Feedback {
    /// Feedback of zeros, to be filled.
    pub(super) const fn none() -> Self {
        Self {
            gain: SMatrix::from_array_storage(ArrayStorage([[0.0; 2]; STATES])),
            scale: Matrix2::from_array_storage(ArrayStorage([[0.0; 2]; 2])),
            offset_slope: SVector::from_array_storage(ArrayStorage([[0.0; STATES]])),
        }
    }

    /// State matrix of the stage under the feedback, `A - B F`.
    pub(super) fn closed(&self, dynamics: &Dynamics) -> SMatrix<f64, STATES, STATES> {
        dynamics.a() - dynamics.b * self.gain
    }

    /// The control `-F x - g + T v`.
    pub(super) fn control(
        &self,
        state: &StageState,
        feedforward: &StageControl,
        normalised: &StageControl,
    ) -> StageControl {
        let [g, v] = [feedforward, normalised].map(|pair| Vector2::from(*pair));
        let state = SVector::from(*state);
        (self.scale * v - self.gain * state - g).into()
    }
}

/// Computes the feedback of every stage from the last to the first. Returns `None` if a matrix `M` is not
/// positive definite or the model is not finite.
// Not inlined, so that its matrices do not lie on the stack beneath the response.
#[inline(never)]
pub(super) fn design(
    dynamics: &[Dynamics; STAGES],
    weights: &Weights,
    feedback: &mut [Feedback; STAGES],
) -> Option<()> {
    let control = Matrix2::from_diagonal(&Vector2::from(weights.control));
    let mut cost = SMatrix::<f64, STATES, STATES>::from_diagonal_element(weights.terminal);
    for (stage, feedback) in dynamics.iter().zip(feedback).rev() {
        let Dynamics { motion, b, offset } = stage;
        let by_control = cost * b;
        let columns = cost * motion;
        // `S A`
        let mut passed = cost;
        (passed.fixed_columns_mut::<MOTION>(POSITION)).copy_from(&columns);
        let scale = inverse_root(&(control + b.transpose() * by_control))?;
        let gain = scale * (scale.transpose() * (b.transpose() * passed));
        *feedback = Feedback {
            gain,
            scale,
            offset_slope: cost * offset,
        };
        // The cost from this stage on, `A' (S A - S B F)`, is symmetric, so its upper triangle serves for both.
        passed -= by_control * gain;
        let rows = motion.transpose() * passed;
        cost = passed;
        (cost.fixed_rows_mut::<MOTION>(POSITION)).copy_from(&rows);
        cost.fill_lower_triangle_with_upper_triangle();
    }
    cost.iter().all(|entry| entry.is_finite()).then_some(())
}

/// The feedforward `g` of every stage for a target of the last state.
pub(super) fn feedforward(
    dynamics: &[Dynamics; STAGES],
    weights: &Weights,
    feedback: &[Feedback; STAGES],
    target: &StageState,
) -> ControlVector {
    let mut controls = [[0.0; 2]; STAGES];
    let mut slope = SVector::from(*target) * -weights.terminal;
    let stages = dynamics.iter().zip(feedback).zip(&mut controls);
    for ((stage, feedback), control) in stages.rev() {
        let Feedback {
            gain,
            scale,
            offset_slope,
        } = feedback;
        slope += offset_slope;
        let pull = stage.b.transpose() * slope;
        // `A' s`
        let rows = stage.motion.transpose() * slope;
        (slope.fixed_rows_mut::<MOTION>(POSITION)).copy_from(&rows);
        slope -= gain.transpose() * pull;
        *control = (scale * (scale.transpose() * pull)).into();
    }
    controls
        .as_flattened()
        .try_into()
        .unwrap_or([0.0; 2 * STAGES])
}

/// The lower triangle `T` with `T T' = M^-1`, or `None` if `M` is not positive definite.
fn inverse_root(matrix: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    let [[first, coupling], [_, second]]: [[f64; 2]; 2] = (*matrix).into();
    let root = |square: f64| (square > 0.0 && square.is_finite()).then(|| libm::sqrt(square));
    // `M = U U'` with an upper triangle `U`, and `T` is the inverse of `U'`.
    let corner = root(second)?;
    let beside = coupling / corner;
    let diagonal = root(first - beside * beside)?;
    Some(Matrix2::new(
        1.0 / diagonal,
        0.0,
        -beside / (diagonal * corner),
        1.0 / corner,
    ))
}
