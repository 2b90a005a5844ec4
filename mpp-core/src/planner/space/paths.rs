//! Paths through the lattice, from the costs of its stations.

use super::edges::{CLIMBS, LAYERS, NONE, ROWS, SLOPES, across, up};
use super::lattice::{ACROSS, Lattice, Path, STATIONS, State, UP, VIA, cost_at};

impl Lattice {
    /// Paths through the local minima at the via station, at least `apart` places from each other, cheapest first.
    pub(super) fn paths<const N: usize>(&self, apart: usize, paths: &mut heapless::Vec<Path, N>) {
        paths.clear();
        let mut totals = [[(NONE, 0, 0); LAYERS]; ROWS];
        let (forward, backward) = (&self.forward[VIA], &self.backward[0]);
        for (totals, (ahead, back)) in totals.iter_mut().zip(forward.iter().zip(backward)) {
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
    let (mut moved, mut placed) = ((cost, state), false);
    for other in minima.iter_mut() {
        placed |= moved.0 < other.0;
        if placed {
            core::mem::swap(other, &mut moved);
        }
    }
    let _ = minima.push(moved);
}
