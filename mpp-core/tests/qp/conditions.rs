//! The conditions that a trusted answer of the solver must keep: those of Karush, Kuhn and Tucker
//! at an optimum, and a valid sum of rows at a contradiction. They use the dense program alone.

use super::dense::{CONTROLS, DenseProgram, flat, largest};
use mpp_core::qp::{Penalty, ROWS, Solution, Solver};

/// Largest entry of a gradient that should vanish, relative to the largest term of its sum.
const STATIONARY: f64 = 1e-7;
/// Violation of a row that callers accept [m, rad, N].
pub(crate) const ACCEPTED: f64 = 1e-6;
/// Size of controls, summed over the horizon, for which rounding in a proof may leave room: thirty
/// for each control, where flights take one.
const ABSURD_CONTROLS: f64 = 1e3;

/// Multipliers by row.
fn multipliers(solver: &Solver) -> [f64; ROWS] {
    let mut all = [0.0; ROWS];
    for (row, multiplier) in solver.multipliers() {
        all[row] += multiplier;
    }
    all
}

/// Checks that rows hold up to `tight`, that rows with a multiplier are tight or yield by their
/// price, and that slope and weighted rows balance.
pub(crate) fn assert_optimal(
    program: &DenseProgram,
    penalty: Option<Penalty>,
    solver: &Solver,
    solution: &Solution,
    tight: f64,
) {
    let controls = flat(&solution.controls);
    let multipliers = multipliers(solver);
    let mut sum = program.slope(&controls);
    let mut scale = largest(&sum).max(1.0);
    for row in &program.rows {
        let multiplier = multipliers[row.number];
        let excess = row.excess(&controls);
        let context = format!("row {}: {excess}, {multiplier}", row.number);
        assert!(multiplier >= 0.0, "{context}");
        match penalty {
            Some(_) if row.is_constant() && row.softens => {
                assert!(multiplier == 0.0, "{context}");
                continue;
            }
            Some(Penalty { linear, quadratic }) if row.softens => {
                let price = linear + quadratic * excess.max(0.0);
                assert!(
                    multiplier <= price + quadratic * tight + STATIONARY * price,
                    "{context}"
                );
                assert!(
                    excess <= tight || multiplier >= price * (1.0 - STATIONARY) - quadratic * tight,
                    "{context}"
                );
            }
            _ => assert!(excess <= tight, "{context}"),
        }
        assert!(multiplier == 0.0 || excess >= -tight, "{context}");
        scale = scale.max(multiplier * largest(&row.normal));
        for (sum, entry) in sum.iter_mut().zip(&row.normal) {
            *sum += multiplier * entry;
        }
    }
    assert!(
        largest(&sum) <= STATIONARY * scale,
        "{} is left of {scale}",
        largest(&sum)
    );
}

/// Checks that the weighted rows add up to `gradient . u <= negative`, and that the gradient
/// vanishes except for rounding. Only absurd controls could keep such a sum.
pub(crate) fn assert_contradiction(program: &DenseProgram, solver: &Solver) {
    let multipliers = multipliers(solver);
    let mut gradient = [0.0; CONTROLS];
    let mut right = 0.0;
    for row in &program.rows {
        let weight = multipliers[row.number];
        assert!(weight >= 0.0, "row {} has weight {weight}", row.number);
        right += weight * row.bound;
        for (sum, entry) in gradient.iter_mut().zip(&row.normal) {
            *sum += weight * entry;
        }
    }
    assert!(right < 0.0, "the sum of rows holds: 0 <= {right}");
    let escape = -right / largest(&gradient);
    assert!(
        escape > ABSURD_CONTROLS,
        "controls of size {escape} escape: {right}"
    );
}
