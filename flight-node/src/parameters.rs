//! The parameters of planner and controller: names, ranges, and when they can change.
//!
//! A parameter's number on the link is its place in [`PARAMETERS`]: append only.

use crate::convert;
use hil_protocol::{Configure, ConfigureVerdict, ParameterVerdict};
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
        (parameter.get)(self)
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
            .filter(|parameter| (parameter.get)(&self).is_some())
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
        (parameter.set)(&mut self, value);
        // Paths that are tracked as they are, and others, are planned by different cycles.
        if in_flight && tracked != (self.settings.planner.paths == 0) {
            return Err(ParameterVerdict::InFlight);
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
    get: fn(&Tuning) -> Option<f64>,
    set: fn(&mut Tuning, f64),
}

/// A parameter that is a number of the settings.
macro_rules! number {
    ($name:literal, $unit:literal, $range:expr, $in_flight:expr, $($field:ident $([$index:literal])?).+) => {
        Parameter {
            name: $name,
            unit: $unit,
            range: $range,
            step: None,
            in_flight: $in_flight,
            get: |tuning| Some(tuning.settings.$($field $([$index])?).+),
            set: |tuning, value| tuning.settings.$($field $([$index])?).+ = value,
        }
    };
}

/// A parameter that only some presets have.
macro_rules! optional {
    ($name:literal, $unit:literal, $range:expr, $owner:ident, $field:ident) => {
        Parameter {
            name: $name,
            unit: $unit,
            range: $range,
            step: None,
            in_flight: true,
            get: |tuning| tuning.settings.planner.$owner.map(|owner| owner.$field),
            set: |tuning, value| {
                if let Some(owner) = &mut tuning.settings.planner.$owner {
                    owner.$field = value;
                }
            },
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
fn iteration(tuning: &Tuning, get: fn(&Iteration) -> f64) -> Option<f64> {
    tuning.settings.planner.iteration.as_ref().map(get)
}

fn change(tuning: &mut Tuning, set: impl FnOnce(&mut Iteration)) {
    if let Some(iteration) = &mut tuning.settings.planner.iteration {
        set(iteration);
    }
}

/// All parameters. Presets differ in which of them they have.
pub const PARAMETERS: [Parameter; 35] = [
    Parameter {
        name: "MPP_PATHS",
        unit: "candidate paths",
        range: [0.0, mpp_core::config::MAX_PATHS as f64],
        step: Some(1.0),
        in_flight: ANY_TIME,
        get: |tuning| Some(tuning.settings.planner.paths as f64),
        set: |tuning, value| tuning.settings.planner.paths = value as usize,
    },
    Parameter {
        name: "MPP_REPLAN_S",
        unit: "s",
        range: [0.1, 60.0],
        step: Some(TICK_PERIOD),
        in_flight: ANY_TIME,
        get: |tuning| seconds(tuning.configure.replan_period_ticks),
        set: |tuning, value| tuning.configure.replan_period_ticks = ticks(value),
    },
    Parameter {
        name: "MPP_LATENCY_S",
        unit: "s",
        range: [0.01, 60.0],
        step: Some(TICK_PERIOD),
        in_flight: ANY_TIME,
        get: |tuning| seconds(tuning.configure.latency_ticks),
        set: |tuning, value| tuning.configure.latency_ticks = ticks(value),
    },
    Parameter {
        name: "MPP_SLICES",
        unit: "slices a tick; 0: all",
        range: [0.0, 1e6],
        step: Some(1.0),
        in_flight: ANY_TIME,
        get: |tuning| match tuning.configure.slices_per_tick {
            u32::MAX => Some(0.0),
            slices => Some(f64::from(slices)),
        },
        set: |tuning, value| {
            tuning.configure.slices_per_tick = match value as u32 {
                0 => u32::MAX,
                slices => slices,
            };
        },
    },
    number!("MPP_ALT_M", "m", [0.0, 1000.0], ANY_TIME, planner.altitude),
    number!(
        "MPP_PAD_NEAR_M",
        "m",
        [0.0, 10.0],
        ANY_TIME,
        planner.padding.near
    ),
    number!(
        "MPP_PAD_FAR_M",
        "m",
        [0.0, 10.0],
        ANY_TIME,
        planner.padding.far
    ),
    optional!(
        "MPP_ALPHA_LIM",
        "rad",
        [0.02, 0.5],
        attitude,
        angle_of_attack
    ),
    optional!("MPP_GAMMA_LIM", "rad", [0.05, 0.78], attitude, flight_path),
    optional!("MPP_PEN_LIN", "1/m", [1e-3, 1e8], penalty, linear),
    optional!("MPP_PEN_QUAD", "1/m^2", [1e-3, 1e8], penalty, quadratic),
    number!(
        "MPP_W_ELEVATOR",
        "1",
        [1e-3, 1e6],
        BEFORE,
        planner.weights.control[0]
    ),
    number!(
        "MPP_W_THRUST",
        "1/N^2",
        [1e-3, 1e6],
        BEFORE,
        planner.weights.control[1]
    ),
    number!(
        "MPP_W_TERMINAL",
        "1",
        [0.0, 1e6],
        BEFORE,
        planner.weights.terminal
    ),
    Parameter {
        name: "MPP_CRUISE_MS",
        unit: "m/s",
        range: [8.0, 20.0],
        step: None,
        in_flight: BEFORE,
        get: |tuning| match tuning.settings.cruise {
            Cruise::Airspeed(airspeed) => Some(airspeed),
            Cruise::Authors => None,
        },
        set: |tuning, value| tuning.settings.cruise = Cruise::Airspeed(value),
    },
    Parameter {
        name: "LQR_THRUST_N",
        unit: "N",
        range: [0.0, 50.0],
        step: None,
        in_flight: BEFORE,
        get: |tuning| tuning.settings.design_thrust,
        set: |tuning, value| tuning.settings.design_thrust = Some(value),
    },
    number!(
        "LQR_Q_SPEED",
        "s^2/m^2",
        [0.0, 1e6],
        BEFORE,
        regulator.state[0]
    ),
    number!(
        "LQR_Q_PITCH",
        "1/rad^2",
        [0.0, 1e6],
        BEFORE,
        regulator.state[1]
    ),
    number!(
        "LQR_Q_RATE",
        "s^2/rad^2",
        [0.0, 1e6],
        BEFORE,
        regulator.state[2]
    ),
    number!(
        "LQR_Q_PATH",
        "1/rad^2",
        [0.0, 1e6],
        BEFORE,
        regulator.state[3]
    ),
    number!(
        "LQR_R_ELEVATOR",
        "1",
        [1e-3, 1e6],
        BEFORE,
        regulator.elevator
    ),
    number!(
        "EKF_Q_SPEED",
        "m^2/s^2",
        [0.0, 100.0],
        BEFORE,
        estimator.process_noise[0]
    ),
    number!(
        "EKF_Q_PITCH",
        "rad^2",
        [0.0, 10.0],
        BEFORE,
        estimator.process_noise[1]
    ),
    number!(
        "EKF_Q_RATE",
        "rad^2/s^2",
        [0.0, 10.0],
        BEFORE,
        estimator.process_noise[2]
    ),
    number!(
        "EKF_Q_PATH",
        "rad^2",
        [0.0, 10.0],
        BEFORE,
        estimator.process_noise[3]
    ),
    number!(
        "EKF_R_SPEED",
        "m^2/s^2",
        [1e-9, 100.0],
        BEFORE,
        estimator.airspeed_variance
    ),
    number!(
        "EKF_R_PITCH",
        "rad^2",
        [1e-9, 10.0],
        BEFORE,
        estimator.pitch_variance
    ),
    number!(
        "EKF_P_START",
        "-",
        [1e-9, 10.0],
        BEFORE,
        estimator.initial_variance
    ),
    number!(
        "EKF_GATE",
        "standard deviations",
        [1.0, 1000.0],
        BEFORE,
        estimator.gate
    ),
    number!("LQR_CROSS_TRACK", "rad/m", [0.0, 1.0], BEFORE, cross_track),
    Parameter {
        name: "MPP_ROUNDS",
        unit: "rounds of linearisation",
        range: [1.0, 20.0],
        step: Some(1.0),
        in_flight: BEFORE,
        get: |tuning| iteration(tuning, |iteration| f64::from(iteration.rounds)),
        set: |tuning, value| change(tuning, |iteration| iteration.rounds = value as u8),
    },
    Parameter {
        name: "MPP_DEEPENED",
        unit: "candidates",
        range: [0.0, mpp_core::config::MAX_PATHS as f64],
        step: Some(1.0),
        in_flight: BEFORE,
        get: |tuning| iteration(tuning, |iteration| iteration.deepened as f64),
        set: |tuning, value| change(tuning, |iteration| iteration.deepened = value as usize),
    },
    Parameter {
        name: "MPP_MARGIN_M",
        unit: "m",
        range: [0.1, 5.0],
        step: None,
        in_flight: BEFORE,
        get: |tuning| iteration(tuning, |iteration| iteration.margin),
        set: |tuning, value| change(tuning, |iteration| iteration.margin = value),
    },
    Parameter {
        name: "MPP_BAND_M",
        unit: "m",
        range: [2.0, 100.0],
        step: None,
        in_flight: BEFORE,
        get: |tuning| iteration(tuning, |iteration| iteration.band),
        set: |tuning, value| change(tuning, |iteration| iteration.band = value),
    },
    Parameter {
        name: "MPP_THRUST_N",
        unit: "N",
        range: [1.0, 100.0],
        step: None,
        in_flight: BEFORE,
        get: |tuning| iteration(tuning, |iteration| iteration.thrust_max),
        set: |tuning, value| change(tuning, |iteration| iteration.thrust_max = value),
    },
];
