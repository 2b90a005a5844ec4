//! The discrete model of a stage, about any trajectory.

use super::{MOTION, POSITION, STATES, StageControl, StageState};
use nalgebra::{ArrayStorage, SMatrix, SVector, Vector2};

/// Dynamics of one stage, `x_{k+1} = a x_k + b u_k + offset`, linearised about any trajectory. An aircraft moves in the
/// same way wherever it is, so the first two columns of `a` are those of the identity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// Columns 3 to 6 of the state matrix, 6 x 4: those of the motion.
    pub motion: SMatrix<f64, STATES, MOTION>,
    /// Control matrix, 6 x 2.
    pub b: SMatrix<f64, STATES, 2>,
    /// Next state from the state zero without control.
    pub offset: SVector<f64, STATES>,
}

impl Dynamics {
    /// Dynamics of zeros, to be filled.
    #[must_use]
    pub const fn at_rest() -> Self {
        Self {
            motion: SMatrix::from_array_storage(ArrayStorage([[0.0; STATES]; MOTION])),
            b: SMatrix::from_array_storage(ArrayStorage([[0.0; STATES]; 2])),
            offset: SVector::from_array_storage(ArrayStorage([[0.0; STATES]])),
        }
    }

    /// The state after the stage.
    #[must_use]
    pub fn step(&self, state: &StageState, control: &StageControl) -> StageState {
        let control = self.b * Vector2::from(*control);
        let [x, z, motion @ ..] = *state;
        let moved = self.motion * SVector::from(motion) + control + self.offset;
        let mut next: StageState = moved.into();
        next[0] += x;
        next[1] += z;
        next
    }

    /// The whole state matrix, 6 x 6.
    #[must_use]
    pub fn a(&self) -> SMatrix<f64, STATES, STATES> {
        let mut a = SMatrix::<f64, STATES, STATES>::identity();
        a.fixed_columns_mut::<MOTION>(POSITION)
            .copy_from(&self.motion);
        a
    }
}
