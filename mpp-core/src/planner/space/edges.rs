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
/// No edge has come.
pub(super) const OPEN: Contest = [[u32::MAX; LAYERS]; CLIMBS];
const NO_EDGE: u32 = u32::MAX / 2;

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

/// Lets edges from the states `to` compete that lead to states with the costs-to-go `from`.
pub(super) fn backward(
    from: &[Layers; CLIMBS],
    to: &mut Contest,
    node: &Layers,
    half: &[Layers; 2],
    (cost, number): (u16, u32),
) {
    let ([down, straight, rise], [at, between]) = (from, half);
    let own = adds(cost, number);
    let (mut ahead, mut below, mut above) = ([0; LAYERS], [NO_EDGE; LAYERS], [NO_EDGE; LAYERS]);
    for i in 0..LAYERS {
        ahead[i] = shifted(straight[i]) + shifted(at[i]) + shifted(node[i]) + own;
    }
    for i in 1..LAYERS {
        let edge = shifted(between[i - 1]) + own;
        below[i] = shifted(down[i - 1]) + shifted(node[i - 1]) + edge;
        above[i - 1] = shifted(rise[i]) + shifted(node[i]) + edge;
    }
    let [low, level, high] = to;
    let (go_down, leave_down) = const { (adds(up(0, 0), 1), adds(up(0, 1), 2)) };
    let (leave_up, go_up) = const { (adds(up(2, 1), 0), adds(up(2, 2), 1)) };
    let (turn_down, turn_up) = const { (adds(up(1, 0), 0), adds(up(1, 2), 2)) };
    for i in 0..LAYERS {
        low[i] = low[i].min((below[i] + go_down).min(ahead[i] + leave_down));
        high[i] = high[i].min((above[i] + go_up).min(ahead[i] + leave_up));
        let away = (below[i] + turn_down).min(above[i] + turn_up);
        level[i] = level[i].min(away.min(ahead[i] + 1));
    }
}

/// Ends the contest of a row and slope.
pub(super) fn settle(contest: &Contest, costs: &mut [Layers; CLIMBS], choices: &mut Choices) {
    for (contest, (costs, choices)) in contest.iter().zip(costs.iter_mut().zip(choices)) {
        for (cost, word) in costs.iter_mut().zip(contest) {
            *cost = (word >> 4).min(u32::from(NONE)) as u16;
        }
        for (pair, words) in choices.iter_mut().zip(contest.chunks(2)) {
            let number = |index: usize| words.get(index).map_or(0, |word| (word & 15) as u8);
            *pair = number(0) | number(1) << 4;
        }
    }
}
