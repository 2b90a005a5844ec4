//! The rows of the program: the outputs in each row, and the right-hand sides.

use crate::config::{DIRECTIONS, KNOTS, STAGES};
use crate::corridor::{Corridor, DIRECTION_VECTORS};

/// Number of outputs. Outputs are the quantities that rows bound: positions `(x, z)` at boundaries 1 to N,
/// then the thrusts of stages 0 to N - 1, then attitudes `(theta, gamma)` at boundaries 1 to N. Programs
/// without attitude rows do not need the attitudes.
pub(super) const OUTPUTS: usize = ATTITUDE_OUTPUT + 2 * STAGES;
/// Index of the first thrust among the outputs.
pub(super) const THRUST_OUTPUT: usize = 2 * STAGES;
/// Index of the first attitude among the outputs.
pub(super) const ATTITUDE_OUTPUT: usize = THRUST_OUTPUT + STAGES;

/// Number of controls, from the first on, that can change an output: those of the stages before it.
pub(super) const fn reach(output: usize) -> usize {
    let stage = if output < THRUST_OUTPUT {
        output / 2
    } else if output < ATTITUDE_OUTPUT {
        output - THRUST_OUTPUT
    } else {
        (output - ATTITUDE_OUTPUT) / 2
    };
    2 * (stage + 1)
}

/// Number of rows on positions, boundary 0 included.
pub(super) const POSITION_ROWS: usize = KNOTS * DIRECTIONS;
/// Number of rows on attitudes: angle of attack and flight path, upper and lower, at boundaries 1 to N.
pub(super) const ATTITUDE_ROWS: usize = STAGES * 4;
/// Number of all rows of a program.
pub const ROWS: usize = POSITION_ROWS + ATTITUDE_ROWS + 2 * STAGES;

const _: () = assert!(ROWS < u16::MAX as usize && OUTPUTS < u8::MAX as usize);

/// Right-hand sides of the rows; infinite for a row that the program does not have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds(pub [f64; ROWS]);

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

/// Left-hand side of a row in the outputs `y`: `first.1 y[first.0] + second.1 y[second.0]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RowPattern {
    pub(super) first: (usize, f64),
    pub(super) second: (usize, f64),
}

/// Share of a direction that is zero up to rounding. With it a row has one output less.
const NO_SHARE: f64 = 1e-15;

impl RowPattern {
    /// The pattern of a row. It is `None` for the rows of boundary 0, which no control can change.
    pub(super) fn of(row: usize) -> Option<Self> {
        match RowKind::of(row) {
            RowKind::Position(0, _) => None,
            RowKind::Position(stage, direction) => {
                let [up, forward] = DIRECTION_VECTORS
                    .get(direction)?
                    .map(|share| if share.abs() < NO_SHARE { 0.0 } else { share });
                let base = 2 * (stage - 1);
                Some(Self {
                    first: (base, forward),
                    second: (base + 1, up),
                })
            }
            RowKind::Attitude(stage, which) => {
                let pitch = ATTITUDE_OUTPUT + 2 * (stage - 1);
                let side = if which < 2 { 1.0 } else { -1.0 };
                let angle_of_attack = which % 2 == 0;
                Some(Self {
                    first: (pitch, if angle_of_attack { side } else { 0.0 }),
                    second: (pitch + 1, if angle_of_attack { -side } else { side }),
                })
            }
            RowKind::Thrust(stage, side) => {
                let side = if side == 0 { 1.0 } else { -1.0 };
                Some(Self::single(THRUST_OUTPUT + stage, side))
            }
        }
    }

    fn single(output: usize, factor: f64) -> Self {
        Self {
            first: (output, factor),
            second: (output, 0.0),
        }
    }

    /// Value of the row's left-hand side.
    pub(super) fn value(&self, outputs: &[f64; OUTPUTS]) -> f64 {
        let at = |(output, factor): (usize, f64)| {
            outputs.get(output).map_or(0.0, |value| value * factor)
        };
        at(self.first) + at(self.second)
    }
}

/// Rows of positions by boundary and direction, and rows of attitudes and thrusts by stage.
type RowParts<'a> = (&'a [[f64; DIRECTIONS]], &'a [[f64; 4]], &'a [[f64; 2]]);
type RowPartsMut<'a> = (
    &'a mut [[f64; DIRECTIONS]],
    &'a mut [[f64; 4]],
    &'a mut [[f64; 2]],
);

/// Splits values by row into those of positions, attitudes and thrusts.
pub(super) fn parts(values: &[f64; ROWS]) -> RowParts<'_> {
    let (positions, rest) = values.split_at(POSITION_ROWS);
    let (attitudes, thrusts) = rest.split_at(ATTITUDE_ROWS);
    (
        positions.as_chunks().0,
        attitudes.as_chunks().0,
        thrusts.as_chunks().0,
    )
}

/// Splits values as [`parts`] does, so that the caller can write them.
pub(super) fn parts_mut(values: &mut [f64; ROWS]) -> RowPartsMut<'_> {
    let (positions, rest) = values.split_at_mut(POSITION_ROWS);
    let (attitudes, thrusts) = rest.split_at_mut(ATTITUDE_ROWS);
    (
        positions.as_chunks_mut().0,
        attitudes.as_chunks_mut().0,
        thrusts.as_chunks_mut().0,
    )
}

impl Bounds {
    /// Bounds without any row.
    #[must_use]
    pub const fn none() -> Self {
        Self([f64::INFINITY; ROWS])
    }

    /// The rows of two opposite faces that cross by more than `least` \[m\], if there are such faces.
    pub(super) fn crossing_faces(&self, least: f64) -> Option<(usize, usize)> {
        const HALF: usize = DIRECTIONS / 2;
        parts(&self.0)
            .0
            .iter()
            .enumerate()
            .find_map(|(stage, faces)| {
                let (one, other) = faces.split_at(HALF);
                let crossing = one
                    .iter()
                    .zip(other)
                    .position(|(one, other)| one + other < -least)?;
                let row = stage * DIRECTIONS + crossing;
                Some((row, row + HALF))
            })
    }

    /// Whether the program has any attitude row.
    pub(super) fn has_attitude(&self) -> bool {
        parts(&self.0)
            .1
            .as_flattened()
            .iter()
            .any(|bound| *bound != f64::INFINITY)
    }

    /// Removes every row.
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

    /// Sets the attitude rows: upper and lower limits \[rad\] of the deviations of `(angle of attack, flight
    /// path)` from trim.
    pub fn set_attitude(&mut self, upper: [f64; 2], lower: [f64; 2]) {
        let sides = [upper[0], upper[1], -lower[0], -lower[1]];
        let rows = self.0.iter_mut().skip(POSITION_ROWS).take(ATTITUDE_ROWS);
        for (row, side) in rows.zip(sides.iter().cycle()) {
            *row = *side;
        }
    }

    /// Sets the thrust rows: the greatest rise of the thrust above trim and the greatest fall below it \[N\].
    pub fn set_thrust(&mut self, sides: [f64; 2]) {
        let rows = self.0.iter_mut().skip(POSITION_ROWS + ATTITUDE_ROWS);
        for (row, side) in rows.zip(sides.iter().cycle()) {
            *row = *side;
        }
    }
}
