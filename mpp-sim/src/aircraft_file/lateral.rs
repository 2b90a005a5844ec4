//! The lateral part of an aircraft file: span, inertia, derivatives and surfaces beside those of the vertical plane.

use super::RollLoop;
use crate::file_error::{ScenarioError, ensure};
use mpp_core::vehicle::{Derivatives, LateralAirframe};
use serde::{Deserialize, Serialize};

/// Table `lateral`. Every coefficient is positive to the right, and a positive deflection turns to the right.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lateral {
    /// Where these numbers come from, and which are assumed.
    pub source: String,
    /// Wing span \[m\], the reference length.
    pub span: f64,
    /// Moment of inertia in roll [kg m^2].
    pub roll_inertia: f64,
    /// Moment of inertia in yaw [kg m^2].
    pub yaw_inertia: f64,
    /// Product of inertia `J_xz` [kg m^2].
    pub product_inertia: f64,
    /// Side force.
    pub side: Coefficient,
    /// Rolling moment.
    pub roll: Coefficient,
    /// Yawing moment.
    pub yaw: Coefficient,
    /// Ailerons, or what elevons do as such.
    pub aileron: Surface,
    /// Rudder; a flying wing has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rudder: Option<Surface>,
    /// The roll loop from which this table follows, if the aircraft is behind an autopilot.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roll_loop: Option<RollLoop>,
}

/// Derivatives of one coefficient [1/rad], whatever `derivatives` says; those by rates are of the rate times `span / 2v`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coefficient {
    /// By the sideslip.
    pub sideslip: f64,
    /// By the roll rate.
    pub roll_rate: f64,
    /// By the yaw rate.
    pub yaw_rate: f64,
    /// By the deflection of the aileron.
    pub aileron: f64,
    /// By the deflection of the rudder; only a wing without a rudder leaves it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rudder: Option<f64>,
}

/// A control surface and its servo, which follows its command in first order, or in second order with a `damping`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Greatest deflection to either side \[deg\].
    pub range: f64,
    /// Greatest rate [deg/s].
    pub rate: f64,
    /// Bandwidth of the servo [rad/s].
    pub bandwidth: f64,
    /// Damping ratio of a servo of second order [-].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<f64>,
}

impl Lateral {
    /// The lateral airframe in the form that core and plant know.
    #[must_use]
    pub fn airframe(&self) -> LateralAirframe {
        let derivatives = |of: &Coefficient| Derivatives {
            sideslip: of.sideslip,
            roll_rate: of.roll_rate,
            yaw_rate: of.yaw_rate,
            aileron: of.aileron,
            rudder: of.rudder.unwrap_or(0.0),
        };
        LateralAirframe {
            span: self.span,
            roll_inertia: self.roll_inertia,
            yaw_inertia: self.yaw_inertia,
            product_inertia: self.product_inertia,
            side: derivatives(&self.side),
            roll: derivatives(&self.roll),
            yaw: derivatives(&self.yaw),
        }
    }

    /// Checks what no key shows by itself.
    pub(super) fn check(&self) -> Result<(), ScenarioError> {
        let all = [
            (&self.side, "aircraft.lateral.side.rudder"),
            (&self.roll, "aircraft.lateral.roll.rudder"),
            (&self.yaw, "aircraft.lateral.yaw.rudder"),
        ];
        let has_rudder = self.rudder.is_some();
        for (of, by_rudder) in all {
            let advice =
                "add the table `lateral.rudder`, or leave the derivatives by the rudder out";
            ensure(has_rudder || of.rudder.is_none(), by_rudder, advice)?;
            let advice = "give this derivative, if need be 0: the aircraft has a rudder";
            ensure(!has_rudder || of.rudder.is_some(), by_rudder, advice)?;
        }
        let product = self.product_inertia * self.product_inertia;
        ensure(
            product < self.roll_inertia * self.yaw_inertia,
            "aircraft.lateral.product_inertia",
            "give a number whose square is below roll_inertia times yaw_inertia",
        )
    }
}
