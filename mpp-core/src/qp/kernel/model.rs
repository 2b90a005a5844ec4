//! The discrete model of a stage, about any trajectory.

use super::super::{INPUTS, MOTION, POSITION, STATES, StageControl, StageState};
use nalgebra::{ArrayStorage, SMatrix, SVector};

/// Dynamics of one stage, `x_{k+1} = a x_k + b u_k + offset`, linearised about any trajectory. An aircraft moves in the
/// same way wherever it is, so the first columns of `a`, those of the position, are those of the identity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// The other columns of the state matrix, `STATES` x `MOTION`: those of the motion.
    pub motion: SMatrix<f64, STATES, MOTION>,
    /// Control matrix, `STATES` x `INPUTS`.
    pub b: SMatrix<f64, STATES, INPUTS>,
    /// Next state from the state zero without control.
    pub offset: SVector<f64, STATES>,
}

impl Dynamics {
    /// Dynamics of zeros, to be filled.
    #[must_use]
    pub const fn at_rest() -> Self {
        Self {
            motion: SMatrix::from_array_storage(ArrayStorage([[0.0; STATES]; MOTION])),
            b: SMatrix::from_array_storage(ArrayStorage([[0.0; STATES]; INPUTS])),
            offset: SVector::from_array_storage(ArrayStorage([[0.0; STATES]])),
        }
    }

    /// The state after the stage.
    #[must_use]
    pub fn step(&self, state: &StageState, control: &StageControl) -> StageState {
        let control = self.b * SVector::from(*control);
        let state = SVector::from(*state);
        let motion = state.fixed_rows::<MOTION>(POSITION);
        let moved = self.motion * motion + control + self.offset;
        let mut next: StageState = moved.into();
        for (next, position) in next.iter_mut().zip(state.fixed_rows::<POSITION>(0).iter()) {
            *next += position;
        }
        next
    }

    /// The whole state matrix.
    #[must_use]
    pub fn a(&self) -> SMatrix<f64, STATES, STATES> {
        let mut a = SMatrix::<f64, STATES, STATES>::identity();
        a.fixed_columns_mut::<MOTION>(POSITION)
            .copy_from(&self.motion);
        a
    }
}
