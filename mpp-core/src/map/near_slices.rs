//! Distances in a slice of the field in space, from the occupied columns of the slices within reach.

use super::extent::{Extent, PARTS};
use super::upright::{Column, FARTHEST, HEIGHT, REACH, UNITS};

/// Length of the window along x, and its width along y, in voxels. The height is that of the map.
pub(crate) const LENGTH: usize = 96;
pub(super) const WIDTH: usize = 64;
/// Square of a distance beyond the reach, in parts of a voxel.
const FAR: u16 = (REACH * PARTS * REACH * PARTS) as u16;
/// The distance of each square, rounded.
static ROOTS: [u8; FAR as usize + 1] = {
    let mut roots = [0; FAR as usize + 1];
    let (mut square, mut root) = (0, 0);
    while square < roots.len() {
        // The next one is nearer: twice the root, and 1, is at most four times the distance in units.
        while (2 * root + 1) * (2 * root + 1) <= 4 * UNITS * UNITS * square as u32 {
            root += 1;
        }
        roots[square] = root as u8;
        square += 1;
    }
    roots
};
const _: () = assert!(ROOTS[FAR as usize] == FARTHEST);

/// Squares of the distances of a column, two in a word.
type Pairs = [u32; HEIGHT / 2];
/// Slices within reach of one, with it.
const NEAR: usize = 2 * REACH as usize + 1;
const NO_HIT: u32 = (FAR as u32) << 16 | FAR as u32;
/// The top bits of a pair. Those of the least squares so far are set.
const TOPS: u32 = 0x8000_8000;
const _: () = assert!(2 * (FAR as u32) < 0x8000);

/// Squared distances along the occupied columns of the slices within reach of the one that is measured: each serves them all.
#[derive(Clone, Debug)]
pub(crate) struct NearSlices {
    heights: [[Pairs; WIDTH]; NEAR],
    /// Occupied columns: a bit for each row.
    columns: [u64; NEAR],
    /// Least squared distances in the slice that is measured, and the rows that have any within reach.
    squares: [Pairs; WIDTH],
    met: u64,
}
const _: () = assert!(WIDTH == 64);

impl NearSlices {
    pub(crate) const ZEROS: Self = Self {
        heights: [[[0; HEIGHT / 2]; WIDTH]; NEAR],
        columns: [0; NEAR],
        squares: [[0; HEIGHT / 2]; WIDTH],
        met: 0,
    };

    /// Computes the squared distances along the occupied columns of a slice that comes within reach.
    pub(super) fn enter(
        &mut self,
        slice: usize,
        columns: &[u32; WIDTH],
        unknown: &[u32; WIDTH],
        extents: &[Extent; WIDTH],
    ) {
        let (Some(heights), Some(occupied)) = (
            self.heights.get_mut(slice % NEAR),
            self.columns.get_mut(slice % NEAR),
        ) else {
            return;
        };
        *occupied = 0;
        let columns = columns.iter().zip(unknown).zip(extents).zip(heights);
        for (row, (((column, unknown), extent), heights)) in columns.enumerate() {
            if *column != 0 {
                *occupied |= 1 << row;
                *heights = along_column(*column, !(column | unknown), *extent);
            }
        }
    }

    /// Computes the distances in a slice. All slices within reach have [entered](Self::enter).
    // Not inlined, so that its numbers stay in registers.
    #[inline(never)]
    pub(super) fn measure(
        &mut self,
        slice: usize,
        extents: &[[Extent; WIDTH]; LENGTH],
        distances: &mut [Column; WIDTH],
    ) {
        let Self {
            heights,
            columns,
            squares,
            met,
        } = self;
        *met = 0;
        for (offset, from) in around(slice, LENGTH) {
            let (Some(extents), Some(heights), Some(columns)) = (
                extents.get(from),
                heights.get(from % NEAR),
                columns.get(from % NEAR),
            ) else {
                continue;
            };
            for row in bits(*columns) {
                let (Some(extent), Some(heights)) = (extents.get(row), heights.get(row)) else {
                    continue;
                };
                let sides = extent.sides();
                // The slice lies on the other side of the column.
                let ahead = off(-offset, sides[0]);
                if ahead * ahead >= i32::from(FAR) {
                    continue;
                }
                let first = row.saturating_sub(REACH as usize);
                let rows = squares.get_mut(first..(row + REACH as usize + 1).min(WIDTH));
                for (to, squares) in (first..).zip(rows.unwrap_or(&mut [])) {
                    let right = off(to as i32 - row as i32, sides[1]);
                    let square = ahead * ahead + right * right;
                    if square < i32::from(FAR) {
                        if *met >> to & 1 == 0 {
                            *met |= 1 << to;
                            *squares = [NO_HIT | TOPS; HEIGHT / 2];
                        }
                        lower(squares, heights, square as u32);
                    }
                }
            }
        }
        for (row, (distances, squares)) in distances.iter_mut().zip(squares).enumerate() {
            if *met >> row & 1 == 0 {
                *distances = [FARTHEST; HEIGHT];
                continue;
            }
            let pairs = distances.as_chunks_mut::<2>().0.iter_mut();
            for (distances, pair) in pairs.zip(squares) {
                *distances = [*pair & 0x7fff, *pair >> 16 & 0x7fff].map(|square| {
                    let root = ROOTS.get(square as usize);
                    root.copied().unwrap_or(FARTHEST)
                });
            }
        }
    }
}

/// Squared distances of the centres of voxels along z.
fn along_column(occupied: u32, free: u32, extent: Extent) -> Pairs {
    const NONE: i32 = (REACH + HEIGHT as i32) * PARTS;
    let mut distances = [0; HEIGHT];
    let mut top = -NONE;
    for (z, distance) in distances.iter_mut().enumerate() {
        let bottom = z as i32 * PARTS;
        *distance = bottom + PARTS / 2 - top;
        if occupied >> z & 1 == 1 {
            let sides = extent.height(z, free);
            (*distance, top) = (off(0, sides), bottom + sides[1]);
        }
    }
    let mut above = 2 * NONE;
    for (z, distance) in distances.iter_mut().enumerate().rev() {
        let bottom = z as i32 * PARTS;
        if occupied >> z & 1 == 1 {
            let [low, _] = extent.height(z, free);
            above = bottom + low;
        } else {
            *distance = (*distance).min(above - bottom - PARTS / 2);
        }
    }
    let square = |distance: i32| {
        if distance < REACH * PARTS {
            (distance * distance) as u32
        } else {
            u32::from(FAR)
        }
    };
    let pairs = distances.as_chunks::<2>().0;
    let mut squares = [0; HEIGHT / 2];
    for (squares, [even, odd]) in squares.iter_mut().zip(pairs) {
        *squares = square(*even) | square(*odd) << 16;
    }
    squares
}

/// The places within reach of one, with their distances from it in voxels.
fn around(at: usize, length: usize) -> impl Iterator<Item = (i32, usize)> {
    (-REACH..=REACH).filter_map(move |offset| {
        let to = usize::try_from(at as i32 + offset).ok()?;
        (to < length).then_some((offset, to))
    })
}

/// Distance of the centre of a voxel from the sides of another one, `offset` voxels before it, in parts.
fn off(offset: i32, [low, high]: [i32; 2]) -> i32 {
    let centre = offset * PARTS + PARTS / 2;
    (low - centre).max(centre - high).max(0)
}

/// The places of the bits that are set.
fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let place = word.trailing_zeros() as usize;
        word &= word.wrapping_sub(1);
        (place < WIDTH).then_some(place)
    })
}

/// Lowers squares to those of another column with `square` added, if they are less. No sum reaches [`TOPS`], so pairs are
/// compared at once.
// Not inlined, so that its numbers stay in registers.
#[inline(never)]
fn lower(to: &mut Pairs, from: &Pairs, square: u32) {
    let both = square << 16 | square;
    for (to, from) in to.iter_mut().zip(from) {
        // The top bit stays where the other one is not greater.
        let more = *to - both - from;
        let tops = more & TOPS;
        *to -= more & (tops - (tops >> 15));
    }
}
