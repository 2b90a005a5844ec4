//! Points of the grid.

use crate::paper::config::{ORIGIN_COL, ORIGIN_ROW};

/// A point in grid coordinates \[m\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridPoint {
    /// Height above the low edge of the grid.
    pub row: f64,
    /// Distance from the near edge of the grid.
    pub col: f64,
}

impl GridPoint {
    /// Position of the aircraft.
    pub const AIRCRAFT: Self = Self {
        row: ORIGIN_ROW as f64,
        col: ORIGIN_COL as f64,
    };

    /// Distance to another point \[m\].
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let (row, col) = (self.row - other.row, self.col - other.col);
        libm::sqrt(row * row + col * col)
    }

    /// The point at a share (0 to 1) of the way to `other`.
    #[must_use]
    pub fn towards(&self, other: &Self, share: f64) -> Self {
        Self {
            row: self.row * (1.0 - share) + other.row * share,
            col: self.col * (1.0 - share) + other.col * share,
        }
    }
}
