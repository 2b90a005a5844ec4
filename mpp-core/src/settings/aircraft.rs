//! The settings of preset `flight` for any aircraft, by similarity to the reference aircraft.

use super::{Cruise, Method, PlaneSettings, PlannerSettings, Settings};
use crate::control::LqrWeights;
use crate::estimate::EkfTuning;
use crate::qp::Weights;
use crate::units::Units;
use crate::vehicle::Trim;
use mpp_data::{ActuatorLimits, Aircraft};

impl Settings {
    /// Preset `flight` for an aircraft with these limits of its actuators. Tuned lengths, times and weights are those of the reference aircraft,
    /// in the units of this one.
    #[must_use]
    pub fn flight_of(aircraft: &Aircraft, actuators: &ActuatorLimits) -> Self {
        let base = Self::flight();
        let units = Units::of(aircraft.cruise, aircraft.airframe.mass);
        let (angle, elevator) = (aircraft.angle_unit(), aircraft.elevator_unit());
        let speed = units.speed();
        let (speed_squared, time_squared) = (speed * speed, units.time * units.time);
        let [v, pitch, rate, path] = base.regulator.state;
        let [v_noise, pitch_noise, rate_noise, path_noise] = base.estimator.process_noise;
        let [turn, thrust] = base.planner.weights.control;
        let own = PlaneSettings::PRESET;
        // Plans of an aircraft for whose level flight the preset's thrust is too low may use all of its motor.
        let level = Trim::at_speed(&aircraft.airframe, aircraft.cruise, 0.0);
        let level = level.map_or(0.0, |trim| trim.control.thrust);
        let plans = own.thrust_max * units.force();
        let motor = actuators.thrust_max.filter(|_| plans < level);
        Self {
            units,
            airframe: aircraft.airframe,
            actuators: *actuators,
            cruise: Cruise::Airspeed(aircraft.cruise),
            estimator: EkfTuning {
                process_noise: [
                    v_noise * speed_squared,
                    pitch_noise,
                    rate_noise / time_squared,
                    path_noise,
                ],
                ..base.estimator
            },
            // A wind that changes at random has a standard deviation that grows with the root of time.
            wind_change: (base.wind_change).map(|change| change * speed / libm::sqrt(units.time)),
            regulator: LqrWeights {
                state: [v / speed_squared, pitch, rate * time_squared, path],
                elevator: base.regulator.elevator / (elevator * elevator),
            },
            cross_track: base.cross_track / units.length,
            airspeed_hold: base.airspeed_hold * units.mass / units.time,
            planner: PlannerSettings {
                weights: Weights {
                    control: [turn / (angle * angle), thrust],
                    ..base.planner.weights
                },
                method: Method::Plane(PlaneSettings {
                    attitude: super::AttitudeLimits {
                        angle_of_attack: own.attitude.angle_of_attack * angle,
                        ..own.attitude
                    },
                    stall: aircraft.stall,
                    margin: own.margin * units.length,
                    body_radius: aircraft.body_radius,
                    band: own.band * units.length,
                    thrust_max: motor.unwrap_or(plans),
                    ..own
                }),
                ..base.planner
            },
            ..base
        }
    }
}
