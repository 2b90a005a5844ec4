//! Marks with a shape, so that they can be told apart where colours cannot.

use plotters::style::{RGBColor, WHITE};

/// The size of a mark, from its middle to its corners \[px\].
const SIZE: f64 = 30.0;

/// Offsets from the middle of a mark \[px\].
pub(super) type Offsets = Vec<(i32, i32)>;

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outline {
    Square,
    Triangle,
    Diamond,
    Pentagon,
    /// A cross, which stands for a failure.
    Cross,
    /// A circle of which only the edge is drawn.
    Ring,
}

/// A mark at a place of a panel.
pub(super) struct Mark {
    pub(super) at: (f64, f64),
    pub(super) outline: Outline,
    pub(super) colour: RGBColor,
}

impl Outline {
    /// The shapes that curves have, one after the other.
    const OF_CURVES: [Self; 4] = [Self::Square, Self::Triangle, Self::Diamond, Self::Pentagon];

    /// The shape of a curve of a panel.
    pub(super) fn of_curve(index: usize) -> Self {
        Self::OF_CURVES[index % Self::OF_CURVES.len()]
    }

    /// The edge, which ends where it begins.
    fn edge(self) -> Offsets {
        let (count, turn) = match self {
            Self::Square | Self::Cross => (4, 0.5),
            Self::Triangle => (3, 0.0),
            Self::Diamond => (4, 0.0),
            Self::Pentagon => (5, 0.0),
            Self::Ring => (24, 0.0),
        };
        let corner = |k: i32| {
            let angle = core::f64::consts::TAU * (f64::from(k) + turn) / f64::from(count);
            let (sin, cos) = libm::sincos(angle);
            ((SIZE * sin).round() as i32, (-SIZE * cos).round() as i32)
        };
        (0..=count).map(corner).collect()
    }
}

impl Mark {
    /// The area that is filled, if any.
    pub(super) fn filled(&self) -> Option<Offsets> {
        let hollow = matches!(self.outline, Outline::Cross | Outline::Ring);
        (!hollow).then(|| self.outline.edge())
    }

    /// The lines that are drawn, and their colour. A filled mark has a white edge, so that two that overlap stay two.
    pub(super) fn lines(&self) -> (Vec<Offsets>, RGBColor) {
        let edge = self.outline.edge();
        match self.outline {
            Outline::Cross => {
                let diagonal = |from: usize| vec![edge[from], edge[from + 2]];
                (vec![diagonal(0), diagonal(1)], self.colour)
            }
            Outline::Ring => (vec![edge], self.colour),
            _ => (vec![edge], WHITE),
        }
    }
}
