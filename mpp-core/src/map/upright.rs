//! A vertical line through the distance field in space, to ask at many heights.

use super::extent::{PART, PARTS};
use super::voxels::CELLS;
use super::walk::voxel;
use crate::tuning::grid::CELL;

/// Greatest distance that the field tells, in voxels: 3 m. In units it is the distance of what is farther, too.
pub(super) const REACH: i32 = 6;
pub(super) const FARTHEST: u8 = (REACH * PARTS) as u8 * UNITS as u8;
/// Unit of distances \[m\], and how many of them are a part of a voxel.
pub(super) const UNIT: f64 = PART / UNITS as f64;
pub(super) const UNITS: u32 = 2;
/// Number of voxels above each other.
pub(super) const HEIGHT: usize = CELLS[2];
/// Distances of the centres of voxels above each other, in units of the field.
pub(super) type Column = [u8; HEIGHT];
/// The columns of centres around a point: by x, then by y.
pub(super) type Around<'a> = [[&'a Column; 2]; 2];
/// A column far from all hits.
pub(super) static FAR_COLUMN: Column = [FARTHEST; HEIGHT];

/// A vertical line, and the distance that counts as clear.
pub(crate) struct Upright<'a> {
    pub(super) around: Around<'a>,
    /// Place of the line among the columns around it [-].
    pub(super) share: [f64; 2],
    /// Voxels that nobody has seen: a bit for each z.
    pub(super) unknown: u32,
    pub(super) needed: u8,
}

/// A height, and its place on every line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Storey {
    /// The centre below, and the share of the way to the next one [-].
    centre: usize,
    share: f64,
    voxel: usize,
}

impl Storey {
    pub(crate) const ZERO: Self = Self {
        centre: 0,
        share: 0.0,
        voxel: 0,
    };

    /// Of a height \[m\], in a window that begins at a z, in voxels.
    pub(super) fn of(z: f64, floor: i64) -> Self {
        let (centre, share) = along(z / CELL - 0.5 - floor as f64, HEIGHT);
        Self {
            centre,
            share,
            voxel: (voxel(z) - floor).max(0).min(HEIGHT as i64 - 1) as usize,
        }
    }
}

impl Upright<'_> {
    /// Whether the point at a height is clear, as far as one voxel tells.
    pub(crate) fn is_clear(&self, at: &Storey) -> bool {
        let [[column, _], _] = self.around;
        (column.get(at.centre)).is_some_and(|distance| *distance >= self.needed)
    }

    /// Whether all points are clear, as far as twice the unit tells: four centres at once.
    pub(crate) fn is_all_clear(&self) -> bool {
        const HIGH: u32 = 0x8080_8080;
        let [[column, _], _] = self.around;
        let up_to_high = u32::from_le_bytes([0x80 - self.needed.div_ceil(2); 4]);
        (column.as_chunks().0.iter()).all(|four| {
            let halves = u32::from_le_bytes(*four) >> 1 & !HIGH;
            (halves + up_to_high) & HIGH == HIGH
        })
    }

    /// Whether nobody has seen the voxel at some height.
    pub(crate) fn has_unknown(&self) -> bool {
        self.unknown != 0
    }

    /// Distance of the point at a height \[m\].
    pub(crate) fn clearance(&self, at: &Storey) -> f64 {
        let [x, y] = self.share;
        mixed(&self.around, at.centre, [x, y, at.share]).0
    }

    /// Whether nobody has seen the voxel at a height.
    pub(crate) fn is_unknown(&self, at: &Storey) -> bool {
        self.unknown >> at.voxel & 1 == 1
    }
}

/// The distance \[m\] at a place among the eight centres around it, the lower ones at `z`, and its slopes by x, y and z a voxel.
pub(super) fn mixed(around: &Around<'_>, z: usize, share: [f64; 3]) -> (f64, [f64; 3]) {
    // Value and slopes along z, then y, then x.
    let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
    let column = |column: &Column| {
        let pair = column.get(z..).and_then(|column| column.first_chunk());
        let [below, above] = pair
            .unwrap_or(&[FARTHEST; 2])
            .map(|at| UNIT * f64::from(at));
        [mix(below, above, share[2]), above - below]
    };
    let [from, to] = around.map(|columns| {
        let [[near, near_up], [far, far_up]] = columns.map(column);
        [
            mix(near, far, share[1]),
            far - near,
            mix(near_up, far_up, share[1]),
        ]
    });
    let [value, right, up] = core::array::from_fn(|index| mix(from[index], to[index], share[0]));
    (value, [to[0] - from[0], right, up])
}

/// The voxel below a coordinate in voxels, with a next one above it, and the share of the way to that \[-\].
pub(super) fn along(at: f64, length: usize) -> (usize, f64) {
    // Positive, so the whole part is the floor.
    let inside = at.max(0.0).min(length as f64 - 1.001);
    let low = inside as usize;
    (low, inside - low as f64)
}
