//! The lattice in space: dynamic programming over stations ahead, places across and slopes of the track.
//!
//! From the aircraft to the *via* station it runs forward, from the last station back to the via station it gives the
//! cost-to-go. A path goes through each local minimum of the sum at the via station, so paths differ by the side on which they
//! pass. Costs are whole numbers of 1/32.

use super::edges::{
    CLIMBS, LAYERS, Layers, NONE, ROWS, SLOPES, UNIT, across, backward, forward, units,
};
use crate::map::{ClearColumn, VoxelField};
use crate::tuning::space_lattice::{HEIGHT, LACK, SIDE};
use crate::tuning::{UNKNOWN_AHEAD, UNKNOWN_COST};
use crate::vehicle::{SpaceModel, between};
use core::ops::Range;

/// Stations, that of the aircraft included.
pub(super) const STATIONS: usize = 14;
/// The via station.
pub(super) const VIA: usize = 5;
/// Distance of places across \[m\]: to the sides and in height.
pub(super) const ACROSS: f64 = 0.5;
pub(super) const UP: f64 = 1.0;
/// A slope of the track moves a path by so much from station to station, for each place of it \[m\].
const SLOPE_STEP: f64 = 2.0 * ACROSS;
/// Least and greatest distance of stations \[m\]. Near stations need small steps, far ones time.
const LEAST_STEP: f64 = 2.8;
const MOST_STEP: f64 = 6.0;
/// How much more tightly paths bend than level turns: roll-outs follow them under all limits [-].
const TIGHTER: f64 = 1.15;
/// Greatest cost-to-go that counts [-].
const MOST_TO_GO: f64 = 500.0;

/// Costs of all states at a station.
pub(super) type Station = [[[Layers; CLIMBS]; SLOPES]; ROWS];

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
    pub(super) forward: [Station; VIA + 1],
    pub(super) backward: [Station; STATIONS - VIA],
    /// Costs of the places at the next station, by the station before it.
    pub(super) nodes: [[Layers; ROWS]; STATIONS - 1],
    /// Costs halfway between two stations: by twice the mean row, then at and between layers.
    pub(super) halfway: [[[Layers; 2]; 2 * ROWS - 1]; STATIONS - 1],
    pub(super) origin: [f64; 3],
    pub(super) step: f64,
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
        let slope = place(velocity[1] / ahead * self.step / SLOPE_STEP + 3.0, SLOPES);
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

    /// Rows that paths reach at the station after `station`, before the via station.
    pub(super) fn reached(&self, station: usize) -> Range<usize> {
        let free = |row: &[[Layers; CLIMBS]; SLOPES]| {
            let costs = row.as_flattened().as_flattened();
            costs.iter().any(|cost| *cost < NONE)
        };
        let rows = self.forward.get(station).map_or(&[][..], |rows| rows);
        let (first, last) = (rows.iter().position(free), rows.iter().rposition(free));
        let (first, last) = (first.unwrap_or(0), last.unwrap_or(0));
        first.saturating_sub(SLOPES - 1)..(last + SLOPES).min(ROWS)
    }

    /// Prices the places in some rows at the station after `station`, and those halfway to it.
    pub(super) fn price(
        &mut self,
        station: usize,
        field: &VoxelField,
        rules: &Rules,
        rows: Range<usize>,
    ) {
        let half = (station as f64 + 0.5) * self.step;
        let line = |ahead: f64, row: f64| Line::new(&self.origin, field, rules, ahead, row);
        let (Some(nodes), Some(halfway)) =
            (self.nodes.get_mut(station), self.halfway.get_mut(station))
        else {
            return;
        };
        let halves = 2 * rows.start..2 * rows.end - 1;
        for (row, parts) in halves
            .clone()
            .zip(halfway.get_mut(halves).unwrap_or(&mut []))
        {
            let line = line(half, row as f64 / 2.0);
            for (between, layers) in parts.iter_mut().enumerate() {
                for (layer, cost) in layers.iter_mut().enumerate() {
                    *cost = units(line.cost(layer as f64 + 0.5 * between as f64).0);
                }
            }
        }
        for (row, layers) in rows.clone().zip(nodes.get_mut(rows).unwrap_or(&mut [])) {
            let line = line(half + 0.5 * self.step, row as f64);
            for (layer, cost) in layers.iter_mut().enumerate() {
                let (place, [_, side, z]) = line.cost(layer as f64);
                let off = z - rules.altitude;
                let far = HEIGHT * off * off + SIDE * side * side;
                *cost = units(place + far);
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
        let (slope, by_slope) = split(velocity[1] / ahead * self.step / SLOPE_STEP + 3.0, SLOPES);
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
pub(super) struct State {
    pub(super) row: usize,
    pub(super) slope: usize,
    pub(super) climb: usize,
    pub(super) layer: usize,
}

fn clear(station: &mut Station) {
    (station.as_flattened_mut().as_flattened_mut())
        .as_flattened_mut()
        .fill(NONE);
}

pub(super) fn cost_at(station: Option<&Station>, state: &State) -> u32 {
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

/// Places above each other.
struct Line<'a> {
    field: &'a VoxelField,
    rules: &'a Rules,
    /// The place of the middle layer.
    foot: [f64; 3],
    /// Distance beyond the sides of the band \[m\].
    outside: f64,
    /// Weight of the unknown [-].
    near: f64,
    column: ClearColumn<'a>,
}

impl<'a> Line<'a> {
    /// The places at a distance ahead of the origin \[m\], and at a row.
    fn new(
        origin: &[f64; 3],
        field: &'a VoxelField,
        rules: &'a Rules,
        ahead: f64,
        row: f64,
    ) -> Self {
        let (x, y) = (
            origin[0] + ahead,
            origin[1] + (row - (ROWS / 2) as f64) * ACROSS,
        );
        Self {
            field,
            rules,
            foot: [x, y, origin[2]],
            outside: (libm::fabs(y) - rules.half_width).max(0.0),
            near: 1.0 - ahead / UNKNOWN_AHEAD,
            column: field.clear_column(x, y, rules.margin),
        }
    }

    /// Cost of the place at a layer [-], without that of its distance from the middle, and the place.
    fn cost(&self, layer: f64) -> (f64, [f64; 3]) {
        let [x, y, origin] = self.foot;
        let (field, rules) = (self.field, self.rules);
        let z = origin + (layer - (LAYERS / 2) as f64) * UP;
        let point = [x, y, z];
        let [low, high] = rules.heights;
        let beyond = (low - z).max(z - high).max(0.0);
        let near_obstacle = if self.column.is_clear(z) {
            0.0
        } else {
            (rules.margin - field.clearance(&point)).max(0.0)
        };
        let lack = near_obstacle + beyond + self.outside;
        let unknown = if self.near > 0.0 && field.is_unknown(&point) {
            UNKNOWN_COST * self.near
        } else {
            0.0
        };
        (LACK * lack * lack + unknown, point)
    }
}
