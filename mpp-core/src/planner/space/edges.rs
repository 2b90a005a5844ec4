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

pub(super) fn least(costs: [u16; 2]) -> u16 {
    let [one, other] = costs;
    one.min(other)
}

/// Lowers the costs `to` by paths that come from the costs `from`.
pub(super) fn forward(
    from: &[Layers; CLIMBS],
    to: &mut [Layers; CLIMBS],
    node: &Layers,
    half: &[Layers; 2],
    own: u16,
) {
    let ([low, level, high], [at, between]) = (from, half);
    let [down, straight, rise] = to;
    let turn = const { up(0, 1) };
    for i in 0..LAYERS {
        let best = least([low[i], high[i]]).saturating_add(turn).min(level[i]);
        let cost = best
            .saturating_add(at[i])
            .saturating_add(node[i])
            .saturating_add(own);
        straight[i] = straight[i].min(cost);
    }
    let (steady, change) = const { (up(0, 0), up(1, 0)) };
    for i in 1..LAYERS {
        let best = low[i]
            .saturating_add(steady)
            .min(level[i].saturating_add(change));
        let cost = best
            .saturating_add(between[i - 1])
            .saturating_add(node[i - 1])
            .saturating_add(own);
        down[i - 1] = down[i - 1].min(cost);
        let best = high[i - 1]
            .saturating_add(steady)
            .min(level[i - 1].saturating_add(change));
        let cost = best
            .saturating_add(between[i - 1])
            .saturating_add(node[i])
            .saturating_add(own);
        rise[i] = rise[i].min(cost);
    }
}

/// Lowers the costs-to-go `to` by edges to states with the costs-to-go `from`.
pub(super) fn backward(
    from: &[Layers; CLIMBS],
    to: &mut [Layers; CLIMBS],
    node: &Layers,
    half: &[Layers; 2],
    own: u16,
) {
    let ([down, straight, rise], [at, between]) = (from, half);
    let (turn, steady, change) = const { (up(0, 1), up(0, 0), up(1, 0)) };
    let (mut ahead, mut below, mut above) = ([NONE; LAYERS], [NONE; LAYERS], [NONE; LAYERS]);
    for i in 0..LAYERS {
        ahead[i] = straight[i]
            .saturating_add(at[i])
            .saturating_add(node[i])
            .saturating_add(own);
    }
    for i in 1..LAYERS {
        below[i] = down[i - 1]
            .saturating_add(between[i - 1])
            .saturating_add(node[i - 1])
            .saturating_add(own);
        above[i - 1] = rise[i]
            .saturating_add(between[i - 1])
            .saturating_add(node[i])
            .saturating_add(own);
    }
    let [low, level, high] = to;
    for i in 0..LAYERS {
        let turned = ahead[i].saturating_add(turn);
        low[i] = low[i].min(below[i].saturating_add(steady)).min(turned);
        high[i] = high[i].min(above[i].saturating_add(steady)).min(turned);
        let away = least([below[i], above[i]]).saturating_add(change);
        level[i] = level[i].min(ahead[i]).min(away);
    }
}
