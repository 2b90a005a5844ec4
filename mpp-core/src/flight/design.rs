//! Values that a flight loop keeps unchanged from its start, for checks against copies.

use super::FlightLoop;
use crate::control::Lqr;
use crate::estimate::EstimatorDesign;
use crate::vehicle::Trim;

/// Those values of a flight loop that no step changes and that a check compares with copies: the regulator's gain, the
/// trim, `cross_track` and `airspeed_hold` of the settings, and an [`EstimatorDesign`], which says what it leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Design {
    estimator: EstimatorDesign,
    lqr: Lqr,
    trim: Trim,
    cross_track: f64,
    airspeed_hold: f64,
}

impl FlightLoop {
    /// The values as they are in memory now.
    #[must_use]
    pub fn design(&self) -> Design {
        Design {
            estimator: self.estimator.design(),
            lqr: self.lqr,
            trim: self.trim,
            cross_track: self.cross_track,
            airspeed_hold: self.airspeed_hold,
        }
    }

    /// Whether the values in memory now are these.
    #[must_use]
    pub fn has(&self, design: &Design) -> bool {
        self.estimator.has(&design.estimator)
            && self.lqr == design.lqr
            && self.trim == design.trim
            && self.cross_track.to_bits() == design.cross_track.to_bits()
            && self.airspeed_hold.to_bits() == design.airspeed_hold.to_bits()
    }

    /// Puts values back that have changed in memory by themselves.
    pub fn restore(&mut self, design: &Design) {
        self.estimator.restore(&design.estimator);
        self.lqr = design.lqr;
        self.trim = design.trim;
        self.cross_track = design.cross_track;
        self.airspeed_hold = design.airspeed_hold;
    }
}
