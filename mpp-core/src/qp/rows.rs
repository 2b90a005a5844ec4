//! The rows of the program: which outputs each touches, and its right-hand side.

use crate::config::{DIRECTIONS, KNOTS, STAGES};
use crate::corridor::{Corridor, DIRECTION_VECTORS};

/// Outputs of a stage boundary that rows touch: `x, z, theta, gamma`.
pub(super) const STAGE_OUTPUTS: [usize; 4] = [0, 1, 3, 5];
/// Outputs: those of boundaries 1 to N, then the thrusts of stages 0 to N - 1.
pub(super) const OUTPUTS: usize = STAGES * STAGE_OUTPUTS.len() + STAGES;
/// The first thrust among the outputs.
pub(super) const THRUST_OUTPUT: usize = STAGES * STAGE_OUTPUTS.len();

/// Rows on positions, boundary 0 included.
const POSITION_ROWS: usize = KNOTS * DIRECTIONS;
/// Rows on attitudes: angle of attack and flight path, upper and lower, of boundaries 1 to N.
const ATTITUDE_ROWS: usize = STAGES * 4;
/// All rows of a program.
pub const ROWS: usize = POSITION_ROWS + ATTITUDE_ROWS + STAGES;

const _: () = assert!(ROWS < u16::MAX as usize && OUTPUTS < u8::MAX as usize);

/// Right-hand sides of the rows; infinite where a row is not there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds(pub [f64; ROWS]);

/// What a row bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    /// A half-plane of the corridor, by stage boundary and direction.
    Position(usize, usize),
    /// Angle of attack (even) or flight path (odd), upper (0, 1) or lower (2, 3), by stage boundary.
    Attitude(usize, usize),
    /// Thrust from below, by stage.
    Thrust(usize),
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
            Self::Thrust(row - POSITION_ROWS - ATTITUDE_ROWS)
        }
    }
}

/// `first.1 y[first.0] + second.1 y[second.0]`: a row's left-hand side in outputs `y`.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowPattern {
    pub(super) first: (usize, f64),
    pub(super) second: (usize, f64),
}

impl RowPattern {
    /// The pattern of a row; none for the rows of boundary 0, which no control can change.
    pub(super) fn of(row: usize) -> Option<Self> {
        match RowKind::of(row) {
            RowKind::Position(0, _) => None,
            RowKind::Position(stage, direction) => {
                let [up, forward] = *DIRECTION_VECTORS.get(direction)?;
                let base = (stage - 1) * STAGE_OUTPUTS.len();
                Some(Self {
                    first: (base, forward),
                    second: (base + 1, up),
                })
            }
            RowKind::Attitude(stage, which) => {
                let pitch = (stage - 1) * STAGE_OUTPUTS.len() + 2;
                let side = if which < 2 { 1.0 } else { -1.0 };
                let angle_of_attack = which % 2 == 0;
                Some(Self {
                    first: (pitch, if angle_of_attack { side } else { 0.0 }),
                    second: (pitch + 1, if angle_of_attack { -side } else { side }),
                })
            }
            RowKind::Thrust(stage) => Some(Self::single(THRUST_OUTPUT + stage, -1.0)),
        }
    }

    fn single(output: usize, factor: f64) -> Self {
        Self {
            first: (output, factor),
            second: (output, 0.0),
        }
    }

    /// The row's left-hand side.
    pub(super) fn value(&self, outputs: &[f64; OUTPUTS]) -> f64 {
        let at = |(output, factor): (usize, f64)| {
            outputs.get(output).map_or(0.0, |value| value * factor)
        };
        at(self.first) + at(self.second)
    }
}

impl Bounds {
    /// No rows at all.
    #[must_use]
    pub const fn none() -> Self {
        Self([f64::INFINITY; ROWS])
    }

    /// Takes every row away.
    pub fn clear(&mut self) {
        self.0.fill(f64::INFINITY);
    }

    /// Sets the half-planes of a corridor.
    pub fn set_corridor(&mut self, corridor: &Corridor) {
        let rows = self.0.iter_mut().take(POSITION_ROWS);
        for (row, bound) in rows.zip(corridor.bounds.iter().flatten()) {
            *row = *bound;
        }
    }

    /// Sets the attitude rows: deviations from trim of `(angle of attack, flight path)`, upper then
    /// lower limits [rad].
    pub fn set_attitude(&mut self, upper: [f64; 2], lower: [f64; 2]) {
        let sides = [upper[0], upper[1], -lower[0], -lower[1]];
        let rows = self.0.iter_mut().skip(POSITION_ROWS).take(ATTITUDE_ROWS);
        for (row, side) in rows.zip(sides.iter().cycle()) {
            *row = *side;
        }
    }

    /// Sets the thrust rows: thrust may fall by at most this much [N] below trim.
    pub fn set_thrust(&mut self, reserve: f64) {
        for row in self.0.iter_mut().skip(POSITION_ROWS + ATTITUDE_ROWS) {
            *row = reserve;
        }
    }
}
