//! The cost-to-go in space, from any state at the via station, and the geometry of stations and places.

use super::edges::{CLIMBS, LAYERS, Layers, NONE, ROWS, SLOPES, UNIT};
use crate::vehicle::{SpaceModel, between};

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
/// How much more tightly paths bend than level turns: roll-outs follow them under all limits [-]. More brings stations nearer and
/// shortens the view. Source: decision 46.
const TIGHTER: f64 = 1.15;
/// Greatest cost-to-go that counts [-].
const MOST_TO_GO: f64 = 500.0;

/// Costs of all states at a station.
pub(super) type Station = [[[Layers; CLIMBS]; SLOPES]; ROWS];

/// A path through the lattice: a point at each station \[m\].
pub(super) type Path = [[f64; 3]; STATIONS];

/// What the lattice leaves: the costs from the via station to the last one.
#[derive(Clone, Debug)]
pub(super) struct CostToGo {
    /// At the via station. During the search also at odd stations beyond it.
    pub(super) states: Station,
    /// The place of the first station \[m\], and the distance of stations \[m\].
    pub(super) origin: [f64; 3],
    pub(super) step: f64,
}

impl CostToGo {
    pub(super) const fn new() -> Self {
        Self {
            states: [[[[0; LAYERS]; CLIMBS]; SLOPES]; ROWS],
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

    /// The x of the via station \[m\].
    pub(super) fn via(&self) -> f64 {
        self.origin[0] + VIA as f64 * self.step
    }

    /// The place of a state at a station \[m\].
    pub(super) fn point(&self, station: usize, state: &State) -> [f64; 3] {
        let [x, y, z] = self.origin;
        [
            x + station as f64 * self.step,
            y + (state.row as f64 - (ROWS / 2) as f64) * ACROSS,
            z + (state.layer as f64 - (LAYERS / 2) as f64) * UP,
        ]
    }

    /// Slope and climb of a velocity over ground, in places, from the least ones on.
    pub(super) fn slopes(&self, velocity: &[f64; 3]) -> [f64; 2] {
        let ahead = velocity[0].max(2.0);
        [
            velocity[1] / ahead * self.step / SLOPE_STEP + 3.0,
            velocity[2] / ahead * self.step / UP + 1.0,
        ]
    }

    /// Cost-to-go of a point at the via station with a velocity over ground.
    pub(super) fn cost(&self, [_, y, z]: &[f64; 3], velocity: &[f64; 3]) -> f64 {
        let split = |value: f64, count: usize| {
            let inside = value.max(0.0).min(count as f64 - 1.01);
            let low = libm::floor(inside);
            (low as usize, inside - low)
        };
        let (row, by_row) = split((y - self.origin[1]) / ACROSS + (ROWS / 2) as f64, ROWS);
        let (layer, by_layer) = split((z - self.origin[2]) / UP + (LAYERS / 2) as f64, LAYERS);
        let [slope, climb] = self.slopes(velocity);
        let (slope, by_slope) = split(slope, SLOPES);
        let climb = within(libm::round(climb), CLIMBS);
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
            let cost = f64::from(cost_at(&self.states, &state)) / UNIT;
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

fn cost_at(station: &Station, state: &State) -> u32 {
    let states = station.get(state.row);
    let layers = states.and_then(|slopes| slopes.get(state.slope)?.get(state.climb));
    u32::from(
        layers
            .and_then(|layers| layers.get(state.layer))
            .copied()
            .unwrap_or(NONE),
    )
}

/// The place of a whole number, among `count`.
pub(super) fn within(value: f64, count: usize) -> usize {
    value.max(0.0).min(count as f64 - 1.0) as usize
}
