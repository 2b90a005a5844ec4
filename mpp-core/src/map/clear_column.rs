//! A column of the distance field in space, to ask where it is far from all hits.

use super::voxels::CELLS;
use crate::tuning::grid::CELL;

/// A column of the field, and the distance that counts as clear.
pub(crate) struct ClearColumn<'a> {
    /// Distances of the centres of voxels, in units of the field.
    pub(super) distances: Option<&'a [u8; CELLS[2]]>,
    pub(super) needed: u8,
}

impl ClearColumn<'_> {
    /// Whether the point at a height \[m\] is clear.
    pub(crate) fn is_clear(&self, z: f64) -> bool {
        let (z, _) = along(z / CELL - 0.5, CELLS[2]);
        let distance = self.distances.and_then(|distances| distances.get(z));
        distance.is_some_and(|distance| *distance >= self.needed)
    }
}

/// The voxel below a coordinate in voxels, with a next one above it, and the share of the way to that \[-\].
pub(super) fn along(at: f64, length: usize) -> (usize, f64) {
    // Positive, so the whole part is the floor.
    let inside = at.max(0.0).min(length as f64 - 1.001);
    let low = inside as usize;
    (low, inside - low as f64)
}
