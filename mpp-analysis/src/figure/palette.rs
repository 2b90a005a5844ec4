//! Colours that mean the same in every picture.

use mpp_sim::outcome::Outcome;
use plotters::style::RGBColor;

/// The reference, or a chosen plan. Everybody can tell this blue from orange.
pub(super) const REFERENCE: RGBColor = RGBColor(0, 114, 178);
/// The flown path.
pub(super) const FLOWN: RGBColor = RGBColor(230, 120, 0);
/// The obstacles.
pub(super) const OBSTACLE: RGBColor = RGBColor(70, 70, 70);
/// What survived, and the goal.
pub(super) const GOOD: RGBColor = RGBColor(28, 122, 62);
/// What failed.
pub(super) const BAD: RGBColor = RGBColor(198, 40, 40);
/// The limits beyond which a flight fails, and the altitude band.
pub(super) const LIMIT: RGBColor = RGBColor(225, 120, 120);
/// The closest approach.
pub(super) const CLOSEST: RGBColor = RGBColor(120, 60, 150);

/// The colour of an outcome.
pub(super) fn of_outcome(outcome: Outcome) -> RGBColor {
    if outcome == Outcome::Survived {
        GOOD
    } else {
        BAD
    }
}
