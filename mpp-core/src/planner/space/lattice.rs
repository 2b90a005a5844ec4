//! The lattice in space: dynamic programming over stations ahead, places across and slopes of the track.
//!
//! From the aircraft to the *via* station it runs forward, from the last station back to the via station it gives the
//! cost-to-go. A path goes through each local minimum of the sum at the via station, so paths differ by the side on which they
//! pass. Costs are whole numbers of 1/32. A station's costs are kept until the next but one has its own; what stays is the edge
//! that won at each state.

use super::cost_to_go::{ACROSS, CostToGo, STATIONS, State, Station, UP, VIA, within};
use super::edges::{
    CLIMBS, Choices, LAYERS, Layers, NONE, OPEN, ROWS, SLOPES, across, backward, forward, number,
    settle, sum, units,
};
use crate::map::voxel_field::needed;
use crate::map::{Storey, Upright, VoxelField};
use crate::tuning::space_lattice::{HEIGHT, LACK, SIDE};
use crate::tuning::{UNKNOWN_AHEAD, UNKNOWN_COST};
use core::ops::Range;

/// Rows in a slice, and the slices that all rows take.
pub(super) const SLICE_ROWS: usize = 4;
pub(super) const ROW_SLICES: usize = ROWS.div_ceil(SLICE_ROWS);
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

/// What the search needs until its paths are found: memory that programs take over.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    /// Costs at the even stations, and at the odd ones up to the via station: each when it is the last one. The memory of the
    /// cost-to-go has those of the odd stations from there on.
    costs: [Station; 2],
    /// The edge between two stations that won, by the station before it: at its end before the via station, at its beginning
    /// beyond.
    choices: [[[Choices; SLOPES]; ROWS]; STATIONS - 1],
    /// Rows and slopes that paths reach, at the last station of the way to the via station.
    reached: [[bool; SLOPES]; ROWS],
    /// What edges from a row cost at the rows of their ends, from [`SLOPES`] rows before it to as many behind.
    sums: [[Layers; CLIMBS]; 2 * SLOPES + 1],
    /// The heights of the layers, and those half a layer above them.
    levels: [[Level; LAYERS]; 2],
    /// Costs of the places at a station.
    nodes: [Layers; ROWS],
    /// Costs halfway to it: by twice the mean row, then at and between layers.
    halfway: [[Layers; 2]; 2 * ROWS - 1],
}

impl Lattice {
    /// Memory of zeros, which waits for [`begin`](Self::begin). A constant is written in place.
    pub(super) const ZEROS: Self = Self {
        costs: [[[[[0; LAYERS]; CLIMBS]; SLOPES]; ROWS]; 2],
        choices: [[[[[0; LAYERS.div_ceil(2)]; CLIMBS]; SLOPES]; ROWS]; STATIONS - 1],
        reached: [[false; SLOPES]; ROWS],
        sums: [[[0; LAYERS]; CLIMBS]; 2 * SLOPES + 1],
        levels: [[Level::ZERO; LAYERS]; 2],
        nodes: [[0; LAYERS]; ROWS],
        halfway: [[[0; LAYERS]; 2]; 2 * ROWS - 1],
    };

    /// Begins where the costs-to-go begin, with the velocity over ground.
    pub(super) fn begin(
        &mut self,
        to_go: &mut CostToGo,
        velocity: &[f64; 3],
        (field, rules): (&VoxelField, &Rules),
    ) {
        for (levels, above) in self.levels.iter_mut().zip([0.0, 0.5]) {
            for (layer, level) in levels.iter_mut().enumerate() {
                let places = layer as f64 + above - (LAYERS / 2) as f64;
                *level = Level::new(to_go.origin[2] + places * UP, field, rules);
            }
        }
        let [slope, climb] = to_go.slopes(velocity).map(libm::round);
        let (slope, climb) = (within(slope, SLOPES), within(climb, CLIMBS));
        let [first, _] = &mut self.costs;
        fill(first, NONE);
        fill(&mut to_go.states, 0);
        let states = first.get_mut(ROWS / 2).and_then(|row| row.get_mut(slope));
        if let Some(start) = states.and_then(|row| row.get_mut(climb)) {
            start[LAYERS / 2] = 0;
        }
        self.reached = [[false; SLOPES]; ROWS];
        let reached = self.reached.get_mut(ROWS / 2);
        if let Some(reached) = reached.and_then(|row| row.get_mut(slope)) {
            *reached = true;
        }
    }

    /// Rows of a slice.
    pub(super) fn rows(slice: usize) -> Range<usize> {
        let first = (slice * SLICE_ROWS).min(ROWS);
        first..(first + SLICE_ROWS).min(ROWS)
    }

    /// Rows that paths need at the end of the edges from a station.
    fn used(&self, station: usize) -> Range<usize> {
        if station >= VIA {
            return 0..ROWS;
        }
        let free = |row: &[bool; SLOPES]| row.contains(&true);
        let rows = &self.reached;
        let (first, last) = (rows.iter().position(free), rows.iter().rposition(free));
        let (first, last) = (first.unwrap_or(0), last.unwrap_or(0));
        first.saturating_sub(SLOPES - 1)..(last + SLOPES).min(ROWS)
    }

    /// Prices the places in those of some rows that are needed at the station after `station`, and those halfway to it.
    pub(super) fn price(
        &mut self,
        to_go: &CostToGo,
        station: usize,
        (field, rules): (&VoxelField, &Rules),
        rows: Range<usize>,
    ) {
        let used = self.used(station);
        let rows = rows.start.max(used.start)..rows.end.min(used.end);
        if rows.is_empty() {
            return;
        }
        let half = (station as f64 + 0.5) * to_go.step;
        let clear = needed(rules.margin);
        let line = |ahead: f64, row: f64| {
            let [x, y, _] = to_go.origin;
            let y = y + (row - (ROWS / 2) as f64) * ACROSS;
            Line::new([x + ahead, y], field, (rules, clear), ahead)
        };
        let halves = 2 * rows.start..(2 * rows.end).min(2 * used.end - 1);
        let parts = self.halfway.get_mut(halves.clone());
        for (row, parts) in halves.zip(parts.unwrap_or(&mut [])) {
            let line = line(half, row as f64 / 2.0);
            for (layers, levels) in parts.iter_mut().zip(&self.levels) {
                for (cost, level) in layers.iter_mut().zip(levels) {
                    *cost = units(line.cost(level));
                }
            }
        }
        let nodes = self.nodes.get_mut(rows.clone());
        for (row, layers) in rows.zip(nodes.unwrap_or(&mut [])) {
            let line = line(half + 0.5 * to_go.step, row as f64);
            for (cost, level) in layers.iter_mut().zip(&self.levels[0]) {
                *cost = units(line.cost(level) + (level.off + line.aside));
            }
        }
    }

    /// Extends the paths to the station after `station`, into some rows. All rows are priced.
    pub(super) fn extend(&mut self, station: usize, rows: Range<usize>) {
        let [even, odd] = &mut self.costs;
        let (from, to) = if station.is_multiple_of(2) {
            (even, odd)
        } else {
            (odd, even)
        };
        let Some(choices) = self.choices.get_mut(station) else {
            return;
        };
        for row in rows {
            for next in 0..SLOPES {
                let (Some(to), Some(choices)) = (
                    to.get_mut(row).and_then(|row| row.get_mut(next)),
                    choices.get_mut(row).and_then(|row| row.get_mut(next)),
                ) else {
                    return;
                };
                let begins = (next.saturating_sub(1)..(next + 2).min(SLOPES)).filter_map(|slope| {
                    let begin = (row + 6).checked_sub(slope + next)?;
                    let is_reached = *self.reached.get(begin)?.get(slope)?;
                    is_reached.then_some((slope, begin))
                });
                if begins.clone().next().is_none() {
                    to.as_flattened_mut().fill(NONE);
                    continue;
                }
                let mut contest = OPEN;
                for (slope, begin) in begins {
                    let from = from.get(begin).and_then(|row| row.get(slope));
                    if let (Some(from), Some(node), Some(half)) =
                        (from, self.nodes.get(row), self.halfway.get(row + begin))
                    {
                        let own = (across(slope, next), number(next, slope));
                        forward(from, &mut contest, node, half, own);
                    }
                }
                settle(|i| contest.map(|words| words[i]), to, choices);
            }
        }
    }

    /// Notes which rows and slopes paths reach at a station.
    pub(super) fn note_reached(&mut self, station: usize) {
        let rows = self.costs.get(station % 2);
        let rows = rows.map_or(&[][..], |rows| rows);
        for (reached, slopes) in self.reached.iter_mut().zip(rows) {
            for (reached, states) in reached.iter_mut().zip(slopes) {
                *reached = states.as_flattened().iter().any(|cost| *cost < NONE);
            }
        }
    }

    /// Computes the cost-to-go at some rows of a station from the via station on, from that of the next one. All rows are priced.
    pub(super) fn retreat(&mut self, to_go: &mut CostToGo, station: usize, rows: Range<usize>) {
        let ([even, _], odd) = (&mut self.costs, &mut to_go.states);
        let (from, to) = if station.is_multiple_of(2) {
            (odd, even)
        } else {
            (even, odd)
        };
        let Some(choices) = self.choices.get_mut(station) else {
            return;
        };
        for row in rows {
            for (sums, shift) in self.sums.iter_mut().zip(0..) {
                let end = (row + shift).checked_sub(SLOPES);
                // A change of the slope beyond the last one leads nowhere.
                let end = end.filter(|_| (1..2 * SLOPES).contains(&shift));
                match end.and_then(|end| Some((self.nodes.get(end)?, self.halfway.get(row + end)?)))
                {
                    Some((node, half)) => sum(sums, node, half),
                    None => sums.as_flattened_mut().fill(NONE),
                }
            }
            for slope in 0..SLOPES {
                // Where there is no edge its sums are too large.
                let from = |other: usize| {
                    let next = (slope + other).saturating_sub(1).min(SLOPES - 1);
                    let end = (row + 2 * slope + other)
                        .saturating_sub(SLOPES)
                        .min(ROWS - 1);
                    from.get(end)?.get(next)
                };
                if let (Some(a), Some(b), Some(c), Some(sums), Some(to), Some(choices)) = (
                    from(0),
                    from(1),
                    from(2),
                    self.sums
                        .get(2 * slope..)
                        .and_then(|sums| sums.first_chunk()),
                    to.get_mut(row).and_then(|row| row.get_mut(slope)),
                    choices.get_mut(row).and_then(|row| row.get_mut(slope)),
                ) {
                    backward([a, b, c], sums, slope, to, choices);
                }
            }
        }
    }

    /// Costs of the ways to the via station.
    pub(super) fn to_via(&self) -> &Station {
        let [_, odd] = &self.costs;
        odd
    }

    /// The edge that won at a state: the slope and the climb at its other end.
    pub(super) fn choice(&self, station: usize, state: &State) -> (usize, usize) {
        let rows = self.choices.get(station);
        let choices = rows.and_then(|rows| rows.get(state.row)?.get(state.slope)?.get(state.climb));
        let pair = choices.and_then(|choices| choices.get(state.layer / 2));
        let number = pair.map_or(0, |pair| usize::from(pair >> (state.layer % 2 * 4) & 15));
        let other = |at: usize, change: usize| (at + change).saturating_sub(1);
        (
            other(state.slope, number / 3),
            other(state.climb, number % 3),
        )
    }
}

fn fill(station: &mut Station, cost: u16) {
    (station.as_flattened_mut().as_flattened_mut())
        .as_flattened_mut()
        .fill(cost);
}

/// A height at which places are priced.
#[derive(Clone, Copy, Debug)]
struct Level {
    storey: Storey,
    /// Distance beyond the band \[m\].
    beyond: f64,
    /// Cost of that where all is clear and seen, and cost of the distance from the wanted height [-].
    plain: f64,
    off: f64,
}

impl Level {
    const ZERO: Self = Self {
        storey: Storey::ZERO,
        beyond: 0.0,
        plain: 0.0,
        off: 0.0,
    };

    fn new(z: f64, field: &VoxelField, rules: &Rules) -> Self {
        let ([low, high], off) = (rules.heights, z - rules.altitude);
        let beyond = (low - z).max(z - high).max(0.0);
        Self {
            storey: field.storey(z),
            beyond,
            plain: LACK * beyond * beyond,
            off: HEIGHT * off * off,
        }
    }
}

/// Places above each other.
struct Line<'a> {
    upright: Upright<'a>,
    /// Clearance that a path keeps \[m\].
    margin: f64,
    /// Distance beyond the sides of the band \[m\].
    outside: f64,
    /// Cost of the distance from the middle of the band [-].
    aside: f64,
    /// Cost of the unknown, where it has one [-].
    unknown: Option<f64>,
    /// Whether all places lie within the sides, are clear, and seen where that counts.
    plain: bool,
}

impl<'a> Line<'a> {
    /// The places at an x and y \[m\], `ahead` of the origin by a distance \[m\], with the distance that is clear.
    fn new(
        [x, y]: [f64; 2],
        field: &'a VoxelField,
        (rules, clear): (&Rules, u8),
        ahead: f64,
    ) -> Self {
        let near = 1.0 - ahead / UNKNOWN_AHEAD;
        let (upright, outside) = (
            field.upright(x, y, clear),
            (libm::fabs(y) - rules.half_width).max(0.0),
        );
        let seen = near <= 0.0 || !upright.has_unknown();
        Self {
            plain: outside <= 0.0 && seen && upright.is_all_clear(),
            upright,
            margin: rules.margin,
            outside,
            aside: SIDE * y * y,
            unknown: (near > 0.0).then_some(UNKNOWN_COST * near),
        }
    }

    /// Cost of the place at a height [-], without that of its distance from the middle.
    fn cost(&self, level: &Level) -> f64 {
        if self.plain {
            return level.plain;
        }
        let near_obstacle = if self.upright.is_clear(&level.storey) {
            0.0
        } else {
            (self.margin - self.upright.clearance(&level.storey)).max(0.0)
        };
        let lack = near_obstacle + level.beyond + self.outside;
        let unknown = (self.unknown).filter(|_| self.upright.is_unknown(&level.storey));
        LACK * lack * lack + unknown.unwrap_or(0.0)
    }
}
