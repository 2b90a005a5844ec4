//! Values that the estimators keep unchanged from their start, for checks against copies.

use super::Estimator;
use crate::estimate::EkfTuning;
use crate::vehicle::{ActuatorLimits, Airframe};

/// Those values of the estimators that no step changes and that a check compares with copies: the airframe, the limits of
/// the actuators, the tuning of the filter, and the change of the wind that it assumes.
///
/// No copies exist of what the parts derive from the settings at their start: the airframe and the greatest offset of
/// [`LiftEstimator`](crate::estimate::LiftEstimator), the numbers of the aircraft in [`ElevatorEffect`](crate::estimate::ElevatorEffect),
/// [`MotorWatch`](crate::estimate::MotorWatch) and [`AirspeedBias`](crate::estimate::AirspeedBias), the periods of [`SensorMonitor`](crate::estimate::SensorMonitor), and
/// [`LaggedEkf::follows`](crate::estimate::LaggedEkf::follows). The check does not notice a bit that flips there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimatorDesign {
    airframe: Airframe,
    limits: ActuatorLimits,
    filter: EkfTuning,
    wind_change: Option<f64>,
}

impl Estimator {
    /// The values of [`EstimatorDesign`] as they are in memory now.
    #[must_use]
    pub fn design(&self) -> EstimatorDesign {
        EstimatorDesign {
            airframe: self.airframe,
            limits: *self.actuators.limits(),
            filter: *self.air.tuning(),
            wind_change: self.navigation.wind_change(),
        }
    }

    /// Whether the values in memory now are these.
    #[must_use]
    pub fn has(&self, design: &EstimatorDesign) -> bool {
        self.airframe == design.airframe
            && *self.actuators.limits() == design.limits
            && *self.air.tuning() == design.filter
            && self.navigation.wind_change() == design.wind_change
    }

    /// Puts values back that have changed in memory by themselves.
    pub fn restore(&mut self, design: &EstimatorDesign) {
        self.airframe = design.airframe;
        self.actuators.set_limits(design.limits);
        self.air.set_tuning(design.filter);
        self.navigation.set_wind_change(design.wind_change);
    }
}
