//! The edges between two stations of the lattice, by their slopes.

use crate::tuning::lattice::{SLOPE_WEIGHT, TURN_COST};
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
pub(super) const NEVER: u32 = 1 << 28;

/// Number of points of an edge whose costs the search adds up.
pub(super) const QUARTERS: usize = 4;
/// Number of heights of these points, in steps of half of [`RISE`].
pub(super) const POINTS: usize = 2 * HEIGHTS - 1;
/// Costs are whole numbers of sixteenths, so that sums do not depend on the order of their terms.
pub(super) const COST_UNIT: f64 = 16.0;
/// Farthest point of an edge from the height at which it begins, in steps of half of `RISE`.
pub(super) const EDGE_REACH: usize = 18;

/// Costs of the points of edges, by quarter and height in halves of `RISE`. The first and the last
/// [`EDGE_REACH`] places lie outside of the heights and cost nothing. One more place makes pairs of them.
pub(super) type PointCosts = [[u32; EDGE_REACH + POINTS + EDGE_REACH + 1]; QUARTERS];
pub(super) const NO_POINT_COSTS: PointCosts = [[0; _]; QUARTERS];

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
pub(super) const PER_BYTE: usize = 4;

/// The two bits that hold the choices of a slope: four slopes share a row of bytes. A choice is the change of the slope
/// by -1 to 1.
#[derive(Clone, Copy)]
pub(super) struct ChoiceBits {
    pub(super) row: usize,
    shift: u32,
}

impl ChoiceBits {
    pub(super) fn of(slope: i32) -> Self {
        let slope = slope as u32;
        Self {
            row: slope as usize / PER_BYTE,
            shift: 2 * (slope % PER_BYTE as u32),
        }
    }

    /// The mask that keeps the other choices of a byte, and the bits of a change of slope.
    pub(super) fn choosing(self, change: i32) -> (u8, u8) {
        (!(3 << self.shift), ((change + 1) as u8) << self.shift)
    }

    /// The change of slope in a byte.
    pub(super) fn change(self, byte: u8) -> i32 {
        i32::from(byte >> self.shift & 3) - 1
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
    /// points, slope and turn. Notes the choice where a cost falls.
    // The callers are few loops over slopes, which would each hold a copy.
    #[inline(never)]
    pub(super) fn relax(
        &self,
        points: &PointCosts,
        first: usize,
        known: &[u32],
        (mask, choice): (u8, u8),
        (costs, choices): (&mut [u32], &mut [u8]),
    ) {
        const TURN: u32 = (COST_UNIT * TURN_COST) as u32;
        let turn = self.next - self.slope;
        let own = if turn == 0 { 0 } else { TURN };
        let own = own + (COST_UNIT * SLOPE_WEIGHT * f64::from(self.next * self.next)) as u32;
        let of_quarter = |quarter: usize| {
            // The edge is a parabola, in halves of a rise: slope q + turn q^2 / 8, rounded down.
            let q = quarter as i32 + 1;
            let rise = self.slope * q + turn * (q * q / 8);
            let place = (EDGE_REACH + 2 * first).saturating_add_signed(rise as isize);
            let points = points.get(quarter).and_then(|points| points.get(place..));
            points.unwrap_or_default().as_chunks::<2>().0.iter()
        };
        let [a, b, c, d] = [0, 1, 2, 3].map(of_quarter);
        let quarters = a.zip(b).zip(c).zip(d);
        let edges = known.iter().zip(quarters);
        for ((cost, place), (known, ((([a, _], [b, _]), [c, _]), [d, _]))) in
            costs.iter_mut().zip(choices).zip(edges)
        {
            // The sum cannot overflow: known costs are at most `NEVER`, and those of an edge 5e7.
            let through = known.wrapping_add(own + a + b + c + d);
            if through < *cost {
                *cost = through;
                *place = *place & mask | choice;
            }
        }
    }
}

const _: () = assert!(QUARTERS == 4 && EDGE_REACH == QUARTERS * LEVEL as usize + 2);
