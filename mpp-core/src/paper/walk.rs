//! The cells that a straight line passes (Amanatides, Woo: "A fast voxel traversal algorithm for
//! ray tracing", 1987).

use super::GridPoint;
use crate::map::cell::rounded_down;

/// Iterates over the cells along a ray: `(row, col, distance at which the cell is entered [m])`.
///
/// The first item is the cell of the origin at distance 0. The walk never ends by itself: the caller
/// stops it at a distance, which bounds the number of cells by `2 distance + 3`.
pub(super) struct CellWalk {
    cell: [i32; 2],
    step: [i32; 2],
    next_line: [f64; 2],
    line_spacing: [f64; 2],
    entered: f64,
}

impl CellWalk {
    /// A walk from `origin` along the unit vector `direction` `(row, col)`.
    pub(super) fn new(origin: GridPoint, direction: [f64; 2]) -> Self {
        let origin = [origin.row, origin.col];
        let mut walk = Self {
            cell: [0; 2],
            step: [0; 2],
            next_line: [f64::INFINITY; 2],
            line_spacing: [f64::INFINITY; 2],
            entered: 0.0,
        };
        for axis in 0..2 {
            walk.cell[axis] = rounded_down(origin[axis]);
            let floor = f64::from(walk.cell[axis]);
            let inverse = 1.0 / direction[axis];
            if direction[axis] > 0.0 {
                walk.step[axis] = 1;
                walk.next_line[axis] = (floor + 1.0 - origin[axis]) * inverse;
                walk.line_spacing[axis] = inverse;
            } else if direction[axis] < 0.0 {
                walk.step[axis] = -1;
                walk.next_line[axis] = (floor - origin[axis]) * inverse;
                walk.line_spacing[axis] = -inverse;
            }
        }
        walk
    }

    /// Crosses the next line of an axis.
    #[inline]
    fn cross<const AXIS: usize>(&mut self) {
        self.entered = self.next_line[AXIS];
        self.cell[AXIS] = self.cell[AXIS].saturating_add(self.step[AXIS]);
        self.next_line[AXIS] += self.line_spacing[AXIS];
    }
}

impl Iterator for CellWalk {
    type Item = (i32, i32, f64);

    fn next(&mut self) -> Option<Self::Item> {
        let item = (self.cell[0], self.cell[1], self.entered);
        // Axes by constants stay in registers.
        if self.next_line[1] < self.next_line[0] {
            self.cross::<1>();
        } else {
            self.cross::<0>();
        }
        Some(item)
    }
}
