//! The rows of the program: the outputs in each row, and the right-hand sides.

use super::kernel::RowPattern;
use super::layout::{
    ATTITUDE_OUTPUT, ATTITUDE_ROWS, LAST_ROWS, POSITION_ROWS, ROWS, RowKind, StageState, TERMS,
    THRUST_OUTPUT,
};
use crate::config::DIRECTIONS;
use crate::corridor::{Corridor, DIRECTION_VECTORS};

/// Normals that a program brings itself. Those of the plane are [`DIRECTION_VECTORS`].
pub(in crate::qp) type Normals = ();
pub(in crate::qp) const NO_NORMALS: Normals = ();

/// Right-hand sides of the rows; infinite for a row that the program does not have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds(pub [f64; ROWS]);

/// Share of a direction that is zero up to rounding. With it a row has one output less.
const NO_SHARE: f64 = 1e-15;

/// The pattern of a row. It is `None` for the rows of boundary 0, which no control can change.
pub(in crate::qp) fn pattern(row: usize, (): &Normals) -> Option<RowPattern> {
    let terms: [(usize, f64); TERMS] = match RowKind::of(row) {
        RowKind::Position(0, _) => return None,
        RowKind::Position(stage, direction) => {
            let [up, forward] = DIRECTION_VECTORS
                .get(direction)?
                .map(|share| if share.abs() < NO_SHARE { 0.0 } else { share });
            let base = 2 * (stage - 1);
            [(base, forward), (base + 1, up)]
        }
        RowKind::Attitude(stage, which) => {
            let pitch = ATTITUDE_OUTPUT + 2 * (stage - 1);
            let side = if which < 2 { 1.0 } else { -1.0 };
            let angle_of_attack = which % 2 == 0;
            [
                (pitch, if angle_of_attack { side } else { 0.0 }),
                (pitch + 1, if angle_of_attack { -side } else { side }),
            ]
        }
        RowKind::Thrust(stage, side) => {
            let side = if side == 0 { 1.0 } else { -1.0 };
            return Some(RowPattern::single(THRUST_OUTPUT + stage, side));
        }
    };
    Some(RowPattern(terms))
}

/// Value of the left-hand side of a row that no control can change, and that has no pattern.
pub(in crate::qp) fn value_at_start(row: usize, initial: &StageState) -> Option<f64> {
    match RowKind::of(row) {
        RowKind::Position(0, direction) => {
            let [up, forward] = DIRECTION_VECTORS.get(direction)?;
            Some(forward * initial[0] + up * initial[1])
        }
        _ => None,
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
pub(in crate::qp) fn parts(values: &[f64; ROWS]) -> RowParts<'_> {
    let (positions, rest) = values.split_at(POSITION_ROWS);
    let (attitudes, thrusts) = rest.split_at(ATTITUDE_ROWS);
    (
        positions.as_chunks().0,
        attitudes.as_chunks().0,
        thrusts.as_chunks().0,
    )
}

/// Splits values as [`parts`] does, so that the caller can write them.
pub(in crate::qp) fn parts_mut(values: &mut [f64; ROWS]) -> RowPartsMut<'_> {
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

    /// Calls `each` with both rows of opposite faces that cross by more than `least` \[m\], pair by pair.
    pub(in crate::qp) fn crossing_faces(&self, least: f64, mut each: impl FnMut(usize, usize)) {
        const HALF: usize = DIRECTIONS / 2;
        for (boundary, faces) in parts(&self.0).0.iter().enumerate() {
            let (one, other) = faces.split_at(HALF);
            for (direction, (one, other)) in one.iter().zip(other).enumerate() {
                if one + other < -least {
                    let row = boundary * DIRECTIONS + direction;
                    each(row, row + HALF);
                }
            }
        }
    }

    /// Whether the program has any attitude row.
    pub(in crate::qp) fn has_attitude(&self) -> bool {
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
        let rows = self.0.iter_mut().skip(LAST_ROWS);
        for (row, side) in rows.zip(sides.iter().cycle()) {
            *row = *side;
        }
    }
}
