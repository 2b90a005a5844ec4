//! The rows of the program: the outputs in each row, and the right-hand sides.

use super::kernel::RowPattern;
use super::layout::{
    ATTITUDE_OUTPUT, ATTITUDES, FACE_ROWS, FACES, INPUT_OUTPUT, INPUTS, LAST_ROWS, POSITION, ROWS,
    RowKind, StageState,
};
use crate::config::STAGES;

/// Unit normals of the faces at boundaries 1 to N. They point towards the obstacle.
pub(in crate::qp) type Normals = [[[f64; POSITION]; FACES]; STAGES];
pub(in crate::qp) const NO_NORMALS: Normals = [[[0.0; POSITION]; FACES]; STAGES];

/// Sign of the row in a pair, of which the first is the upper limit.
fn side(which: usize) -> f64 {
    if which.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// The pattern of a row.
pub(in crate::qp) fn pattern(row: usize, normals: &Normals) -> Option<RowPattern> {
    Some(match RowKind::of(row) {
        RowKind::Face(boundary, face) => {
            let stage = boundary.checked_sub(1)?;
            let [x, y, z] = normals.get(stage)?.get(face)?;
            let first = POSITION * stage;
            RowPattern([(first, *x), (first + 1, *y), (first + 2, *z)])
        }
        RowKind::Attitude(boundary, which) => {
            let output = ATTITUDE_OUTPUT + ATTITUDES * boundary.checked_sub(1)? + which / 2;
            RowPattern::single(output, side(which))
        }
        RowKind::Input(stage, which) => {
            RowPattern::single(INPUT_OUTPUT + INPUTS * stage + which / 2, side(which))
        }
    })
}

/// Every row of a program in space has a pattern.
pub(in crate::qp) fn value_at_start(_: usize, _: &StageState) -> Option<f64> {
    None
}

/// Right-hand sides of the rows; infinite for a row that the program does not have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds(pub [f64; ROWS]);

/// Values by kind: those of faces and attitudes by boundary, and of inputs by stage.
type Parts<'a> = (
    &'a [[f64; FACES]],
    &'a [[f64; 2 * ATTITUDES]],
    &'a [[f64; 2 * INPUTS]],
);

/// Splits values of rows by kind.
pub(in crate::qp) fn parts(values: &[f64; ROWS]) -> Parts<'_> {
    let (faces, rest) = values.split_at(FACE_ROWS);
    let (attitudes, inputs) = rest.split_at(LAST_ROWS - FACE_ROWS);
    (
        faces.as_chunks().0,
        attitudes.as_chunks().0,
        inputs.as_chunks().0,
    )
}

impl Bounds {
    /// Bounds without any row.
    #[must_use]
    pub const fn none() -> Self {
        Self([f64::INFINITY; ROWS])
    }

    /// Sets the limits of the attitudes `(alpha, bank, path, course)` at every boundary: greatest and least deviation.
    pub fn set_attitudes(&mut self, upper: [f64; ATTITUDES], lower: [f64; ATTITUDES]) {
        self.fill(FACE_ROWS, LAST_ROWS, &upper, &lower);
    }

    /// Sets the limits of the inputs in every stage: greatest and least deviation.
    pub fn set_inputs(&mut self, upper: StageLimits, lower: StageLimits) {
        self.fill(LAST_ROWS, ROWS, &upper, &lower);
    }

    fn fill(&mut self, from: usize, to: usize, upper: &[f64], lower: &[f64]) {
        let sides = upper.iter().zip(lower).flat_map(|(up, low)| [*up, -low]);
        let rows = self.0.iter_mut().take(to).skip(from);
        for (row, side) in rows.zip(sides.cycle()) {
            *row = side;
        }
    }

    /// Free normals have no opposites that cross exactly.
    pub(in crate::qp) fn crossing_faces(&self, _: f64, _: impl FnMut(usize, usize)) {}

    /// The solver follows the trajectory, because programs in space always bound attitudes.
    pub(in crate::qp) fn has_attitude(&self) -> bool {
        true
    }
}

/// A limit for each input.
type StageLimits = [f64; INPUTS];
