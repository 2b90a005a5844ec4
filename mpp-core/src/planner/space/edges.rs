//! Costs of edges of the lattice, in whole numbers, and how they move costs from station to station.

use crate::tuning::space_lattice::{BEND, CLIMB, PULL, SLOPE};

/// Places across: to the sides and in height.
pub(super) const ROWS: usize = 49;
pub(super) const LAYERS: usize = 15;
/// Slopes to the sides, in places a station, and climbs.
pub(super) const SLOPES: usize = 7;
pub(super) const CLIMBS: usize = 3;
/// Whole numbers a unit of cost.
pub(super) const UNIT: f64 = 32.0;
/// A place that no path reaches.
pub(super) const NONE: u16 = u16::MAX;
/// Costs in height.
pub(super) type Layers = [u16; LAYERS];
pub(super) fn units(cost: f64) -> u16 {
    (cost * UNIT).min(f64::from(NONE - 1)) as u16
}

/// Cost of a step to the side and of the change of slope before it.
pub(super) const fn across(slope: usize, next: usize) -> u16 {
    let places = next as f64 - 3.0;
    let bend = if slope == next { 0.0 } else { BEND };
    ((bend + SLOPE * places * places) * UNIT) as u16
}

/// Cost of a climb and of the change before it.
pub(super) const fn up(climb: usize, next: usize) -> u16 {
    let steady = if next == 1 { 0.0 } else { CLIMB };
    let change = if climb == next { 0.0 } else { PULL };
    ((steady + change) * UNIT) as u16
}

/// Costs of the states of a row and slope while edges compete: sixteen times the cost, and the number of the edge. Of equal
/// costs the edge with the least number wins.
pub(super) type Contest = [[u32; LAYERS]; CLIMBS];
/// The edge that won, for each state of a row and slope: four bits each.
pub(super) type Choices = [[u8; LAYERS.div_ceil(2)]; CLIMBS];
/// No edge has come. Costs may be added.
const NO_EDGE: u32 = 1 << 30;
pub(super) const OPEN: Contest = [[NO_EDGE; LAYERS]; CLIMBS];

/// What an edge adds: a cost, and a part of its number.
const fn adds(cost: u16, number: u32) -> u32 {
    (cost as u32) << 4 | number
}

fn shifted(cost: u16) -> u32 {
    u32::from(cost) << 4
}

/// Number of an edge by the slope at its other end, and by the climb there: the change of each, and one.
pub(super) fn number(slope: usize, other: usize) -> u32 {
    3 * (other + 1).saturating_sub(slope) as u32
}

/// Lets edges to the states `to` compete that come from states with the costs `from`. `own` has their cost and number by slopes.
pub(super) fn forward(
    from: &[Layers; CLIMBS],
    to: &mut Contest,
    node: &Layers,
    half: &[Layers; 2],
    (cost, number): (u16, u32),
) {
    let ([low, level, high], [at, between]) = (from, half);
    let [down, straight, rise] = to;
    let own = adds(cost, number);
    let (from_low, from_high) = const { (adds(up(0, 1), 0), adds(up(2, 1), 2)) };
    for i in 0..LAYERS {
        let ends = (shifted(low[i]) + from_low).min(shifted(high[i]) + from_high);
        let best = ends.min(shifted(level[i]) + 1);
        let edge = shifted(at[i]) + shifted(node[i]) + own;
        straight[i] = straight[i].min(best + edge);
    }
    let (go_down, turn_down) = const { (adds(up(0, 0), 1), adds(up(1, 0), 2)) };
    let (turn_up, go_up) = const { (adds(up(1, 2), 0), adds(up(2, 2), 1)) };
    for i in 1..LAYERS {
        let edge = shifted(between[i - 1]) + own;
        let best = (shifted(low[i]) + go_down).min(shifted(level[i]) + turn_down);
        down[i - 1] = down[i - 1].min(best + edge + shifted(node[i - 1]));
        let best = (shifted(high[i - 1]) + go_up).min(shifted(level[i - 1]) + turn_up);
        rise[i] = rise[i].min(best + edge + shifted(node[i]));
    }
}

/// Costs of edges halfway and at their end, by the climb there and the layer at their beginning; [`NONE`] without an edge.
pub(super) fn sum(sums: &mut [Layers; CLIMBS], node: &Layers, [at, between]: &[Layers; 2]) {
    let [below, ahead, above] = sums;
    (below[0], above[LAYERS - 1]) = (NONE, NONE);
    for i in 0..LAYERS {
        ahead[i] = at[i].saturating_add(node[i]);
    }
    for i in 1..LAYERS {
        below[i] = between[i - 1].saturating_add(node[i - 1]);
        above[i - 1] = between[i - 1].saturating_add(node[i]);
    }
}

/// Chooses the edges of a row and slope that lead to states with the costs-to-go `from`, a slope less, as many and one more.
// Not inlined, so that the numbers of its loop stay in registers.
#[inline(never)]
pub(super) fn backward(
    from: [&[Layers; CLIMBS]; 3],
    sums: &[[Layers; CLIMBS]; 3],
    slope: usize,
    costs: &mut [Layers; CLIMBS],
    choices: &mut Choices,
) {
    let (go_down, leave_down) = const { (adds(up(0, 0), 1), adds(up(0, 1), 2)) };
    let (leave_up, go_up) = const { (adds(up(2, 1), 0), adds(up(2, 2), 1)) };
    let (turn_down, turn_up) = const { (adds(up(1, 0), 0), adds(up(1, 2), 2)) };
    let own: [u32; 3] = core::array::from_fn(|other| {
        let next = (slope + other).saturating_sub(1);
        adds(across(slope, next), number(slope, next))
    });
    let words = |i: usize| {
        let least = |climb: usize, to: usize| {
            let cost = |k: usize| {
                let sum = u32::from(from[k][climb][to]) + u32::from(sums[k][climb][i]);
                (sum << 4) + own[k]
            };
            cost(0).min(cost(1)).min(cost(2))
        };
        let ahead = least(1, i);
        let below = if i > 0 { least(0, i - 1) } else { NO_EDGE };
        let above = if i + 1 < LAYERS {
            least(2, i + 1)
        } else {
            NO_EDGE
        };
        let low = (below + go_down).min(ahead + leave_down);
        let level = (below + turn_down).min(above + turn_up).min(ahead + 1);
        let high = (above + go_up).min(ahead + leave_up);
        [low, level, high]
    };
    settle(words, costs, choices);
}

/// Ends the contest of a row and slope, by layers.
pub(super) fn settle(
    words: impl Fn(usize) -> [u32; CLIMBS],
    costs: &mut [Layers; CLIMBS],
    choices: &mut Choices,
) {
    for pair in 0..LAYERS.div_ceil(2) {
        let mut numbers = [0; CLIMBS];
        for (layer, shift) in [(2 * pair, 0), (2 * pair + 1, 4)] {
            if layer == LAYERS {
                break;
            }
            for (climb, word) in words(layer).into_iter().enumerate() {
                // Signed numbers take a flight computer fewer instructions.
                costs[climb][layer] = (word as i32 >> 4).max(0).min(i32::from(NONE)) as u16;
                numbers[climb] |= (word & 15) << shift;
            }
        }
        for (choices, number) in choices.iter_mut().zip(numbers) {
            choices[pair] = number as u8;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Each state has the cheapest of its edges, one by one: of equal ones that with the least number.
    #[test]
    fn of_the_edges_back_the_cheapest_one_is_chosen() {
        let mut random = Pcg64Mcg::seed_from_u64(3);
        let mut cost = || match random.next_u32() {
            few if few % 8 == 0 => NONE,
            many => (many % 90) as u16,
        };
        for case in 0..200 {
            let slope = case % SLOPES;
            let mut draw =
                || [0; 3].map(|_: u8| [0; CLIMBS].map(|_: u8| [0; LAYERS].map(|_: u8| cost())));
            let (from, mut sums) = (draw(), draw());
            let nowhere = |k: usize| slope + k == 0 || slope + k > SLOPES;
            for k in (0..3).filter(|k| nowhere(*k)) {
                sums[k] = [[NONE; LAYERS]; CLIMBS];
            }
            let mut costs = [[0; LAYERS]; CLIMBS];
            let mut choices = [[0; LAYERS.div_ceil(2)]; CLIMBS];
            let [a, b, c] = &from;
            backward([a, b, c], &sums, slope, &mut costs, &mut choices);
            for (climb, layer) in (0..CLIMBS).flat_map(|it| (0..LAYERS).map(move |at| (it, at))) {
                let edges = (0..3).filter(|k| !nowhere(*k)).flat_map(|k| {
                    let ends = climb.saturating_sub(1)..(climb + 2).min(CLIMBS);
                    ends.filter_map(move |end| {
                        let own = across(slope, slope + k - 1) + up(climb, end);
                        let to = (layer + end).checked_sub(1)?;
                        let there = u32::from(*from[k][end].get(to)?);
                        let sum = there + u32::from(sums[k][end][layer]) + u32::from(own);
                        Some((sum, 3 * k + end + 1 - climb))
                    })
                });
                let (least, number) = edges.min().unwrap();
                let found = costs[climb][layer];
                assert_eq!(u32::from(found), least.min(NONE.into()));
                if found < NONE {
                    let chosen = choices[climb][layer / 2] >> (layer % 2 * 4) & 15;
                    assert_eq!(usize::from(chosen), number);
                }
            }
        }
    }
}
