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
/// Voxels above each other before the heights of one serve another one, too.
pub(super) const STOREYS: usize = 6;
/// Quarters of a voxel: the last one, and the parts of each.
const LAST: u8 = 3;
const QUARTER: i32 = PARTS / 4;

/// Least and greatest x and y of the hits in a column, in parts of a voxel, and quarters of z. One box serves all voxels of the
/// column, because trunks and walls stand: the rings of a scan share what they have seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Extent {
    /// First and last part along x and y: four bits each.
    parts: [u8; 2],
    /// Range of the nearest hit.
    range: u8,
    /// First and last quarter along z: two bits each, two storeys a byte. Where the first one is greater there was no hit.
    heights: [u8; STOREYS / 2],
}

impl Extent {
    /// All of the column.
    pub(crate) const FULL: Self = Self {
        parts: [0xf0; 2],
        range: NEVER,
        heights: [LAST << 4 | LAST; STOREYS / 2],
    };

    /// Takes up a hit from a range \[m\]. One from closer begins anew, and one from farther does not count: it
    /// carries the error of the attitude over a longer arm.
    pub(crate) fn take(&mut self, point: &[f64; 3], range: f64) {
        let range = (range / RANGE).min(f64::from(NEVER - 1)) as u8;
        let (new, old) = (f64::from(range), f64::from(self.range));
        if self.range < NEVER && new * CLOSER > old {
            return;
        }
        let anew = self.range == NEVER || new < CLOSER * old;
        if anew {
            self.heights = Self::FULL.heights;
        }
        let [_, _, z] = point.map(|at| at / CELL);
        let (storey, quarter) = (libm::floor(z), z - libm::floor(z));
        let quarter = ((quarter * f64::from(LAST + 1)) as u8).min(LAST);
        let storey = (storey as i32).rem_euclid(STOREYS as i32) as usize;
        if let Some(pair) = self.heights.get_mut(storey / 2) {
            let shift = storey % 2 * 4;
            let (low, high) = (*pair >> shift & LAST, *pair >> (shift + 2) & LAST);
            let both = quarter.min(low) | quarter.max(high) << 2;
            *pair = *pair & !(15 << shift) | both << shift;
        }
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

    /// Least and greatest coordinate along z from the bottom of a voxel, in parts. They count where the voxel beyond is `free`, a
    /// bit for each z: between the rings of a scan nothing is seen.
    pub(crate) fn height(self, z: usize, free: u32) -> [i32; 2] {
        let (below, above) = (free << 1 >> z & 1 == 1, free >> 1 >> z & 1 == 1);
        if !(below || above) {
            return [0, PARTS];
        }
        let storey = z % STOREYS;
        let pair = self.heights.get(storey / 2).copied().unwrap_or(0);
        let both = pair >> (storey % 2 * 4);
        let (low, high) = (both & LAST, both >> 2 & LAST);
        let shown = low <= high;
        [
            if shown && below {
                QUARTER * i32::from(low)
            } else {
                0
            },
            if shown && above {
                QUARTER * i32::from(high + 1)
            } else {
                PARTS
            },
        ]
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
        extent.take(&at(-1.25, 5.01), 19.5);
        assert_eq!(extent.sides(), [[8, 13], [0, 5]]);
        // From farther, and from closer.
        extent.take(&at(-1.99, 5.99), 40.0);
        assert_eq!(extent.sides(), [[8, 13], [0, 5]]);
        extent.take(&at(-1.1, 5.5), 10.0);
        assert_eq!(extent.sides(), [[14, 15], [8, 9]]);
    }

    #[test]
    fn a_side_in_height_counts_where_the_voxel_beyond_is_free() {
        let hit = |z: f64| [0.0, 0.0, z * CELL];
        let mut extent = Extent::FULL;
        assert_eq!(extent.height(7, u32::MAX), [0, PARTS]);
        extent.take(&hit(7.3), 20.0);
        extent.take(&hit(7.6), 20.0);
        let (below, above) = (1 << 6, 1 << 8);
        assert_eq!(extent.height(7, below | above), [4, 12]);
        assert_eq!(extent.height(7, below), [4, PARTS]);
        assert_eq!(extent.height(7, above), [0, 12]);
        // Another voxel has no hit. Those that are six apart share, and the topmost one has none above.
        assert_eq!(extent.height(8, u32::MAX), [0, PARTS]);
        assert_eq!(extent.height(31, u32::MAX), [4, PARTS]);
        // A hit from closer begins anew.
        extent.take(&hit(13.9), 20.0);
        assert_eq!(extent.height(7, u32::MAX), [4, 16]);
        extent.take(&hit(8.1), 10.0);
        assert_eq!(extent.height(7, u32::MAX), [0, PARTS]);
        assert_eq!(extent.height(8, u32::MAX), [0, 4]);
    }
}
