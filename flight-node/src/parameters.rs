//! The parameters of planner and controller: names, ranges, and when they can change.
//!
//! A parameter's number on the link is its place in [`PARAMETERS`]: append only.

use crate::convert;
use hil_protocol::{Configure, ConfigureVerdict, ParameterVerdict, Preset};
use mpp_core::config::TICK_PERIOD;
use mpp_core::settings::{Cruise, Iteration, Settings};

/// A configuration, and the settings that it and later changes of parameters came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuning {
    /// Rates and times of the session.
    pub configure: Configure,
    /// Planner and controller.
    pub settings: Settings,
}

impl Tuning {
    /// What a configuration asks for.
    ///
    /// # Errors
    /// The first thing that is wrong with it.
    pub fn new(configure: &Configure) -> Result<Self, ConfigureVerdict> {
        Ok(Self {
            configure: *configure,
            settings: convert::settings(configure)?,
        })
    }

    /// A parameter's value; none if there is no such parameter, or not with this preset.
    #[must_use]
    pub fn value(&self, parameter: u8) -> Option<f64> {
        let parameter = PARAMETERS.get(usize::from(parameter))?;
        get(parameter.name, self)
    }

    /// The same with one value changed.
    ///
    /// # Errors
    /// Why the value cannot be had.
    pub fn with(
        mut self,
        number: u8,
        value: f64,
        in_flight: bool,
    ) -> Result<Self, ParameterVerdict> {
        let parameter = PARAMETERS
            .get(usize::from(number))
            .filter(|parameter| get(parameter.name, &self).is_some())
            .ok_or(ParameterVerdict::Unknown)?;
        let [least, most] = parameter.range;
        // Not a number is in no range.
        if !(least..=most).contains(&value) {
            return Err(ParameterVerdict::Range);
        }
        let steps = value / parameter.step.unwrap_or(value);
        if parameter.step.is_some() && libm::fabs(steps - libm::round(steps)) > 1e-4 {
            return Err(ParameterVerdict::NotWhole);
        }
        if in_flight && !parameter.in_flight {
            return Err(ParameterVerdict::InFlight);
        }
        let tracked = self.settings.planner.paths == 0;
        let cruise = self.settings.cruise;
        set(parameter.name, &mut self, value);
        // Paths that are tracked as they are, and others, are planned by different cycles.
        if in_flight && tracked != (self.settings.planner.paths == 0) {
            return Err(ParameterVerdict::InFlight);
        }
        // The elevator's range is about the trim that it was told with.
        if self.settings.actuators.elevator_range.is_some() && self.settings.cruise != cruise {
            return Err(ParameterVerdict::SetUp(ConfigureVerdict::Actuators));
        }
        convert::check(&self.configure).map_err(ParameterVerdict::SetUp)?;
        Ok(self)
    }
}

/// One parameter.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// At most 16 characters, as MAVLink has them.
    pub name: &'static str,
    /// Its unit, or what its values are.
    pub unit: &'static str,
    /// Least and greatest value.
    pub range: [f64; 2],
    /// Values are whole multiples of this.
    pub step: Option<f64>,
    /// Whether it can change between two ticks of a flight; its value is then used from the next
    /// planning cycle on. The others are built into the regulator, the estimator or the planner's
    /// model before the flight.
    pub in_flight: bool,
}

/// The table of parameters, and how each is read and written. By name, so that nothing is called
/// through a pointer: the stack stays bounded.
macro_rules! parameters {
    ($count:literal: $(
        $name:literal, $unit:literal, $range:expr, $step:expr, $in_flight:expr,
        |$of:ident| $get:expr, |$to:ident, $value:ident| $set:expr;
    )*) => {
        /// All parameters. Presets differ in which of them they have.
        pub const PARAMETERS: [Parameter; $count] = [$(Parameter {
            name: $name,
            unit: $unit,
            range: $range,
            step: $step,
            in_flight: $in_flight,
        }),*];

        fn get(name: &str, tuning: &Tuning) -> Option<f64> {
            match name {
                $($name => {
                    let $of = tuning;
                    $get
                })*
                _ => None,
            }
        }

        fn set(name: &str, tuning: &mut Tuning, value: f64) {
            match name {
                $($name => {
                    let ($to, $value) = (tuning, value);
                    $set;
                })*
                _ => {}
            }
        }
    };
}

const BEFORE: bool = false;
const ANY_TIME: bool = true;

/// Seconds of a number of ticks.
fn seconds(ticks: u32) -> Option<f64> {
    // Divided, so that it is the nearest number to what a person writes.
    Some(f64::from(ticks) / 100.0)
}

/// The nearest number of ticks.
fn ticks(seconds: f64) -> u32 {
    libm::round(seconds / TICK_PERIOD) as u32
}

/// A value of the rounds of linearisation, if the preset has them.
fn iteration(tuning: &Tuning, get: impl FnOnce(&Iteration) -> f64) -> Option<f64> {
    tuning.settings.planner.iteration.as_ref().map(get)
}

fn change(tuning: &mut Tuning, set: impl FnOnce(&mut Iteration)) {
    if let Some(iteration) = &mut tuning.settings.planner.iteration {
        set(iteration);
    }
}

/// An actuator's limit, if the preset knows of limits; 0 is none.
fn limit(tuning: &Tuning, limit: Option<f64>) -> Option<f64> {
    (tuning.configure.preset == Preset::Flight).then_some(limit.unwrap_or(0.0))
}

fn positive(value: f64) -> Option<f64> {
    (value > 0.0).then_some(value)
}

parameters! { 41:
    "MPP_PATHS", "candidate paths", [0.0, mpp_core::config::MAX_PATHS as f64], Some(1.0), ANY_TIME,
        |tuning| Some(tuning.settings.planner.paths as f64),
        |tuning, value| tuning.settings.planner.paths = value as usize;
    "MPP_REPLAN_S", "s", [0.1, 60.0], Some(TICK_PERIOD), ANY_TIME,
        |tuning| seconds(tuning.configure.replan_period_ticks),
        |tuning, value| tuning.configure.replan_period_ticks = ticks(value);
    "MPP_LATENCY_S", "s", [0.01, 60.0], Some(TICK_PERIOD), ANY_TIME,
        |tuning| seconds(tuning.configure.latency_ticks),
        |tuning, value| tuning.configure.latency_ticks = ticks(value);
    "MPP_SLICES", "slices a tick; 0: all", [0.0, 1e6], Some(1.0), ANY_TIME,
        |tuning| match tuning.configure.slices_per_tick {
            u32::MAX => Some(0.0),
            slices => Some(f64::from(slices)),
        },
        |tuning, value| {
            tuning.configure.slices_per_tick = match value as u32 {
                0 => u32::MAX,
                slices => slices,
            };
        };
    "MPP_ALT_M", "m", [0.0, 1000.0], None, ANY_TIME,
        |tuning| Some(tuning.settings.planner.altitude),
        |tuning, value| tuning.settings.planner.altitude = value;
    "MPP_PAD_NEAR_M", "m", [0.0, 10.0], None, ANY_TIME,
        |tuning| Some(tuning.settings.planner.padding.near),
        |tuning, value| tuning.settings.planner.padding.near = value;
    "MPP_PAD_FAR_M", "m", [0.0, 10.0], None, ANY_TIME,
        |tuning| Some(tuning.settings.planner.padding.far),
        |tuning, value| tuning.settings.planner.padding.far = value;
    "MPP_ALPHA_LIM", "rad", [0.02, 0.5], None, ANY_TIME,
        |tuning| tuning.settings.planner.attitude.map(|owner| owner.angle_of_attack),
        |tuning, value| if let Some(owner) = &mut tuning.settings.planner.attitude { owner.angle_of_attack = value; };
    "MPP_GAMMA_LIM", "rad", [0.05, 0.78], None, ANY_TIME,
        |tuning| tuning.settings.planner.attitude.map(|owner| owner.flight_path),
        |tuning, value| if let Some(owner) = &mut tuning.settings.planner.attitude { owner.flight_path = value; };
    "MPP_PEN_LIN", "1/m", [1e-3, 1e8], None, ANY_TIME,
        |tuning| tuning.settings.planner.penalty.map(|owner| owner.linear),
        |tuning, value| if let Some(owner) = &mut tuning.settings.planner.penalty { owner.linear = value; };
    "MPP_PEN_QUAD", "1/m^2", [1e-3, 1e8], None, ANY_TIME,
        |tuning| tuning.settings.planner.penalty.map(|owner| owner.quadratic),
        |tuning, value| if let Some(owner) = &mut tuning.settings.planner.penalty { owner.quadratic = value; };
    "MPP_W_ELEVATOR", "1", [1e-3, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.planner.weights.control[0]),
        |tuning, value| tuning.settings.planner.weights.control[0] = value;
    "MPP_W_THRUST", "1/N^2", [1e-3, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.planner.weights.control[1]),
        |tuning, value| tuning.settings.planner.weights.control[1] = value;
    "MPP_W_TERMINAL", "1", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.planner.weights.terminal),
        |tuning, value| tuning.settings.planner.weights.terminal = value;
    "MPP_CRUISE_MS", "m/s", [8.0, 20.0], None, BEFORE,
        |tuning| match tuning.settings.cruise {
            Cruise::Airspeed(airspeed) => Some(airspeed),
            Cruise::Authors => None,
        },
        |tuning, value| tuning.settings.cruise = Cruise::Airspeed(value);
    "LQR_THRUST_N", "N", [0.0, 50.0], None, BEFORE,
        |tuning| tuning.settings.design_thrust,
        |tuning, value| tuning.settings.design_thrust = Some(value);
    "LQR_Q_SPEED", "s^2/m^2", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.state[0]),
        |tuning, value| tuning.settings.regulator.state[0] = value;
    "LQR_Q_PITCH", "1/rad^2", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.state[1]),
        |tuning, value| tuning.settings.regulator.state[1] = value;
    "LQR_Q_RATE", "s^2/rad^2", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.state[2]),
        |tuning, value| tuning.settings.regulator.state[2] = value;
    "LQR_Q_PATH", "1/rad^2", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.state[3]),
        |tuning, value| tuning.settings.regulator.state[3] = value;
    "LQR_R_ELEVATOR", "1", [1e-3, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.elevator),
        |tuning, value| tuning.settings.regulator.elevator = value;
    "EKF_Q_SPEED", "m^2/s^2", [0.0, 100.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.process_noise[0]),
        |tuning, value| tuning.settings.estimator.process_noise[0] = value;
    "EKF_Q_PITCH", "rad^2", [0.0, 10.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.process_noise[1]),
        |tuning, value| tuning.settings.estimator.process_noise[1] = value;
    "EKF_Q_RATE", "rad^2/s^2", [0.0, 10.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.process_noise[2]),
        |tuning, value| tuning.settings.estimator.process_noise[2] = value;
    "EKF_Q_PATH", "rad^2", [0.0, 10.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.process_noise[3]),
        |tuning, value| tuning.settings.estimator.process_noise[3] = value;
    "EKF_R_SPEED", "m^2/s^2", [1e-9, 100.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.airspeed_variance),
        |tuning, value| tuning.settings.estimator.airspeed_variance = value;
    "EKF_R_PITCH", "rad^2", [1e-9, 10.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.pitch_variance),
        |tuning, value| tuning.settings.estimator.pitch_variance = value;
    "EKF_P_START", "-", [1e-9, 10.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.initial_variance),
        |tuning, value| tuning.settings.estimator.initial_variance = value;
    "EKF_GATE", "standard deviations", [1.0, 1000.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.gate),
        |tuning, value| tuning.settings.estimator.gate = value;
    "LQR_CROSS_TRACK", "rad/m", [0.0, 1.0], None, BEFORE,
        |tuning| Some(tuning.settings.cross_track),
        |tuning, value| tuning.settings.cross_track = value;
    "MPP_ROUNDS", "rounds of linearisation", [1.0, 20.0], Some(1.0), BEFORE,
        |tuning| iteration(tuning, |iteration| f64::from(iteration.rounds)),
        |tuning, value| change(tuning, |iteration| iteration.rounds = value as u8);
    "MPP_DEEPENED", "candidates", [0.0, mpp_core::config::MAX_PATHS as f64], Some(1.0), BEFORE,
        |tuning| iteration(tuning, |iteration| iteration.deepened as f64),
        |tuning, value| change(tuning, |iteration| iteration.deepened = value as usize);
    "MPP_MARGIN_M", "m", [0.1, 5.0], None, BEFORE,
        |tuning| iteration(tuning, |iteration| iteration.margin),
        |tuning, value| change(tuning, |iteration| iteration.margin = value);
    "MPP_BAND_M", "m", [2.0, 100.0], None, BEFORE,
        |tuning| iteration(tuning, |iteration| iteration.band),
        |tuning, value| change(tuning, |iteration| iteration.band = value);
    "MPP_THRUST_N", "N", [1.0, 100.0], None, BEFORE,
        |tuning| iteration(tuning, |iteration| iteration.thrust_max),
        |tuning, value| change(tuning, |iteration| iteration.thrust_max = value);
    "WIND_TC_S", "s", [0.01, 60.0], None, BEFORE,
        |tuning| tuning.settings.wind,
        |tuning, value| tuning.settings.wind = Some(value);
    "ACT_THRUST_N", "N; 0: no limit", [0.0, 1000.0], None, BEFORE,
        |tuning| limit(tuning, tuning.settings.actuators.thrust_max),
        |tuning, value| tuning.settings.actuators.thrust_max = positive(value);
    "ACT_THRUST_LAG_S", "s; 0: none", [0.0, 10.0], None, BEFORE,
        |tuning| limit(tuning, tuning.settings.actuators.thrust_lag),
        |tuning, value| tuning.settings.actuators.thrust_lag = positive(value);
    "ACT_ELEV_RANGE", "either side of trim; 0: no limit", [0.0, 100.0], None, BEFORE,
        |tuning| limit(tuning, tuning.settings.actuators.elevator_range),
        |tuning, value| tuning.settings.actuators.elevator_range = positive(value);
    "ACT_ELEV_RATE", "1/s; 0: no limit", [0.0, 1000.0], None, BEFORE,
        |tuning| limit(tuning, tuning.settings.actuators.elevator_rate),
        |tuning, value| tuning.settings.actuators.elevator_rate = positive(value);
    "THR_SPEED_GAIN", "N s/m", [0.0, 100.0], None, BEFORE,
        |tuning| Some(tuning.settings.airspeed_hold),
        |tuning, value| tuning.settings.airspeed_hold = value;
}
