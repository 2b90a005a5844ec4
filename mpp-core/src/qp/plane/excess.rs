//! Excess of the outputs of a trajectory over the bounds of rows: the row to take up next, and the worst of each kind.

use super::kernel::Condensed;
use super::kernel::shortlist::{Shortlist, consider, largest};
use super::layout::{ATTITUDE_ROWS, OUTPUTS, POSITION_ROWS, RowKind, THRUST_OUTPUT};
use super::rows::{Bounds, parts};
use crate::config::{DIRECTIONS, STAGES};
use crate::corridor::DIRECTION_VECTORS;

/// Lists the violated rows that count most. The function leaves out the attitude rows unless `attitude_rows` is true.
pub(in crate::qp) fn most_violated(
    shared: &Condensed,
    outputs: &[f64; OUTPUTS],
    bounds: &Bounds,
    by_effort: bool,
    attitude_rows: bool,
    list: &mut Shortlist,
) {
    list.clear();
    let (position_bounds, attitude_bounds, thrust_bounds) = parts(&bounds.0);
    let (position_prices, attitude_prices, thrust_prices) = parts(&shared.prices);
    let (motion, thrust, attitude) = split(outputs);
    for (stage, (at, bounds)) in motion
        .iter()
        .zip(position_bounds.iter().skip(1))
        .enumerate()
    {
        let excess = position_excess(at, bounds);
        if largest(&excess) > 0.0 {
            consider(
                list,
                &excess,
                position_prices.get(stage + 1),
                (stage + 1) * DIRECTIONS,
                by_effort,
            );
        }
    }
    for (stage, (thrust, limits)) in thrust.iter().zip(thrust_bounds).enumerate() {
        let excess = thrust_excess(*thrust, limits);
        if largest(&excess) > 0.0 {
            consider(
                list,
                &excess,
                thrust_prices.get(stage),
                POSITION_ROWS + ATTITUDE_ROWS + 2 * stage,
                by_effort,
            );
        }
    }
    if attitude_rows {
        for (stage, (at, limits)) in attitude.iter().zip(attitude_bounds).enumerate() {
            let excess = attitude_excess(at, limits);
            if largest(&excess) > 0.0 {
                consider(
                    list,
                    &excess,
                    attitude_prices.get(stage),
                    POSITION_ROWS + 4 * stage,
                    by_effort,
                );
            }
        }
    }
}

type OutputParts<'a> = (&'a [[f64; 2]], &'a [f64], &'a [[f64; 2]]);

/// Splits the outputs into positions, thrusts and attitudes.
fn split(outputs: &[f64; OUTPUTS]) -> OutputParts<'_> {
    let (motion, rest) = outputs.split_at(THRUST_OUTPUT);
    let (thrust, attitude) = rest.split_at(STAGES);
    (motion.as_chunks().0, thrust, attitude.as_chunks().0)
}

fn position_excess([x, z]: &[f64; 2], bounds: &[f64; DIRECTIONS]) -> [f64; DIRECTIONS] {
    let mut excess = [0.0; DIRECTIONS];
    for ((excess, bound), [up, forward]) in excess.iter_mut().zip(bounds).zip(&DIRECTION_VECTORS) {
        *excess = forward * x + up * z - bound;
    }
    excess
}

fn attitude_excess([pitch, flight_path]: &[f64; 2], limits: &[f64; 4]) -> [f64; 4] {
    let attack = pitch - flight_path;
    let [a, b, c, d] = limits;
    [attack - a, flight_path - b, -attack - c, -flight_path - d]
}

fn thrust_excess(thrust: f64, [rise, reserve]: &[f64; 2]) -> [f64; 2] {
    [thrust - rise, -thrust - reserve]
}

/// Worst excess \[m, rad or N\], at least 0, of each kind of row that controls can change. The kinds are those of
/// [`super::Problem::softens`].
pub(in crate::qp) fn worst_excess(
    shared: &Condensed,
    outputs: &[f64; OUTPUTS],
    bounds: &Bounds,
) -> [(RowKind, f64); 6] {
    let (position_bounds, attitude_bounds, thrust_bounds) = parts(&bounds.0);
    let (position_prices, attitude_prices, thrust_prices) = parts(&shared.prices);
    let (motion, thrust, attitude) = split(outputs);
    let (mut position, mut attitudes, mut thrusts) = (0.0, [0.0; 4], 0.0);
    let larger = |worst: &mut f64, (excess, price): (&f64, &f64)| {
        if *price > 0.0 && *excess > *worst {
            *worst = *excess;
        }
    };
    let rows = position_bounds.iter().zip(position_prices).skip(1);
    for (at, (bounds, prices)) in motion.iter().zip(rows) {
        for row in position_excess(at, bounds).iter().zip(prices) {
            larger(&mut position, row);
        }
    }
    let rows = attitude_bounds.iter().zip(attitude_prices);
    for (at, (bounds, prices)) in attitude.iter().zip(rows) {
        let excess = attitude_excess(at, bounds);
        for (worst, row) in attitudes.iter_mut().zip(excess.iter().zip(prices)) {
            larger(worst, row);
        }
    }
    let rows = thrust_bounds.iter().zip(thrust_prices);
    for (thrust, (bounds, prices)) in thrust.iter().zip(rows) {
        for row in thrust_excess(*thrust, bounds).iter().zip(prices) {
            larger(&mut thrusts, row);
        }
    }
    let [up, climb, down, dive] = attitudes;
    [
        (RowKind::Position(0, 0), position),
        (RowKind::Attitude(0, 0), up),
        (RowKind::Attitude(0, 1), climb),
        (RowKind::Attitude(0, 2), down),
        (RowKind::Attitude(0, 3), dive),
        (RowKind::Thrust(0, 0), thrusts),
    ]
}
