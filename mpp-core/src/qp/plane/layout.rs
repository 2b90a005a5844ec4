//! Sizes of the programs, and where their outputs and rows stand.

use crate::config::{DIRECTIONS, KNOTS, STAGES};

/// Number of states of a program.
pub const STATES: usize = 6;
/// Number of states that are the position `(x, z)`. They stand first.
pub const POSITION: usize = 2;
/// Number of the other states, which are called the motion.
pub const MOTION: usize = STATES - POSITION;
/// Number of inputs of a stage.
pub const INPUTS: usize = 2;
/// Most outputs in a row.
pub(in crate::qp) const TERMS: usize = 2;
/// State of a program, the deviation from level trim: `(x, z, v, theta, theta', gamma)` in the paper's method, and in the
/// plane planner `(x, z, v, theta, thrust, gamma)`.
pub type StageState = [f64; STATES];
/// Place of the pitch in a state. The flight path stands last.
pub(crate) const PITCH: usize = 3;

/// Control of a program, the deviation from level trim: `(elevator, thrust)` \[-, N\] in the paper's method, and in the
/// plane planner `(rate of the angle of attack, thrust)` \[rad/s, N\], which computes in its
/// [own units](crate::units::Units).
pub type StageControl = [f64; INPUTS];

/// Number of outputs. Outputs are the quantities that rows bound: positions `(x, z)` at boundaries 1 to N,
/// then the thrusts of stages 0 to N - 1, then attitudes `(theta, gamma)` at boundaries 1 to N. Programs
/// without attitude rows do not need the attitudes.
pub(in crate::qp) const OUTPUTS: usize = ATTITUDE_OUTPUT + 2 * STAGES;
/// Index of the first thrust among the outputs.
pub(in crate::qp) const THRUST_OUTPUT: usize = 2 * STAGES;
/// Index of the first attitude among the outputs.
pub(in crate::qp) const ATTITUDE_OUTPUT: usize = THRUST_OUTPUT + STAGES;

/// Number of controls, from the first on, that can change an output: those of the stages before it.
pub(in crate::qp) const fn reach(output: usize) -> usize {
    let stage = if output < THRUST_OUTPUT {
        output / 2
    } else if output < ATTITUDE_OUTPUT {
        output - THRUST_OUTPUT
    } else {
        (output - ATTITUDE_OUTPUT) / 2
    };
    INPUTS * (stage + 1)
}

/// The outputs that are states at the end of a stage: output and state.
pub(in crate::qp) fn state_outputs(stage: usize) -> [(usize, usize); 4] {
    let (position, attitude) = (2 * stage, ATTITUDE_OUTPUT + 2 * stage);
    [
        (position, 0),
        (position + 1, 1),
        (attitude, PITCH),
        (attitude + 1, STATES - 1),
    ]
}

/// The outputs that are inputs of a stage: output and input.
pub(in crate::qp) fn input_outputs(stage: usize) -> [(usize, usize); 1] {
    [(THRUST_OUTPUT + stage, 1)]
}

/// Number of rows on positions, boundary 0 included.
pub(in crate::qp) const POSITION_ROWS: usize = KNOTS * DIRECTIONS;
/// Number of rows on attitudes: angle of attack and flight path, upper and lower, at boundaries 1 to N.
pub(in crate::qp) const ATTITUDE_ROWS: usize = STAGES * 4;
/// Number of all rows of a program.
pub const ROWS: usize = LAST_ROWS + 2 * STAGES;
/// First of the last rows, which come in pairs: both limits of a thrust.
pub(in crate::qp) const LAST_ROWS: usize = POSITION_ROWS + ATTITUDE_ROWS;

/// The quantity that a row bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    /// Half-plane of the corridor. The numbers are the stage boundary and the direction.
    Position(usize, usize),
    /// Limit of the attitude. The first number is the stage boundary. The second number is even for the
    /// angle of attack and odd for the flight path; 0 and 1 are upper limits, 2 and 3 are lower limits.
    Attitude(usize, usize),
    /// Limit of the thrust. The first number is the stage. The second number is 0 for the upper limit and 1
    /// for the lower limit.
    Thrust(usize, usize),
}

impl RowKind {
    /// The meaning of a row number.
    #[must_use]
    pub fn of(row: usize) -> Self {
        if row < POSITION_ROWS {
            Self::Position(row / DIRECTIONS, row % DIRECTIONS)
        } else if row < POSITION_ROWS + ATTITUDE_ROWS {
            let row = row - POSITION_ROWS;
            Self::Attitude(row / 4 + 1, row % 4)
        } else {
            let row = row - POSITION_ROWS - ATTITUDE_ROWS;
            Self::Thrust(row / 2, row % 2)
        }
    }
}
