//! Excess of the outputs of a trajectory over the bounds of rows: the row to take up next, and the worst of each kind.

use super::rows::{ATTITUDE_ROWS, Bounds, OUTPUTS, POSITION_ROWS, ROWS, THRUST_OUTPUT, parts};
use crate::config::{DIRECTIONS, STAGES};
use crate::corridor::DIRECTION_VECTORS;

/// Number of rows on a short list. With 4 and 8 the ten longest hard solves take as long, and the soft ones up to a tenth longer.
pub(super) const LISTED: usize = 5;

/// The violated rows that count most, in falling order: at most one of a kind and stage. Each has what it counts.
#[derive(Clone, Debug)]
pub(super) struct Shortlist {
    rows: [(f64, usize); LISTED],
    len: usize,
}

impl Shortlist {
    pub(super) const fn new() -> Self {
        Self {
            rows: [(0.0, 0); LISTED],
            len: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Takes the row that counts most, and what it counts.
    pub(super) fn take_first(&mut self) -> Option<(f64, usize)> {
        self.len = self.len.checked_sub(1)?;
        let [first, second, third, fourth, fifth] = self.rows;
        self.rows = [second, third, fourth, fifth, first];
        Some(first)
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.rows.iter().take(self.len).map(|(_, row)| *row)
    }

    pub(super) fn keep(&mut self, mut keeps: impl FnMut(usize) -> bool) {
        let mut kept = Self::new();
        for entry in self.rows.iter().take(self.len) {
            if keeps(entry.1) {
                kept.push(*entry);
            }
        }
        *self = kept;
    }

    fn push(&mut self, entry: (f64, usize)) {
        if let Some(place) = self.rows.get_mut(self.len) {
            *place = entry;
            self.len += 1;
        }
    }

    /// Inserts a row before those that count less. The last one leaves a full list.
    #[inline(never)]
    fn insert(&mut self, mut entry: (f64, usize)) {
        let mut moves = false;
        for place in self.rows.iter_mut().take(self.len) {
            moves |= place.0 < entry.0;
            if moves {
                core::mem::swap(place, &mut entry);
            }
        }
        self.push(entry);
    }
}

/// What an excess counts: `s^2` times the row's price if `by_effort` is true, which is twice the cost of its
/// correction. Otherwise `s^4` times the price, which is between its size and its effort; this shortens the longest
/// solves of programs with soft rows.
pub(super) fn count(excess: f64, price: f64, by_effort: bool) -> f64 {
    let over = if excess > 0.0 { excess } else { 0.0 };
    let square = over * over;
    (if by_effort { square } else { square * square }) * price
}

/// Lists the violated rows that count most. The function leaves out the attitude rows unless `attitude_rows` is true.
pub(super) fn most_violated(
    outputs: &[f64; OUTPUTS],
    bounds: &Bounds,
    prices: &[f64; ROWS],
    by_effort: bool,
    attitude_rows: bool,
    list: &mut Shortlist,
) {
    list.clear();
    let (position_bounds, attitude_bounds, thrust_bounds) = parts(&bounds.0);
    let (position_prices, attitude_prices, thrust_prices) = parts(prices);
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

/// The largest value. Repeated halving needs few comparisons that depend on each other.
#[inline(always)]
fn largest<const N: usize>(values: &[f64; N]) -> f64 {
    let mut halves = *values;
    let mut len = N;
    while len > 1 {
        len /= 2;
        let (low, high) = halves.split_at_mut(len);
        for (low, high) in low.iter_mut().zip(high) {
            *low = if *high > *low { *high } else { *low };
        }
    }
    halves[0]
}

/// Lists the row of a kind and stage, from `first` on, that counts most.
#[inline(never)]
fn consider<const N: usize>(
    list: &mut Shortlist,
    excess: &[f64; N],
    prices: Option<&[f64; N]>,
    first: usize,
    by_effort: bool,
) {
    let mut most = (0.0, 0);
    for (offset, (excess, price)) in excess.iter().zip(prices.unwrap_or(&[0.0; N])).enumerate() {
        let value = count(*excess, *price, by_effort);
        if value > most.0 {
            most = (value, first + offset);
        }
    }
    if most.0 > 0.0 {
        list.insert(most);
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

#[cfg(test)]
mod tests {
    extern crate std;

    use super::{LISTED, Shortlist};
    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;
    use std::vec::Vec;

    #[test]
    fn a_short_list_holds_the_rows_that_count_most_in_order() {
        let mut random = Pcg64Mcg::seed_from_u64(7);
        for count in 0..40 {
            let mut list = Shortlist::new();
            let mut all: Vec<(f64, usize)> = (0..count)
                .map(|row| ((random.next_u64() % 1_000_000) as f64, row))
                .collect();
            for entry in &all {
                list.insert(*entry);
            }
            all.sort_by(|a, b| b.0.total_cmp(&a.0));
            all.truncate(LISTED);
            let rows: Vec<usize> = all.iter().map(|(_, row)| *row).collect();
            assert_eq!(list.rows().collect::<Vec<_>>(), rows);
            assert_eq!(list.take_first(), all.first().copied());
            list.keep(|row| row % 2 == 0);
            let even = rows.iter().skip(1).filter(|row| *row % 2 == 0);
            assert!(list.rows().eq(even.copied()));
        }
    }
}
