//! Which bodies stand where: a grid of square cells over x and y.
//!
//! The bodies of a world are thin, upright and evenly spread, so a cell holds one or two, and a ray steps from cell to cell.

use std::ops::Range;

/// Side of a cell \[m\]. A ray of 40 m among 2,000 trunks takes as long in cells of 3 to 6 m, and longer in others
/// (example `rays`); clearances take least time with 4 m.
const CELL: f64 = 4.0;
/// Most cells of a grid. A world of 100 km gets larger ones, and slower rays.
const MOST_CELLS: f64 = 1e6;
/// What the outline of a body gets on each side \[m\], so that rounding keeps no body out of a cell that it touches.
const SEAM: f64 = 1e-6;

/// A grid of numbers of bodies.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    corner: [f64; 2],
    cell: f64,
    counts: [usize; 2],
    /// The numbers of cell `i` stand from `starts[i]` to `starts[i + 1]`.
    starts: Vec<u32>,
    numbers: Vec<u32>,
}

impl Grid {
    /// The grid of bodies with these least and greatest x and y, all of them finite.
    pub(super) fn new(outlines: &[[[f64; 2]; 2]]) -> Self {
        let mut corner = [f64::INFINITY; 2];
        let mut far = [f64::NEG_INFINITY; 2];
        for [least, most] in outlines {
            for axis in 0..2 {
                corner[axis] = corner[axis].min(least[axis] - SEAM);
                far[axis] = far[axis].max(most[axis] + SEAM);
            }
        }
        let size = [0, 1].map(|axis| (far[axis] - corner[axis]).max(0.0));
        let cell = CELL.max((size[0] * size[1] / MOST_CELLS).sqrt());
        let cell = cell.max(size[0].max(size[1]) / MOST_CELLS);
        let mut grid = Self {
            corner,
            cell,
            counts: size.map(|it| (it / cell) as usize + 1),
            starts: Vec::new(),
            numbers: Vec::new(),
        };
        let mut entries: Vec<(usize, u32)> = Vec::new();
        for (number, [least, most]) in (0..).zip(outlines) {
            let least = least.map(|it| it - SEAM);
            let most = most.map(|it| it + SEAM);
            entries.extend(grid.cells(least, most).map(|cell| (cell, number)));
        }
        // Within a cell the bodies keep their order.
        entries.sort_unstable();
        let cells = grid.counts[0] * grid.counts[1];
        let starts = (0..=cells).map(|cell| entries.partition_point(|it| it.0 < cell) as u32);
        grid.starts = starts.collect();
        grid.numbers = entries.into_iter().map(|(_, number)| number).collect();
        grid
    }

    /// Index of the cell along an axis, within the grid.
    fn index(&self, axis: usize, value: f64) -> usize {
        let index = ((value - self.corner[axis]) / self.cell) as usize;
        index.min(self.counts[axis] - 1)
    }

    fn cells(&self, least: [f64; 2], most: [f64; 2]) -> impl Iterator<Item = usize> + use<> {
        let range = |axis| self.index(axis, least[axis])..self.index(axis, most[axis]) + 1;
        let (columns, rows): (Range<usize>, Range<usize>) = (range(0), range(1));
        let width = self.counts[0];
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    fn of_cell(&self, cell: usize) -> &[u32] {
        &self.numbers[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// The bodies whose cells meet a box; a body of several cells comes several times.
    pub(super) fn near(&self, least: [f64; 2], most: [f64; 2]) -> impl Iterator<Item = usize> {
        let cells = self.cells(least, most);
        let numbers = cells.flat_map(|cell| self.of_cell(cell));
        numbers.map(|number| *number as usize)
    }

    /// Shows the bodies along a ray, cell by cell, until `hit` gives a way that ends before the cell does. `hit` gets the
    /// body and gives the way along the ray to it. Returns the shortest way of at most `most`.
    pub(super) fn along(
        &self,
        from: [f64; 2],
        direction: [f64; 2],
        most: f64,
        hit: impl Fn(usize) -> Option<f64>,
    ) -> Option<f64> {
        let (mut enters, mut leaves) = (0.0_f64, most);
        for axis in 0..2 {
            let low = self.corner[axis] - from[axis];
            let high = low + self.counts[axis] as f64 * self.cell;
            if direction[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (one, other) = (low / direction[axis], high / direction[axis]);
            enters = enters.max(one.min(other));
            leaves = leaves.min(one.max(other));
        }
        if self.numbers.is_empty() || enters > leaves {
            return None;
        }
        let mut at = [0, 1].map(|axis| self.index(axis, from[axis] + enters * direction[axis]));
        let mut next = [0, 1].map(|axis| {
            let edge = at[axis] + usize::from(direction[axis] > 0.0);
            let edge = self.corner[axis] + edge as f64 * self.cell;
            if direction[axis] == 0.0 {
                f64::INFINITY
            } else {
                (edge - from[axis]) / direction[axis]
            }
        });
        let step = direction.map(|it| self.cell / it.abs());
        let mut least = f64::INFINITY;
        loop {
            for number in self.of_cell(at[1] * self.counts[0] + at[0]) {
                least = hit(*number as usize).map_or(least, |way| way.min(least));
            }
            let axis = usize::from(next[1] < next[0]);
            let end = next[axis].min(leaves);
            let inside = if direction[axis] > 0.0 {
                at[axis] + 1 < self.counts[axis]
            } else {
                at[axis] > 0
            };
            if least <= end || next[axis] >= leaves || !inside {
                return (least <= most).then_some(least);
            }
            at[axis] = if direction[axis] > 0.0 {
                at[axis] + 1
            } else {
                at[axis] - 1
            };
            next[axis] += step[axis];
        }
    }
}
