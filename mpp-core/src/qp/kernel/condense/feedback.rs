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

use super::super::super::outputs::inverse_root;
use super::super::super::{INPUTS, MOTION, POSITION, STATES, StageControl, StageState};
use super::super::{CONTROLS, ControlVector, Dynamics, Weights};
use crate::config::STAGES;
use nalgebra::{ArrayStorage, SMatrix, SVector};

/// Feedback of one stage.
#[derive(Clone, Copy, Debug)]
pub(super) struct Feedback {
    /// `F`, `INPUTS` x `STATES`.
    pub(super) gain: SMatrix<f64, INPUTS, STATES>,
    /// `T`, `INPUTS` x `INPUTS`, lower triangular.
    pub(super) scale: SMatrix<f64, INPUTS, INPUTS>,
    /// `S d`: the part of the slope `s` that the offset of the stage adds.
    offset_slope: SVector<f64, STATES>,
}

impl Feedback {
    /// Feedback of zeros, to be filled.
    pub(super) const fn none() -> Self {
        Self {
            gain: SMatrix::from_array_storage(ArrayStorage([[0.0; INPUTS]; STATES])),
            scale: SMatrix::from_array_storage(ArrayStorage([[0.0; INPUTS]; INPUTS])),
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
        let [g, v] = [feedforward, normalised].map(|control| SVector::from(*control));
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
    let control = SMatrix::<f64, INPUTS, INPUTS>::from_diagonal(&SVector::from(weights.control));
    let mut cost =
        SMatrix::<f64, STATES, STATES>::from_diagonal(&SVector::from(weights.of_misses()));
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
    let mut controls = [0.0; CONTROLS];
    let mut slope = -SVector::from(*target).component_mul(&SVector::from(weights.of_misses()));
    // The stages run backwards over arrays of one length: an iterator that is cut short would have a panic path.
    let Some(places) = (controls.as_chunks_mut::<INPUTS>().0).first_chunk_mut::<STAGES>() else {
        return controls;
    };
    let stages = dynamics.iter().zip(feedback).zip(places);
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
}
