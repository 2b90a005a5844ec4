//! Sizes of the programs, and where their outputs and rows stand.

use crate::config::STAGES;

/// Number of states of a program.
pub const STATES: usize = 8;
/// Number of states that are the position `(x, y, z)`. They stand first.
pub const POSITION: usize = 3;
/// Number of the other states, which are called the motion.
pub const MOTION: usize = STATES - POSITION;
/// Number of inputs of a stage.
pub const INPUTS: usize = 3;
/// Most outputs in a row.
pub(in crate::qp) const TERMS: usize = 3;
/// State of a program: `(x, y, z, v, alpha, bank, path, course)`, the deviation from straight and level flight.
pub type StageState = [f64; STATES];
/// Control of a program: `(rate of the bank, rate of the angle of attack, thrust)`.
pub type StageControl = [f64; INPUTS];

/// Number of outputs. Outputs are the quantities that rows bound: positions at boundaries 1 to N, then the inputs of stages
/// 0 to N - 1, then the attitudes `(alpha, bank, path, course)` at boundaries 1 to N.
pub(in crate::qp) const OUTPUTS: usize = ATTITUDE_OUTPUT + ATTITUDES * STAGES;
/// Index of the first input among the outputs.
pub(in crate::qp) const INPUT_OUTPUT: usize = POSITION * STAGES;
/// Index of the first attitude among the outputs.
pub(in crate::qp) const ATTITUDE_OUTPUT: usize = INPUT_OUTPUT + INPUTS * STAGES;
/// First state that is an attitude.
const ATTITUDE: usize = STATES - ATTITUDES;

/// Number of controls, from the first on, that can change an output: those of the stages before it.
pub(in crate::qp) const fn reach(output: usize) -> usize {
    let stage = if output < INPUT_OUTPUT {
        output / POSITION
    } else if output < ATTITUDE_OUTPUT {
        (output - INPUT_OUTPUT) / INPUTS
    } else {
        (output - ATTITUDE_OUTPUT) / ATTITUDES
    };
    INPUTS * (stage + 1)
}

/// The outputs that are states at the end of a stage: output and state.
pub(in crate::qp) fn state_outputs(stage: usize) -> [(usize, usize); POSITION + ATTITUDES] {
    core::array::from_fn(|index| {
        if index < POSITION {
            (POSITION * stage + index, index)
        } else {
            let attitude = index - POSITION;
            (
                ATTITUDE_OUTPUT + ATTITUDES * stage + attitude,
                ATTITUDE + attitude,
            )
        }
    })
}

/// The outputs that are inputs of a stage: output and input.
pub(in crate::qp) fn input_outputs(stage: usize) -> [(usize, usize); INPUTS] {
    core::array::from_fn(|input| (INPUT_OUTPUT + INPUTS * stage + input, input))
}

/// Most faces at a stage boundary: those of the segments before and after it, and those of the band.
pub const FACES: usize = 20;
/// Number of attitudes that rows bound: `(alpha, bank, path, course)`.
pub(in crate::qp) const ATTITUDES: usize = MOTION - 1;
/// Number of rows on positions, at boundaries 1 to N.
pub(in crate::qp) const FACE_ROWS: usize = STAGES * FACES;
/// First of the last rows, which come in pairs: both limits of an input.
pub(in crate::qp) const LAST_ROWS: usize = FACE_ROWS + STAGES * 2 * ATTITUDES;
/// Number of all rows of a program.
pub const ROWS: usize = LAST_ROWS + STAGES * 2 * INPUTS;

/// The quantity that a row bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    /// Face of the corridor: the stage boundary, from 1 on, and the number of the face.
    Face(usize, usize),
    /// Limit of an attitude: the stage boundary, and twice the number of the attitude in `(alpha, bank, path, course)`; one
    /// more for the lower limit.
    Attitude(usize, usize),
    /// Limit of an input: the stage, and twice the number of the input; one more for the lower limit.
    Input(usize, usize),
}

impl RowKind {
    /// The meaning of a row number.
    #[must_use]
    pub fn of(row: usize) -> Self {
        if row < FACE_ROWS {
            Self::Face(row / FACES + 1, row % FACES)
        } else if row < LAST_ROWS {
            let row = row - FACE_ROWS;
            Self::Attitude(row / (2 * ATTITUDES) + 1, row % (2 * ATTITUDES))
        } else {
            let row = row - LAST_ROWS;
            Self::Input(row / (2 * INPUTS), row % (2 * INPUTS))
        }
    }
}
