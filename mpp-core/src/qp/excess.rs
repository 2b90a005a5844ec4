//! Excess of the outputs of a trajectory over the bounds of rows: the row to take up next, and the worst of each kind.

use super::rows::{ATTITUDE_ROWS, Bounds, OUTPUTS, POSITION_ROWS, ROWS, THRUST_OUTPUT, parts};
use crate::config::{DIRECTIONS, STAGES};
use crate::corridor::DIRECTION_VECTORS;

/// The row whose excess counts most, if any row has an excess. An excess `s` counts as `s^2` times the row's
/// price if `by_effort` is true, which is twice the cost of its correction. Otherwise it counts as `s^4` times
/// the price, which is between its size and its effort; this shortens the longest solves of programs with soft
/// rows. The function leaves out the attitude rows unless `attitude_rows` is true.
pub(super) fn most_violated(
    outputs: &[f64; OUTPUTS],
    bounds: &Bounds,
    prices: &[f64; ROWS],
    by_effort: bool,
    attitude_rows: bool,
) -> Option<usize> {
    let count = |excess: &mut f64, price: &f64| {
        let over = excess.max(0.0);
        let square = over * over;
        let counted = if by_effort { square } else { square * square };
        *excess = counted * price;
    };
    let (position_bounds, attitude_bounds, thrust_bounds) = parts(&bounds.0);
    let (position_prices, attitude_prices, thrust_prices) = parts(prices);
    let (motion, thrust, attitude) = split(outputs);
    let mut worst = Worst {
        most: 0.0,
        row: None,
    };

    let prices = position_prices.iter();
    let stages = motion
        .iter()
        .zip(position_bounds.iter().zip(prices).skip(1));
    for (stage, (at, (bounds, prices))) in stages.enumerate() {
        let mut excess = position_excess(at, bounds);
        for (excess, price) in excess.iter_mut().zip(prices) {
            count(excess, price);
        }
        worst.consider(&excess, (stage + 1) * DIRECTIONS);
    }
    let stages = thrust.iter().zip(thrust_bounds.iter().zip(thrust_prices));
    for (stage, (thrust, (limits, prices))) in stages.enumerate() {
        let mut excess = thrust_excess(*thrust, limits);
        for (excess, price) in excess.iter_mut().zip(prices) {
            count(excess, price);
        }
        worst.consider(&excess, POSITION_ROWS + ATTITUDE_ROWS + 2 * stage);
    }
    if attitude_rows {
        let stages = attitude
            .iter()
            .zip(attitude_bounds.iter().zip(attitude_prices));
        for (stage, (at, (limits, prices))) in stages.enumerate() {
            let mut excess = attitude_excess(at, limits);
            for (excess, price) in excess.iter_mut().zip(prices) {
                count(excess, price);
            }
            worst.consider(&excess, POSITION_ROWS + 4 * stage);
        }
    }
    worst.row
}

/// The largest value so far and its row.
struct Worst {
    most: f64,
    row: Option<usize>,
}

impl Worst {
    /// Compares with the values of the rows from `first` on. Repeated halving finds the largest value with
    /// few comparisons that depend on each other.
    fn consider<const N: usize>(&mut self, values: &[f64; N], first: usize) {
        let mut halves = *values;
        let mut len = N;
        while len > 1 {
            len /= 2;
            let (low, high) = halves.split_at_mut(len);
            for (low, high) in low.iter_mut().zip(high) {
                if *high > *low {
                    *low = *high;
                }
            }
        }
        if halves.first().is_some_and(|largest| *largest > self.most) {
            for (offset, value) in values.iter().enumerate() {
                if *value > self.most {
                    self.most = *value;
                    self.row = Some(first + offset);
                }
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

/// Worst excess of each kind of row, at least 0 [m, rad or N].
#[derive(Default)]
pub(super) struct WorstExcess {
    pub(super) position: f64,
    /// By the second number of [`super::RowKind::Attitude`].
    pub(super) attitude: [f64; 4],
    pub(super) thrust: f64,
}

/// Worst excesses of the outputs over the bounds of rows that controls can change.
pub(super) fn worst_excess(
    outputs: &[f64; OUTPUTS],
    bounds: &Bounds,
    prices: &[f64; ROWS],
) -> WorstExcess {
    let (position_bounds, attitude_bounds, thrust_bounds) = parts(&bounds.0);
    let (position_prices, attitude_prices, thrust_prices) = parts(prices);
    let (motion, thrust, attitude) = split(outputs);
    let mut all = WorstExcess::default();
    let larger = |worst: &mut f64, (excess, price): (&f64, &f64)| {
        if *price > 0.0 && *excess > *worst {
            *worst = *excess;
        }
    };
    let rows = position_bounds.iter().zip(position_prices).skip(1);
    for (at, (bounds, prices)) in motion.iter().zip(rows) {
        for row in position_excess(at, bounds).iter().zip(prices) {
            larger(&mut all.position, row);
        }
    }
    let rows = attitude_bounds.iter().zip(attitude_prices);
    for (at, (bounds, prices)) in attitude.iter().zip(rows) {
        let excess = attitude_excess(at, bounds);
        for (worst, row) in all.attitude.iter_mut().zip(excess.iter().zip(prices)) {
            larger(worst, row);
        }
    }
    let rows = thrust_bounds.iter().zip(thrust_prices);
    for (thrust, (bounds, prices)) in thrust.iter().zip(rows) {
        for row in thrust_excess(*thrust, bounds).iter().zip(prices) {
            larger(&mut all.thrust, row);
        }
    }
    all
}
