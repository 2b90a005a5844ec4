//! The lattice in space: dynamic programming over stations ahead, places across and slopes of the track.
//!
//! From the aircraft to the *via* station it runs forward, from the last station back to the via station it gives the
//! cost-to-go. A path goes through each local minimum of the sum at the via station, so paths differ by the side on which they
//! pass. Costs are whole numbers of 1/32.

use crate::map::VoxelField;
use crate::tuning::space_judgement::{AHEAD, UNKNOWN};
use crate::tuning::space_lattice::{BEND, CLIMB, HEIGHT, LACK, PULL, SIDE, SLOPE};
use crate::vehicle::{SpaceModel, between};

/// Stations, that of the aircraft included.
pub(super) const STATIONS: usize = 14;
/// The via station.
pub(super) const VIA: usize = 5;
/// Places across: to the sides and in height.
const ROWS: usize = 49;
const LAYERS: usize = 15;
/// Slopes to the sides, in places a station, and climbs.
const SLOPES: usize = 7;
const CLIMBS: usize = 3;
/// Distance of places across \[m\]: to the sides and in height.
const ACROSS: f64 = 0.5;
const UP: f64 = 1.0;
/// Least and greatest distance of stations \[m\]. Near stations need small steps, far ones time.
const LEAST_STEP: f64 = 2.8;
const MOST_STEP: f64 = 6.0;
/// How much more tightly paths bend than level turns: roll-outs follow them under all limits [-].
const TIGHTER: f64 = 1.15;
/// Whole numbers a unit of cost.
const UNIT: f64 = 32.0;
/// A place that no path reaches.
const NONE: u16 = u16::MAX;
/// Greatest cost-to-go that counts [-].
const MOST_TO_GO: f64 = 500.0;

/// Costs in height.
type Layers = [u16; LAYERS];
/// Costs of all states at a station.
type Station = [[[Layers; CLIMBS]; SLOPES]; ROWS];

/// A path through the lattice: a point at each station \[m\].
pub(super) type Path = [[f64; 3]; STATIONS];

/// What the cost of a place depends on beside the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rules {
    /// Clearance that a path keeps \[m\].
    pub(super) margin: f64,
    /// Wanted height \[m\].
    pub(super) altitude: f64,
    /// Least and greatest height \[m\].
    pub(super) heights: [f64; 2],
    /// Half the width of the band \[m\].
    pub(super) half_width: f64,
}

#[derive(Clone, Debug)]
pub(super) struct Lattice {
    forward: [Station; VIA + 1],
    backward: [Station; STATIONS - VIA],
    /// Costs of the places at the next station, by the station before it.
    nodes: [[Layers; ROWS]; STATIONS - 1],
    /// Costs halfway between two stations: by twice the mean row, then at and between layers.
    halfway: [[[Layers; 2]; 2 * ROWS - 1]; STATIONS - 1],
    origin: [f64; 3],
    step: f64,
}

impl Lattice {
    pub(super) const fn new() -> Self {
        Self {
            forward: [[[[[NONE; LAYERS]; CLIMBS]; SLOPES]; ROWS]; VIA + 1],
            backward: [[[[[NONE; LAYERS]; CLIMBS]; SLOPES]; ROWS]; STATIONS - VIA],
            nodes: [[[0; LAYERS]; ROWS]; STATIONS - 1],
            halfway: [[[[0; LAYERS]; 2]; 2 * ROWS - 1]; STATIONS - 1],
            origin: [0.0; 3],
            step: LEAST_STEP,
        }
    }

    /// Distance of stations \[m\] for an aircraft: a change of the slope by one place a station is its tightest turn.
    pub(super) fn set_up(&mut self, model: &SpaceModel) {
        let curvature = TIGHTER * model.curvature();
        let step = libm::sqrt(2.0 * ACROSS / curvature);
        self.step = between(step, [LEAST_STEP, MOST_STEP]);
    }

    /// Begins at a position with the velocity over ground.
    pub(super) fn begin(&mut self, position: &[f64; 3], velocity: &[f64; 3]) {
        self.origin = *position;
        let ahead = velocity[0].max(2.0);
        let slope = place(velocity[1] / ahead * self.step / ACROSS + 3.0, SLOPES);
        let climb = place(velocity[2] / ahead * self.step / UP + 1.0, CLIMBS);
        let [first, ..] = &mut self.forward;
        clear(first);
        let states = first.get_mut(ROWS / 2).and_then(|row| row.get_mut(slope));
        if let Some(start) = states.and_then(|row| row.get_mut(climb)) {
            start[LAYERS / 2] = 0;
        }
        let [.., last] = &mut self.backward;
        last.as_flattened_mut()
            .as_flattened_mut()
            .as_flattened_mut()
            .fill(0);
    }

    /// The x of the via station \[m\].
    pub(super) fn via(&self) -> f64 {
        self.origin[0] + VIA as f64 * self.step
    }

    /// Prices the places at the station after `station`, and those halfway to it.
    pub(super) fn price(&mut self, station: usize, field: &VoxelField, rules: &Rules) {
        let (origin, step) = (self.origin, self.step);
        let half = (station as f64 + 0.5) * step;
        let (Some(nodes), Some(halfway)) =
            (self.nodes.get_mut(station), self.halfway.get_mut(station))
        else {
            return;
        };
        let at = |ahead: f64, row: f64, layer: f64| {
            let y = origin[1] + (row - (ROWS / 2) as f64) * ACROSS;
            let z = origin[2] + (layer - (LAYERS / 2) as f64) * UP;
            ([origin[0] + ahead, y, z], ahead)
        };
        for (row, parts) in halfway.iter_mut().enumerate() {
            for (between, layers) in parts.iter_mut().enumerate() {
                for (layer, cost) in layers.iter_mut().enumerate() {
                    let (point, ahead) =
                        at(half, row as f64 / 2.0, layer as f64 + 0.5 * between as f64);
                    *cost = units(place_cost(field, rules, &point, ahead));
                }
            }
        }
        for (row, layers) in nodes.iter_mut().enumerate() {
            for (layer, cost) in layers.iter_mut().enumerate() {
                let (point, ahead) = at(half + 0.5 * step, row as f64, layer as f64);
                let (off, side) = (point[2] - rules.altitude, point[1]);
                let far = HEIGHT * off * off + SIDE * side * side;
                *cost = units(place_cost(field, rules, &point, ahead) + far);
            }
        }
    }

    /// Extends the paths from a station before the via station to the next one.
    pub(super) fn extend(&mut self, station: usize) {
        let Some([from, to, ..]) = self.forward.get_mut(station..) else {
            return;
        };
        let (Some(nodes), Some(halfway)) = (self.nodes.get(station), self.halfway.get(station))
        else {
            return;
        };
        clear(to);
        for (row, slopes) in from.iter().enumerate() {
            for (slope, from) in slopes.iter().enumerate() {
                if from.as_flattened().iter().all(|cost| *cost == NONE) {
                    continue;
                }
                for next in slope.saturating_sub(1)..(slope + 2).min(SLOPES) {
                    let Some(end) = (row + slope + next).checked_sub(6) else {
                        continue;
                    };
                    let to = to.get_mut(end).and_then(|row| row.get_mut(next));
                    if let (Some(to), Some(node), Some(half)) =
                        (to, nodes.get(end), halfway.get(row + end))
                    {
                        forward(from, to, node, half, across(slope, next));
                    }
                }
            }
        }
    }

    /// Computes the cost-to-go at a station from the via station on, from that of the next one.
    pub(super) fn retreat(&mut self, station: usize) {
        let Some([to, from, ..]) = station
            .checked_sub(VIA)
            .and_then(|index| self.backward.get_mut(index..))
        else {
            return;
        };
        let (Some(nodes), Some(halfway)) = (self.nodes.get(station), self.halfway.get(station))
        else {
            return;
        };
        clear(to);
        for (row, slopes) in to.iter_mut().enumerate() {
            for (slope, to) in slopes.iter_mut().enumerate() {
                for next in slope.saturating_sub(1)..(slope + 2).min(SLOPES) {
                    let Some(end) = (row + slope + next).checked_sub(6) else {
                        continue;
                    };
                    let from = from.get(end).and_then(|row| row.get(next));
                    if let (Some(from), Some(node), Some(half)) =
                        (from, nodes.get(end), halfway.get(row + end))
                    {
                        backward(from, to, node, half, across(slope, next));
                    }
                }
            }
        }
    }

    /// Paths through the local minima at the via station, at least `apart` places from each other, cheapest first.
    pub(super) fn paths<const N: usize>(&self, apart: usize, paths: &mut heapless::Vec<Path, N>) {
        paths.clear();
        let mut totals = [[(NONE, 0, 0); LAYERS]; ROWS];
        let (forward, backward) = (&self.forward[VIA], &self.backward[0]);
        for (row, (totals, (ahead, back))) in totals
            .iter_mut()
            .zip(forward.iter().zip(backward))
            .enumerate()
        {
            let _ = row;
            for (slope, (ahead, back)) in ahead.iter().zip(back).enumerate() {
                for (climb, (ahead, back)) in ahead.iter().zip(back).enumerate() {
                    for (total, (ahead, back)) in totals.iter_mut().zip(ahead.iter().zip(back)) {
                        let sum = ahead.saturating_add(*back);
                        if sum < total.0 {
                            *total = (sum, slope, climb);
                        }
                    }
                }
            }
        }
        let mut minima: heapless::Vec<(u16, State), N> = heapless::Vec::new();
        for (row, layers) in totals.iter().enumerate() {
            for (layer, (cost, slope, climb)) in layers.iter().enumerate() {
                if *cost < NONE && is_minimum(&totals, row, layer, apart) {
                    let state = State {
                        row,
                        slope: *slope,
                        climb: *climb,
                        layer,
                    };
                    insert(&mut minima, *cost, state);
                }
            }
        }
        for (_, state) in &minima {
            let _ = paths.push(self.trace(*state));
        }
    }

    fn point(&self, station: usize, state: &State) -> [f64; 3] {
        let [x, y, z] = self.origin;
        [
            x + station as f64 * self.step,
            y + (state.row as f64 - (ROWS / 2) as f64) * ACROSS,
            z + (state.layer as f64 - (LAYERS / 2) as f64) * UP,
        ]
    }

    /// The cheapest path through a state at the via station.
    fn trace(&self, via: State) -> Path {
        let mut path = [self.point(VIA, &via); STATIONS];
        let mut state = via;
        for station in (0..VIA).rev() {
            state = self.before(station, &state);
            if let Some(point) = path.get_mut(station) {
                *point = self.point(station, &state);
            }
        }
        state = via;
        for station in VIA..STATIONS - 1 {
            state = self.after(station, &state);
            if let Some(point) = path.get_mut(station + 1) {
                *point = self.point(station + 1, &state);
            }
        }
        path
    }

    /// The cheapest state at a station from which a path leads to a state at the next one.
    fn before(&self, station: usize, to: &State) -> State {
        let mut best = (u32::MAX, *to);
        for slope in to.slope.saturating_sub(1)..(to.slope + 2).min(SLOPES) {
            for climb in to.climb.saturating_sub(1)..(to.climb + 2).min(CLIMBS) {
                let row = (to.row + 6).checked_sub(slope + to.slope);
                let layer = (to.layer + 1).checked_sub(to.climb);
                let (Some(row), Some(layer)) = (row, layer) else {
                    continue;
                };
                let from = State {
                    row,
                    slope,
                    climb,
                    layer,
                };
                let cost =
                    cost_at(self.forward.get(station), &from) + self.edge(station, &from, to);
                if cost < best.0 {
                    best = (cost, from);
                }
            }
        }
        best.1
    }

    /// The cheapest state at the next station.
    fn after(&self, station: usize, from: &State) -> State {
        let mut best = (u32::MAX, *from);
        for slope in from.slope.saturating_sub(1)..(from.slope + 2).min(SLOPES) {
            for climb in from.climb.saturating_sub(1)..(from.climb + 2).min(CLIMBS) {
                let row = (from.row + from.slope + slope).checked_sub(6);
                let layer = (from.layer + climb).checked_sub(1);
                let (Some(row), Some(layer)) = (row, layer) else {
                    continue;
                };
                let to = State {
                    row,
                    slope,
                    climb,
                    layer,
                };
                let next = self.backward.get(station + 1 - VIA);
                let cost = cost_at(next, &to) + self.edge(station, from, &to);
                if cost < best.0 {
                    best = (cost, to);
                }
            }
        }
        best.1
    }

    /// Cost of an edge from a station to the next one.
    fn edge(&self, station: usize, from: &State, to: &State) -> u32 {
        let node = self.nodes.get(station).and_then(|rows| rows.get(to.row));
        let half = self
            .halfway
            .get(station)
            .and_then(|rows| rows.get(from.row + to.row));
        let layers = from.layer + to.layer;
        let node = node.and_then(|layers| layers.get(to.layer));
        let half = half.and_then(|parts| parts[layers % 2].get(layers / 2));
        match (node, half) {
            (Some(node), Some(half)) => {
                let own = across(from.slope, to.slope) + up(from.climb, to.climb);
                u32::from(*node) + u32::from(*half) + u32::from(own)
            }
            _ => u32::from(NONE),
        }
    }

    /// Cost-to-go of a point at the via station with a velocity over ground.
    pub(super) fn cost_to_go(&self, [_, y, z]: &[f64; 3], velocity: &[f64; 3]) -> f64 {
        let ahead = velocity[0].max(2.0);
        let split = |value: f64, count: usize| {
            let inside = value.max(0.0).min(count as f64 - 1.01);
            let low = libm::floor(inside);
            (low as usize, inside - low)
        };
        let (row, by_row) = split((y - self.origin[1]) / ACROSS + (ROWS / 2) as f64, ROWS);
        let (layer, by_layer) = split((z - self.origin[2]) / UP + (LAYERS / 2) as f64, LAYERS);
        let (slope, by_slope) = split(velocity[1] / ahead * self.step / ACROSS + 3.0, SLOPES);
        let climb = place(velocity[2] / ahead * self.step / UP + 1.0, CLIMBS);
        let mut sum = 0.0;
        for corner in 0..8 {
            let high = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight = |high: usize, share: f64| if high == 1 { share } else { 1.0 - share };
            let state = State {
                row: row + high[0],
                slope: slope + high[2],
                climb,
                layer: layer + high[1],
            };
            let cost = f64::from(cost_at(self.backward.first(), &state)) / UNIT;
            let share =
                weight(high[0], by_row) * weight(high[1], by_layer) * weight(high[2], by_slope);
            sum += share * cost.min(MOST_TO_GO);
        }
        sum
    }
}

/// A state at a station.
#[derive(Clone, Copy, Debug, PartialEq)]
struct State {
    row: usize,
    slope: usize,
    climb: usize,
    layer: usize,
}

fn clear(station: &mut Station) {
    (station.as_flattened_mut().as_flattened_mut())
        .as_flattened_mut()
        .fill(NONE);
}

fn cost_at(station: Option<&Station>, state: &State) -> u32 {
    let states = station.and_then(|rows| rows.get(state.row));
    let layers = states.and_then(|slopes| slopes.get(state.slope)?.get(state.climb));
    u32::from(
        layers
            .and_then(|layers| layers.get(state.layer))
            .copied()
            .unwrap_or(NONE),
    )
}

/// The nearest of `count` places.
fn place(value: f64, count: usize) -> usize {
    libm::round(value).max(0.0).min(count as f64 - 1.0) as usize
}

fn units(cost: f64) -> u16 {
    (cost * UNIT).min(f64::from(NONE - 1)) as u16
}

/// Cost of a step to the side and of the change of slope before it.
const fn across(slope: usize, next: usize) -> u16 {
    let places = next as f64 - 3.0;
    let bend = if slope == next { 0.0 } else { BEND };
    ((bend + SLOPE * places * places) * UNIT) as u16
}

/// Cost of a climb and of the change before it.
const fn up(climb: usize, next: usize) -> u16 {
    let steady = if next == 1 { 0.0 } else { CLIMB };
    let change = if climb == next { 0.0 } else { PULL };
    ((steady + change) * UNIT) as u16
}

fn least(costs: [u16; 2]) -> u16 {
    let [one, other] = costs;
    one.min(other)
}

/// Lowers the costs `to` by paths that come from the costs `from`.
fn forward(
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
fn backward(
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

/// Cost of a place [-], without that of its distance from the middle.
fn place_cost(field: &VoxelField, rules: &Rules, point: &[f64; 3], ahead: f64) -> f64 {
    let [low, high] = rules.heights;
    let beyond = (low - point[2]).max(point[2] - high).max(0.0);
    let outside = (libm::fabs(point[1]) - rules.half_width).max(0.0);
    let lack = (rules.margin - field.nearest(point)).max(0.0) + beyond + outside;
    let near = 1.0 - ahead / AHEAD;
    let unknown = if near > 0.0 && field.is_unknown(point) {
        UNKNOWN * near
    } else {
        0.0
    };
    LACK * lack * lack + unknown
}

type Totals = [[(u16, usize, usize); LAYERS]; ROWS];

/// Whether no place within `apart` rows and one layer is cheaper. Of equal ones the first counts.
fn is_minimum(totals: &Totals, row: usize, layer: usize, apart: usize) -> bool {
    let own = totals
        .get(row)
        .and_then(|layers| layers.get(layer))
        .map_or(NONE, |it| it.0);
    let rows = row.saturating_sub(apart)..(row + apart + 1).min(ROWS);
    rows.clone().all(|other_row| {
        let layers = layer.saturating_sub(1)..(layer + 2).min(LAYERS);
        layers.clone().all(|other_layer| {
            let other = totals
                .get(other_row)
                .and_then(|layers| layers.get(other_layer));
            let first = (other_row, other_layer) < (row, layer);
            other.is_none_or(|other| other.0 > own || (other.0 == own && !first))
        })
    })
}

/// Inserts a minimum before those that cost more. The dearest one leaves a full list.
fn insert<const N: usize>(minima: &mut heapless::Vec<(u16, State), N>, cost: u16, state: State) {
    let place = minima
        .iter()
        .position(|other| cost < other.0)
        .unwrap_or(minima.len());
    if minima.is_full() {
        if place == minima.len() {
            return;
        }
        minima.pop();
    }
    let _ = minima.insert(place, (cost, state));
}
