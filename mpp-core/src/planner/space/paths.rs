//! Paths through the lattice, from the costs at its via station and the edges that won.

use super::cost_to_go::{CostToGo, Path, STATIONS, State, VIA};
use super::edges::{LAYERS, NONE, ROWS};
use super::lattice::Lattice;

impl Lattice {
    /// Paths through the local minima at the via station, at least `apart` places from each other, cheapest first.
    pub(super) fn paths<const N: usize>(
        &self,
        to_go: &CostToGo,
        apart: usize,
        paths: &mut heapless::Vec<Path, N>,
    ) {
        paths.clear();
        let mut totals = [[(NONE, 0, 0); LAYERS]; ROWS];
        let (forward, backward) = (self.to_via(), &to_go.states);
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
            let _ = paths.push(self.trace(to_go, *state));
        }
    }

    /// The cheapest path through a state at the via station.
    fn trace(&self, to_go: &CostToGo, via: State) -> Path {
        let mut path = [to_go.point(VIA, &via); STATIONS];
        let mut state = via;
        for station in (0..VIA).rev() {
            state = self.before(station, &state);
            if let Some(point) = path.get_mut(station) {
                *point = to_go.point(station, &state);
            }
        }
        state = via;
        for station in VIA..STATIONS - 1 {
            state = self.after(station, &state);
            if let Some(point) = path.get_mut(station + 1) {
                *point = to_go.point(station + 1, &state);
            }
        }
        path
    }

    /// The cheapest state at a station from which a path leads to a state at the next one.
    fn before(&self, station: usize, to: &State) -> State {
        let (slope, climb) = self.choice(station, to);
        State {
            row: (to.row + 6).saturating_sub(slope + to.slope),
            slope,
            climb,
            layer: (to.layer + 1).saturating_sub(to.climb),
        }
    }

    /// The cheapest state at the next station.
    fn after(&self, station: usize, from: &State) -> State {
        let (slope, climb) = self.choice(station, from);
        State {
            row: (from.row + from.slope + slope).saturating_sub(6),
            slope,
            climb,
            layer: (from.layer + climb).saturating_sub(1),
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
