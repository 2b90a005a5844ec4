//! The edges between two stations of the lattice, by their slopes.

use crate::tuning::lattice::{MOST_POINT_COST, SLOPE_WEIGHT, TURN_COST};
use core::ops::Range;

/// Number of heights at a station.
pub(super) const HEIGHTS: usize = 97;
/// Number of slopes at a station.
pub(super) const SLOPES: usize = 9;
pub(super) const LEVEL: i32 = (SLOPES as i32 - 1) / 2;
pub(super) const MIDDLE: i32 = (HEIGHTS as i32 - 1) / 2;
/// The station at which the two passes meet.
pub(super) const VIA: usize = 6;

/// Costs by slope and height.
pub(super) type Layer = [[u32; HEIGHTS]; SLOPES];
pub(super) const NO_COSTS: Layer = [[0; HEIGHTS]; SLOPES];
/// Cost of what no path reaches.
pub(super) const NEVER: u32 = 1 << 30;
/// Costs are multiples of this number. While a search compares edges it adds the number of the edge, so that the least
/// number is the first of the best edges, and tells which one it is.
pub(super) const CHOICES: u32 = 4;

/// Number of points of an edge whose costs the search adds up.
pub(super) const QUARTERS: usize = 4;
/// Number of heights of these points, in steps of half of [`RISE`].
pub(super) const POINTS: usize = 2 * HEIGHTS - 1;
/// Costs are whole numbers of sixteenths, so that sums do not depend on the order of their terms.
const COST_UNIT: f64 = 16.0;
/// Farthest point of an edge from the height at which it begins, in steps of half of `RISE`.
pub(super) const EDGE_REACH: usize = 18;

/// Costs of the points of edges, by quarter and height in halves of `RISE`: first the even heights, then the odd ones. The
/// first and the last [`EDGE_REACH`] heights lie outside of the lattice and cost nothing.
pub(super) type PointCosts = [[[u32; EDGE_REACH + HEIGHTS]; 2]; QUARTERS];
pub(super) const NO_POINT_COSTS: PointCosts = [[[0; _]; 2]; QUARTERS];

/// A cost as the search counts it.
pub(super) fn in_units(cost: f64) -> u32 {
    CHOICES * (COST_UNIT * cost).min(MOST_POINT_COST) as u32
}

/// The cost that the search counts so.
pub(super) fn from_units(cost: u32) -> f64 {
    f64::from(cost / CHOICES) / COST_UNIT
}

/// The heights between the lowest and the highest that a path reaches.
pub(super) fn reached(layer: &Layer) -> Range<usize> {
    let is_reached = |height: &usize| {
        let mut costs = layer.iter().filter_map(|costs| costs.get(*height));
        costs.any(|cost| *cost < NEVER)
    };
    let mut heights = (0..HEIGHTS).filter(is_reached);
    let first = heights.next().unwrap_or(0);
    first..heights.next_back().unwrap_or(first) + 1
}

/// Sets costs that no path reaches. The compiler would write an array of such values as one store for each of
/// them.
#[inline(never)]
pub(super) fn forbid(layer: &mut Layer) {
    layer.as_flattened_mut().fill(NEVER);
}

/// A row of a layer by the number of the slope.
pub(super) fn row(layer: &Layer, slope: i32) -> Option<&[u32; HEIGHTS]> {
    layer.get(usize::try_from(slope).ok()?)
}

/// Number of choices in a byte.
const PER_BYTE: usize = 4;
/// The numbers of the edges at each height and slope: [`ChoiceBits`] tells which bits hold them.
pub(super) type Choice = [[u8; HEIGHTS]; SLOPES.div_ceil(PER_BYTE)];

/// The two bits that hold the choices of a slope: four slopes share a row of bytes.
#[derive(Clone, Copy)]
struct ChoiceBits {
    row: usize,
    shift: u32,
}

impl ChoiceBits {
    fn of(slope: i32) -> Self {
        let slope = slope as u32;
        Self {
            row: slope as usize / PER_BYTE,
            shift: 2 * (slope % PER_BYTE as u32),
        }
    }
}

/// The number of the edge at a height and a slope.
pub(super) fn choice(choices: &Choice, (height, slope): (i32, i32)) -> Option<usize> {
    let bits = ChoiceBits::of(slope);
    let byte = choices.get(bits.row)?.get(usize::try_from(height).ok()?)?;
    Some(usize::from(byte >> bits.shift & 3))
}

/// Takes the numbers of the edges out of the costs of a station.
#[inline(never)]
pub(super) fn settle(found: &Layer, layer: &mut Layer, choices: &mut Choice) {
    for (slope, (costs, found)) in (0..).zip(layer.iter_mut().zip(found)) {
        let ChoiceBits { row, shift } = ChoiceBits::of(slope);
        let choices = choices.get_mut(row).map_or(&mut [][..], |row| row);
        for ((cost, place), found) in costs.iter_mut().zip(choices).zip(found) {
            *cost = found & !(CHOICES - 1);
            *place = *place & !(3 << shift) | ((found & (CHOICES - 1)) as u8) << shift;
        }
    }
}

/// All edges from a slope at one station to a slope at the next.
pub(super) struct Edges {
    /// Slopes, in steps from level.
    slope: i32,
    next: i32,
}

impl Edges {
    /// The edges between two slopes by their numbers, if both exist.
    pub(super) fn new(from: i32, to: i32) -> Option<Self> {
        let slopes = 0..SLOPES as i32;
        (slopes.contains(&from) && slopes.contains(&to)).then_some(Self {
            slope: from - LEVEL,
            next: to - LEVEL,
        })
    }

    /// The change of height along an edge, in heights.
    fn rise(&self) -> i32 {
        self.slope + self.next
    }

    /// The heights of a range from which an edge leads to a height of the lattice.
    pub(super) fn starts(&self, heights: &Range<usize>) -> Range<usize> {
        let [down, up] = [-self.rise(), self.rise()].map(|steps| steps.max(0) as usize);
        heights.start.max(down)..heights.end.min(HEIGHTS - up)
    }

    /// The heights to which the edges from certain heights lead.
    pub(super) fn ends(&self, starts: &Range<usize>) -> Range<usize> {
        let end = |start: usize| start.saturating_add_signed(self.rise() as isize);
        end(starts.start)..end(starts.end)
    }

    /// Lowers costs to those over the edges from the height `first` on, which are known costs and the costs of
    /// points, slope and turn, and the number of the edge.
    // The callers are few loops over slopes, which would each hold a copy.
    #[inline(never)]
    pub(super) fn relax(
        &self,
        points: &PointCosts,
        first: usize,
        known: &[u32],
        number: u32,
        costs: &mut [u32],
    ) {
        let turn = self.next - self.slope;
        let of_turn = if turn == 0 { 0 } else { in_units(TURN_COST) };
        let own = of_turn + in_units(SLOPE_WEIGHT * f64::from(self.next * self.next)) + number;
        let of_quarter = |quarter: usize| {
            // The edge is a parabola, in halves of a rise: slope q + turn q^2 / 8, rounded down.
            let q = quarter as i32 + 1;
            let rise = self.slope * q + turn * (q * q / 8);
            let place = (EDGE_REACH + 2 * first).saturating_add_signed(rise as isize);
            let points = points.get(quarter).and_then(|points| points.get(place % 2));
            let points = points.and_then(|points| points.get(place / 2..));
            points.unwrap_or_default().iter()
        };
        let [a, b, c, d] = [0, 1, 2, 3].map(of_quarter);
        let edges = known.iter().zip(a.zip(b).zip(c.zip(d)));
        for (cost, (known, ((a, b), (c, d)))) in costs.iter_mut().zip(edges) {
            // The sum cannot overflow: known costs are at most `NEVER`, and those of an edge 2e8.
            let through = known.wrapping_add(own + a + b + c + d);
            *cost = through.min(*cost);
        }
    }
}

const _: () = assert!(QUARTERS == 4 && EDGE_REACH == QUARTERS * LEVEL as usize + 2);
