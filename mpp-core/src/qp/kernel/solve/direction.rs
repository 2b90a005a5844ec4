//! The direction of a step, and the relation of the entering row to the active rows.

/// Change of the violation with the multiplier of the entering row. The rates of the active rows are in the solver.
#[derive(Clone, Copy)]
pub(super) struct Direction {
    /// Squared norm of the entering row's response, `|Y' c_p|^2`.
    pub(super) norm: f64,
    /// Schur complement of the entering row against the active rows. It is 0 if the row depends on them.
    pub(super) complement: f64,
    /// Decrease of the violation with the multiplier: the complement as it is computed, without a floor.
    pub(super) slope: f64,
}

/// Relation of an entering row to active rows on which it depends.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Stand {
    /// The active rows leave at least a little room. The number is the length of the step that makes the
    /// entering row tight.
    Apart(f64),
    /// The entering row touches the active rows: its violation may be rounding.
    Touches,
    /// No solution with a sensible cost keeps all these rows.
    Contradicts,
}
