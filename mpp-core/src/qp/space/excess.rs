//! Excess of the outputs of a trajectory over the bounds of rows: the row to take up next, and the worst of each kind.

use super::kernel::Condensed;
use super::kernel::shortlist::{Shortlist, consider, largest};
use super::layout::{
    ATTITUDE_OUTPUT, ATTITUDES, FACE_ROWS, FACES, INPUT_OUTPUT, INPUTS, LAST_ROWS, OUTPUTS,
    POSITION, RowKind,
};
use super::rows::{Bounds, parts};

/// Lists the violated rows that count most.
pub(in crate::qp) fn most_violated(
    shared: &Condensed,
    outputs: &[f64; OUTPUTS],
    bounds: &Bounds,
    by_effort: bool,
    _: bool,
    list: &mut Shortlist,
) {
    list.clear();
    let (face_bounds, attitude_bounds, input_bounds) = parts(&bounds.0);
    let (face_prices, attitude_prices, input_prices) = parts(&shared.prices);
    let (positions, inputs, attitudes) = split(outputs);
    let boundaries = positions.iter().zip(&shared.normals).zip(face_bounds);
    for (stage, ((at, normals), bounds)) in boundaries.enumerate() {
        let excess = face_excess(at, normals, bounds);
        if excess.iter().any(|excess| *excess > 0.0) {
            consider(
                list,
                &excess,
                face_prices.get(stage),
                FACES * stage,
                by_effort,
            );
        }
    }
    for (stage, (at, limits)) in inputs.iter().zip(input_bounds).enumerate() {
        let excess = paired::<INPUTS, { 2 * INPUTS }>(at, limits);
        if excess.iter().any(|excess| *excess > 0.0) {
            let first = LAST_ROWS + 2 * INPUTS * stage;
            consider(list, &excess, input_prices.get(stage), first, by_effort);
        }
    }
    for (stage, (at, limits)) in attitudes.iter().zip(attitude_bounds).enumerate() {
        let excess = paired::<ATTITUDES, { 2 * ATTITUDES }>(at, limits);
        if largest(&excess) > 0.0 {
            let first = FACE_ROWS + 2 * ATTITUDES * stage;
            consider(list, &excess, attitude_prices.get(stage), first, by_effort);
        }
    }
}

type OutputParts<'a> = (
    &'a [[f64; POSITION]],
    &'a [[f64; INPUTS]],
    &'a [[f64; ATTITUDES]],
);

/// Splits the outputs into positions, inputs and attitudes.
fn split(outputs: &[f64; OUTPUTS]) -> OutputParts<'_> {
    let (positions, rest) = outputs.split_at(INPUT_OUTPUT);
    let (inputs, attitudes) = rest.split_at(ATTITUDE_OUTPUT - INPUT_OUTPUT);
    (
        positions.as_chunks().0,
        inputs.as_chunks().0,
        attitudes.as_chunks().0,
    )
}

fn face_excess(
    [x, y, z]: &[f64; POSITION],
    normals: &[[f64; POSITION]; FACES],
    bounds: &[f64; FACES],
) -> [f64; FACES] {
    let mut excess = [0.0; FACES];
    for ((excess, bound), [a, b, c]) in excess.iter_mut().zip(bounds).zip(normals) {
        *excess = a * x + b * y + c * z - bound;
    }
    excess
}

/// Excess over the upper and the lower limit of each value.
fn paired<const N: usize, const TWICE: usize>(
    values: &[f64; N],
    limits: &[f64; TWICE],
) -> [f64; TWICE] {
    let mut excess = [0.0; TWICE];
    let pairs = excess.as_chunks_mut::<2>().0.iter_mut();
    for ((excess, value), limits) in pairs.zip(values).zip(limits.as_chunks::<2>().0) {
        *excess = [value - limits[0], -value - limits[1]];
    }
    excess
}

/// Worst excess \[m, rad or unit of the input\], at least 0, of each kind of row that controls can change.
pub(in crate::qp) fn worst_excess(
    shared: &Condensed,
    outputs: &[f64; OUTPUTS],
    bounds: &Bounds,
) -> [(RowKind, f64); 3] {
    let (face_bounds, attitude_bounds, input_bounds) = parts(&bounds.0);
    let (face_prices, attitude_prices, input_prices) = parts(&shared.prices);
    let (positions, inputs, attitudes) = split(outputs);
    let worst = |excess: &[f64], prices: &[f64]| {
        let rows = excess.iter().zip(prices).filter(|(_, price)| **price > 0.0);
        rows.fold(0.0_f64, |worst, (excess, _)| worst.max(*excess))
    };
    let mut all = [0.0_f64; 3];
    let boundaries = positions.iter().zip(&shared.normals);
    for ((at, normals), (bounds, prices)) in boundaries.zip(face_bounds.iter().zip(face_prices)) {
        all[0] = all[0].max(worst(&face_excess(at, normals, bounds), prices));
    }
    for (at, (limits, prices)) in attitudes
        .iter()
        .zip(attitude_bounds.iter().zip(attitude_prices))
    {
        let excess = paired::<ATTITUDES, { 2 * ATTITUDES }>(at, limits);
        all[1] = all[1].max(worst(&excess, prices));
    }
    for (at, (limits, prices)) in inputs.iter().zip(input_bounds.iter().zip(input_prices)) {
        let excess = paired::<INPUTS, { 2 * INPUTS }>(at, limits);
        all[2] = all[2].max(worst(&excess, prices));
    }
    [
        (RowKind::Face(1, 0), all[0]),
        (RowKind::Attitude(1, 0), all[1]),
        (RowKind::Input(0, 0), all[2]),
    ]
}
