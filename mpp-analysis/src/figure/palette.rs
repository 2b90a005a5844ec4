//! Colours that mean the same in every picture.

use plotters::style::RGBColor;

/// The reference, or a chosen plan. Everybody can tell this blue from orange.
pub(super) const REFERENCE: RGBColor = RGBColor(0, 114, 178);
/// The flown path.
pub(super) const FLOWN: RGBColor = RGBColor(230, 120, 0);
/// The obstacles.
pub(super) const OBSTACLE: RGBColor = RGBColor(70, 70, 70);
