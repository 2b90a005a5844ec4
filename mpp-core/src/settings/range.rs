//! Which number of the settings is outside of its range.

use super::{PlaneSettings, PlannerSettings, Settings};
use crate::config::{MAX_PATHS, STAGE_PERIOD, STAGES};
use crate::units::REFERENCE_CRUISE;
use crate::vehicle::Airframe;
use mpp_data::Setting;

// Ranges that follow from sizes.
const _: () = {
    assert!(Setting::Latency.range()[1].to_bits() == (STAGES as f64 * STAGE_PERIOD).to_bits());
    assert!(Setting::RefinedCandidates.range()[1] as usize == MAX_PATHS);
};

/// The first of these numbers that is outside of its range. A setting that has no value is in range.
fn first(numbers: &[(Setting, Option<f64>)]) -> Option<Setting> {
    let outside = |(setting, number): &&(Setting, Option<f64>)| {
        number.is_some_and(|number| !setting.holds(number))
    };
    numbers.iter().find(outside).map(|(setting, _)| *setting)
}

impl Settings {
    /// The first number that is outside of its range. A number that is not finite is in no range.
    #[must_use]
    pub fn out_of_range(&self) -> Option<Setting> {
        // Ranges further down are relative to cruise and mass, and units follow from them.
        first(&[(Setting::CruiseAirspeed, self.cruise.airspeed())])
            .or_else(|| self.airframe_out_of_range())
            .or_else(|| self.own_out_of_range())
            .or_else(|| self.planner.out_of_range())
    }

    fn airframe_out_of_range(&self) -> Option<Setting> {
        let numbers = self.airframe.numbers();
        let mut numbers = Airframe::SETTINGS.iter().zip(numbers);
        let outside = numbers.find(|(setting, number)| {
            let measure = match setting {
                Setting::MomentElevator => libm::fabs(*number),
                Setting::LiftAlphaRate | Setting::LiftPitchRate => self.share_of_momentum(*number),
                _ => *number,
            };
            !setting.holds(measure)
        });
        outside.map(|(setting, _)| *setting)
    }

    /// The force of lift that a derivative by an angular rate [s/rad] gives at cruise, over the force that turns
    /// the path at this rate [-].
    fn share_of_momentum(&self, per_rate: f64) -> f64 {
        let (a, airspeed) = (&self.airframe, self.cruise.airspeed());
        let airspeed = airspeed.unwrap_or(REFERENCE_CRUISE);
        0.5 * a.air_density * airspeed * a.wing_area * per_rate / a.mass
    }

    fn own_out_of_range(&self) -> Option<Setting> {
        let (units, limits, regulator) = (&self.units, &self.actuators, &self.regulator);
        let estimator = &self.estimator;
        let [speed, pitch, rate, path] = regulator.state;
        let [speed_noise, pitch_noise, rate_noise, path_noise] = estimator.process_noise;
        let plane = self.planner.plane();
        first(&[
            (Setting::LengthUnit, Some(units.length)),
            (Setting::TimeUnit, Some(units.time)),
            (Setting::MassUnit, Some(units.mass)),
            (Setting::MotorThrust, limits.thrust_max),
            (Setting::ThrustLag, limits.thrust_lag),
            (Setting::ElevatorBelow, limits.elevator_below),
            (Setting::ElevatorAbove, limits.elevator_above),
            (Setting::ElevatorRate, limits.elevator_rate),
            (Setting::ElevatorDelay, limits.elevator_delay),
            (Setting::ThrustDelay, limits.thrust_delay),
            (Setting::DesignThrust, self.design_thrust),
            (Setting::SpeedNoise, Some(speed_noise)),
            (Setting::PitchNoise, Some(pitch_noise)),
            (Setting::RateNoise, Some(rate_noise)),
            (Setting::PathNoise, Some(path_noise)),
            (Setting::AirspeedVariance, Some(estimator.airspeed_variance)),
            (Setting::PitchVariance, Some(estimator.pitch_variance)),
            (Setting::InitialVariance, Some(estimator.initial_variance)),
            (Setting::Gate, Some(estimator.gate)),
            (Setting::WindChange, self.wind_change),
            (Setting::SpeedWeight, Some(speed)),
            (Setting::PitchWeight, Some(pitch)),
            (Setting::RateWeight, Some(rate)),
            (Setting::PathWeight, Some(path)),
            (Setting::ElevatorWeight, Some(regulator.elevator)),
            (Setting::CrossTrack, Some(self.cross_track)),
            (Setting::AirspeedHold, Some(self.airspeed_hold)),
            (
                Setting::BodyRadius,
                plane.map(|own| own.body_radius / units.length),
            ),
            (Setting::Latency, plane.map(|own| own.latency / units.time)),
        ])
    }
}

impl PlannerSettings {
    /// The first number that is outside of its range. A number that is not finite is in no range.
    #[must_use]
    pub fn out_of_range(&self) -> Option<Setting> {
        let [elevator, thrust] = self.weights.control;
        first(&[
            (Setting::Altitude, Some(self.altitude)),
            (Setting::PlanElevatorWeight, Some(elevator)),
            (Setting::PlanThrustWeight, Some(thrust)),
            (Setting::PlanTerminalWeight, Some(self.weights.terminal)),
        ])
        .or_else(|| self.plane()?.out_of_range())
        .or_else(|| self.padding_out_of_range())
    }

    #[cfg(feature = "paper")]
    fn padding_out_of_range(&self) -> Option<Setting> {
        let padding = &self.paper()?.padding;
        first(&[
            (Setting::PaddingNear, Some(padding.near)),
            (Setting::PaddingFar, Some(padding.far)),
        ])
    }

    #[cfg(not(feature = "paper"))]
    fn padding_out_of_range(&self) -> Option<Setting> {
        None
    }
}

impl PlaneSettings {
    fn out_of_range(&self) -> Option<Setting> {
        first(&[
            (Setting::Sight, Some(self.sight)),
            (Setting::PenaltyLinear, Some(self.penalty.linear)),
            (Setting::PenaltyQuadratic, Some(self.penalty.quadratic)),
            (
                Setting::AngleOfAttackLimit,
                Some(self.attitude.angle_of_attack),
            ),
            (Setting::FlightPathLimit, Some(self.attitude.flight_path)),
            (Setting::SqpIterations, Some(f64::from(self.sqp_iterations))),
            (
                Setting::RefinedCandidates,
                Some(self.refined_candidates as f64),
            ),
            (Setting::Margin, Some(self.margin)),
            (Setting::Stall, self.stall),
            (Setting::Band, Some(self.band)),
            (Setting::PlanThrust, Some(self.thrust_max)),
        ])
    }
}
