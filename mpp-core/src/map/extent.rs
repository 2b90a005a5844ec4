//! The part of a column of voxels that hits have shown.

use crate::tuning::grid::CELL;
use crate::tuning::space_map::CLOSER;

/// Parts of the edge of a voxel.
pub(crate) const PARTS: i32 = 16;
/// Length of a part \[m\].
pub(crate) const PART: f64 = CELL / PARTS as f64;
/// Unit of ranges \[m\].
const RANGE: f64 = 0.25;
/// Range of a column in which nothing was hit.
const NEVER: u8 = u8::MAX;

/// Least and greatest x and y of the hits in a column, in parts of a voxel. One box serves all voxels of the column, because
/// trunks and walls stand: the rings of a scan share what they have seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Extent {
    /// First and last part along x and y: four bits each.
    parts: [u8; 2],
    /// Range of the nearest hit.
    range: u8,
}

impl Extent {
    /// All of the column.
    pub(crate) const FULL: Self = Self {
        parts: [0xf0; 2],
        range: NEVER,
    };

    /// Takes up a hit from a range \[m\]. One from much closer begins anew, and one from much farther does not count: it
    /// carries the error of the attitude over a longer arm.
    pub(crate) fn take(&mut self, point: &[f64; 3], range: f64) {
        let range = (range / RANGE).min(f64::from(NEVER - 1)) as u8;
        let (new, old) = (f64::from(range), f64::from(self.range));
        if self.range < NEVER && new * CLOSER > old {
            return;
        }
        let anew = self.range == NEVER || new < CLOSER * old;
        for (parts, at) in self.parts.iter_mut().zip(point) {
            let inside = at / CELL - libm::floor(at / CELL);
            let part = ((inside * f64::from(PARTS)) as u8).min(PARTS as u8 - 1);
            let (low, high) = if anew {
                (part, part)
            } else {
                (part.min(*parts & 15), part.max(*parts >> 4))
            };
            *parts = low | high << 4;
        }
        self.range = if anew { range } else { self.range.min(range) };
    }

    /// Least and greatest coordinate along x and y from the first corner of the column, in parts.
    pub(crate) fn sides(self) -> [[i32; 2]; 2] {
        self.parts
            .map(|parts| [i32::from(parts & 15), i32::from(parts >> 4) + 1])
    }
}

#[cfg(test)]
mod tests {
    use super::{Extent, PARTS};
    use crate::tuning::grid::CELL;

    fn at(x: f64, y: f64) -> [f64; 3] {
        [x * CELL, y * CELL, 3.0]
    }

    #[test]
    fn the_box_holds_the_hits_of_about_one_range() {
        let mut extent = Extent::FULL;
        assert_eq!(extent.sides(), [[0, PARTS]; 2]);
        // The column begins at (-2, 5) voxels.
        extent.take(&at(-1.5, 5.25), 20.0);
        assert_eq!(extent.sides(), [[8, 9], [4, 5]]);
        extent.take(&at(-1.25, 5.01), 18.0);
        assert_eq!(extent.sides(), [[8, 13], [0, 5]]);
        // From much farther, and from much closer.
        extent.take(&at(-1.99, 5.99), 40.0);
        assert_eq!(extent.sides(), [[8, 13], [0, 5]]);
        extent.take(&at(-1.1, 5.5), 10.0);
        assert_eq!(extent.sides(), [[14, 15], [8, 9]]);
    }
}
