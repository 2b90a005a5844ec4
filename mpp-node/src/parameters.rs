//! The parameters of planner and regulator: their names, their ranges, and whether they can change in
//! flight.
//!
//! The number of a parameter on the link is its place in [`PARAMETERS`]. New parameters therefore go to
//! the end.

use crate::convert;
use hil_protocol::{Configure, ConfigureVerdict, ParameterVerdict, Preset};
use mpp_core::config::TICK_PERIOD;
use mpp_core::settings::{Cruise, PlaneSettings, Settings};

/// A configuration, and the settings that follow from it and from later changes of parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuning {
    /// The configuration, with the rates and times of the session.
    pub configure: Configure,
    /// The settings of the flight core.
    pub settings: Settings,
}

impl Tuning {
    /// The values that a configuration asks for.
    ///
    /// # Errors
    /// The first fault of the configuration.
    pub fn new(configure: &Configure) -> Result<Self, ConfigureVerdict> {
        Ok(Self {
            configure: *configure,
            settings: convert::settings(configure)?,
        })
    }

    /// The value of a parameter. It is `None` if there is no such parameter, or if the preset does not have
    /// it.
    #[must_use]
    pub fn value(&self, parameter: u8) -> Option<f64> {
        let parameter = PARAMETERS.get(usize::from(parameter))?;
        get(parameter.which, self)
    }

    /// These values with one parameter changed.
    ///
    /// # Errors
    /// The reason why the parameter cannot take this value.
    pub fn with(
        mut self,
        number: u8,
        value: f64,
        in_flight: bool,
    ) -> Result<Self, ParameterVerdict> {
        self.change(number, value, in_flight)?;
        Ok(self)
    }

    /// Changes one parameter. After a fault the values are of no use.
    pub(crate) fn change(
        &mut self,
        number: u8,
        value: f64,
        in_flight: bool,
    ) -> Result<(), ParameterVerdict> {
        let parameter = PARAMETERS
            .get(usize::from(number))
            .ok_or(ParameterVerdict::Unknown)?;
        if get(parameter.which, self).is_none() {
            return Err(ParameterVerdict::NotInPreset);
        }
        let [least, most] = parameter.range;
        // The range test also refuses NaN.
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
        set(parameter.which, self, value);
        let planner = &self.settings.planner;
        if planner.paths == 0 && planner.plane().is_some() {
            return Err(ParameterVerdict::SetUp(ConfigureVerdict::PathsZero));
        }
        // A cycle that tracks a path differs from a cycle that refines paths, so the number of paths
        // cannot change from or to zero in flight.
        if in_flight && tracked != (planner.paths == 0) {
            return Err(ParameterVerdict::PathsInFlight);
        }
        // The range of the elevator is relative to the trim of the cruise with which it was set.
        let limits = &self.settings.actuators;
        let limited = limits.elevator_below.is_some() || limits.elevator_above.is_some();
        if limited && self.settings.cruise != cruise {
            return Err(ParameterVerdict::CruiseFixed);
        }
        convert::check(&self.configure).map_err(ParameterVerdict::SetUp)?;
        convert::check_latency(&self.configure, &self.settings).map_err(ParameterVerdict::SetUp)?;
        if let Some(setting) = self.settings.out_of_range() {
            return Err(ParameterVerdict::SetUp(ConfigureVerdict::out_of_range(
                setting,
            )));
        }
        Ok(())
    }
}

/// One parameter.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    which: Which,
    /// Name, of at most 16 characters as in MAVLink.
    pub name: &'static str,
    /// Unit of the value, or a description of its values.
    pub unit: &'static str,
    /// Least and greatest value.
    pub range: [f64; 2],
    /// Step of the values: each value is a whole multiple of it.
    pub step: Option<f64>,
    /// Whether the value can change between two ticks of a flight. The next planning cycle then uses it. The
    /// other parameters are built into the regulator, the estimator or the planner's model before the
    /// flight.
    pub in_flight: bool,
}

/// The number of the parameter with this name: its place in [`PARAMETERS`]. It is `None` if there is no
/// such parameter.
#[must_use]
pub fn number(name: &str) -> Option<u8> {
    let place = PARAMETERS
        .iter()
        .position(|parameter| parameter.name == name)?;
    u8::try_from(place).ok()
}

/// The table of parameters, with code to read and to write each of them. The code selects a parameter by
/// its [`Which`] and calls no function pointer, so that the bound of the stack is known.
macro_rules! parameters {
    ($count:literal: $(
        $which:ident = $name:literal, $unit:literal, $range:expr, $step:expr, $in_flight:expr,
        |$of:ident| $get:expr, |$to:ident, $value:ident| $set:expr;
    )*) => {
        /// Selects the code of a parameter.
        #[derive(Clone, Copy, Debug)]
        enum Which {
            $($which),*
        }

        /// All parameters. A preset has only some of them.
        pub const PARAMETERS: [Parameter; $count] = [$(Parameter {
            which: Which::$which,
            name: $name,
            unit: $unit,
            range: $range,
            step: $step,
            in_flight: $in_flight,
        }),*];

        fn get(which: Which, tuning: &Tuning) -> Option<f64> {
            match which {
                $(Which::$which => {
                    let $of = tuning;
                    $get
                })*
            }
        }

        fn set(which: Which, tuning: &mut Tuning, value: f64) {
            match which {
                $(Which::$which => {
                    let ($to, $value) = (tuning, value);
                    $set;
                })*
            }
        }
    };
}

const BEFORE: bool = false;
const ANY_TIME: bool = true;

/// Duration of a number of ticks \[s\].
fn seconds(ticks: u32) -> Option<f64> {
    // The division gives the floating-point number that is nearest to the decimal number.
    Some(f64::from(ticks) / 100.0)
}

/// The number of ticks nearest to a duration \[s\].
fn whole_ticks(seconds: f64) -> u32 {
    libm::round(seconds / TICK_PERIOD) as u32
}

/// A value from the settings of the flight planner, if it is the chosen method.
fn flight(tuning: &Tuning, get: impl FnOnce(&PlaneSettings) -> f64) -> Option<f64> {
    tuning.settings.planner.plane().map(get)
}

fn set_flight(tuning: &mut Tuning, set: impl FnOnce(&mut PlaneSettings)) {
    if let Some(own) = tuning.settings.planner.plane_mut() {
        set(own);
    }
}

/// The near and the far padding of the paper's method, if it is the chosen method.
#[cfg(feature = "paper")]
fn padding(tuning: &Tuning) -> Option<[f64; 2]> {
    let padding = &tuning.settings.planner.paper()?.padding;
    Some([padding.near, padding.far])
}

#[cfg(not(feature = "paper"))]
fn padding(_: &Tuning) -> Option<[f64; 2]> {
    None
}

#[cfg(feature = "paper")]
fn padding_mut(tuning: &mut Tuning) -> Option<[&mut f64; 2]> {
    let padding = &mut tuning.settings.planner.paper_mut()?.padding;
    Some([&mut padding.near, &mut padding.far])
}

#[cfg(not(feature = "paper"))]
fn padding_mut(_: &mut Tuning) -> Option<[&mut f64; 2]> {
    None
}

/// A limit of an actuator, if the preset uses limits. 0 means no limit.
fn limit(tuning: &Tuning, limit: Option<f64>) -> Option<f64> {
    (tuning.configure.preset == Preset::Flight).then_some(limit.unwrap_or(0.0))
}

fn positive(value: f64) -> Option<f64> {
    (value > 0.0).then_some(value)
}

parameters! { 41:
    MppPaths = "MPP_PATHS", "candidate paths", [0.0, mpp_core::config::MAX_PATHS as f64], Some(1.0), ANY_TIME,
        |tuning| Some(tuning.settings.planner.paths as f64),
        |tuning, value| tuning.settings.planner.paths = value as usize;
    MppReplanS = "MPP_REPLAN_S", "s", [0.1, 60.0], Some(TICK_PERIOD), ANY_TIME,
        |tuning| seconds(tuning.configure.replan_period_ticks),
        |tuning, value| tuning.configure.replan_period_ticks = whole_ticks(value);
    MppLatencyS = "MPP_LATENCY_S", "s", [0.01, 60.0], Some(TICK_PERIOD), ANY_TIME,
        |tuning| seconds(tuning.configure.latency_ticks),
        |tuning, value| {
            tuning.configure.latency_ticks = whole_ticks(value);
            let latency = crate::duration(tuning.configure.latency_ticks);
            set_flight(tuning, |own| own.latency = latency);
        };
    MppSlices = "MPP_SLICES", "slices a tick; 0: all", [0.0, 1e6], Some(1.0), ANY_TIME,
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
    MppAltM = "MPP_ALT_M", "m", [0.0, 1000.0], None, ANY_TIME,
        |tuning| Some(tuning.settings.planner.altitude),
        |tuning, value| tuning.settings.planner.altitude = value;
    MppPadNearM = "MPP_PAD_NEAR_M", "m", [0.0, 10.0], None, ANY_TIME,
        |tuning| padding(tuning).map(|[near, _]| near),
        |tuning, value| if let Some([near, _]) = padding_mut(tuning) { *near = value };
    MppPadFarM = "MPP_PAD_FAR_M", "m", [0.0, 10.0], None, ANY_TIME,
        |tuning| padding(tuning).map(|[_, far]| far),
        |tuning, value| if let Some([_, far]) = padding_mut(tuning) { *far = value };
    MppAlphaLim = "MPP_ALPHA_LIM", "rad", [0.02, 0.5], None, ANY_TIME,
        |tuning| flight(tuning, |own| own.attitude.angle_of_attack),
        |tuning, value| set_flight(tuning, |own| own.attitude.angle_of_attack = value);
    MppGammaLim = "MPP_GAMMA_LIM", "rad", [0.05, 0.78], None, ANY_TIME,
        |tuning| flight(tuning, |own| own.attitude.flight_path),
        |tuning, value| set_flight(tuning, |own| own.attitude.flight_path = value);
    MppPenLin = "MPP_PEN_LIN", "1/m", [1e-3, 1e8], None, ANY_TIME,
        |tuning| flight(tuning, |own| own.penalty.linear),
        |tuning, value| set_flight(tuning, |own| own.penalty.linear = value);
    MppPenQuad = "MPP_PEN_QUAD", "1/m^2", [1e-3, 1e8], None, ANY_TIME,
        |tuning| flight(tuning, |own| own.penalty.quadratic),
        |tuning, value| set_flight(tuning, |own| own.penalty.quadratic = value);
    MppWElevator = "MPP_W_ELEVATOR", "1", [1e-3, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.planner.weights.control[0]),
        |tuning, value| tuning.settings.planner.weights.control[0] = value;
    MppWThrust = "MPP_W_THRUST", "1/N^2", [1e-3, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.planner.weights.control[1]),
        |tuning, value| tuning.settings.planner.weights.control[1] = value;
    MppWTerminal = "MPP_W_TERMINAL", "1", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.planner.weights.terminal),
        |tuning, value| tuning.settings.planner.weights.terminal = value;
    MppCruiseMs = "MPP_CRUISE_MS", "m/s", [8.0, 20.0], None, BEFORE,
        |tuning| tuning.settings.cruise.airspeed(),
        |tuning, value| tuning.settings.cruise = Cruise::Airspeed(value);
    LqrThrustN = "LQR_THRUST_N", "N", [0.0, 50.0], None, BEFORE,
        |tuning| tuning.settings.design_thrust,
        |tuning, value| tuning.settings.design_thrust = Some(value);
    LqrQSpeed = "LQR_Q_SPEED", "s^2/m^2", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.state[0]),
        |tuning, value| tuning.settings.regulator.state[0] = value;
    LqrQPitch = "LQR_Q_PITCH", "1/rad^2", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.state[1]),
        |tuning, value| tuning.settings.regulator.state[1] = value;
    LqrQRate = "LQR_Q_RATE", "s^2/rad^2", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.state[2]),
        |tuning, value| tuning.settings.regulator.state[2] = value;
    LqrQPath = "LQR_Q_PATH", "1/rad^2", [0.0, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.state[3]),
        |tuning, value| tuning.settings.regulator.state[3] = value;
    LqrRElevator = "LQR_R_ELEVATOR", "1", [1e-3, 1e6], None, BEFORE,
        |tuning| Some(tuning.settings.regulator.elevator),
        |tuning, value| tuning.settings.regulator.elevator = value;
    EkfQSpeed = "EKF_Q_SPEED", "m^2/s^2", [0.0, 100.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.process_noise[0]),
        |tuning, value| tuning.settings.estimator.process_noise[0] = value;
    EkfQPitch = "EKF_Q_PITCH", "rad^2", [0.0, 10.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.process_noise[1]),
        |tuning, value| tuning.settings.estimator.process_noise[1] = value;
    EkfQRate = "EKF_Q_RATE", "rad^2/s^2", [0.0, 10.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.process_noise[2]),
        |tuning, value| tuning.settings.estimator.process_noise[2] = value;
    EkfQPath = "EKF_Q_PATH", "rad^2", [0.0, 0.1], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.process_noise[3]),
        |tuning, value| tuning.settings.estimator.process_noise[3] = value;
    EkfRSpeed = "EKF_R_SPEED", "m^2/s^2", [1e-9, 100.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.airspeed_variance),
        |tuning, value| tuning.settings.estimator.airspeed_variance = value;
    EkfRPitch = "EKF_R_PITCH", "rad^2", [1e-9, 10.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.pitch_variance),
        |tuning, value| tuning.settings.estimator.pitch_variance = value;
    EkfPStart = "EKF_P_START", "-", [1e-9, 10.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.initial_variance),
        |tuning, value| tuning.settings.estimator.initial_variance = value;
    EkfGate = "EKF_GATE", "standard deviations", [1.0, 1000.0], None, BEFORE,
        |tuning| Some(tuning.settings.estimator.gate),
        |tuning, value| tuning.settings.estimator.gate = value;
    LqrCrossTrack = "LQR_CROSS_TRACK", "rad/m", [0.0, 1.0], None, BEFORE,
        |tuning| Some(tuning.settings.cross_track),
        |tuning, value| tuning.settings.cross_track = value;
    MppRounds = "MPP_ROUNDS", "SQP iterations", [1.0, 20.0], Some(1.0), BEFORE,
        |tuning| flight(tuning, |own| f64::from(own.sqp_iterations)),
        |tuning, value| set_flight(tuning, |own| own.sqp_iterations = value as u8);
    MppDeepened = "MPP_DEEPENED", "candidates", [0.0, mpp_core::config::MAX_PATHS as f64], Some(1.0), BEFORE,
        |tuning| flight(tuning, |own| own.refined_candidates as f64),
        |tuning, value| set_flight(tuning, |own| own.refined_candidates = value as usize);
    MppMarginM = "MPP_MARGIN_M", "m", [0.1, 5.0], None, BEFORE,
        |tuning| flight(tuning, |own| own.margin),
        |tuning, value| set_flight(tuning, |own| own.margin = value);
    MppBandM = "MPP_BAND_M", "m", [2.0, 100.0], None, BEFORE,
        |tuning| flight(tuning, |own| own.band),
        |tuning, value| set_flight(tuning, |own| own.band = value);
    MppThrustN = "MPP_THRUST_N", "N", [1.0, 100.0], None, BEFORE,
        |tuning| flight(tuning, |own| own.thrust_max),
        |tuning, value| set_flight(tuning, |own| own.thrust_max = value);
    WindChange = "WIND_CHANGE", "m/s in 1 s", [0.01, 20.0], None, BEFORE,
        |tuning| tuning.settings.wind_change,
        |tuning, value| tuning.settings.wind_change = Some(value);
    ActThrustN = "ACT_THRUST_N", "N; 0: no limit", [0.0, 1000.0], None, BEFORE,
        |tuning| limit(tuning, tuning.settings.actuators.thrust_max),
        |tuning, value| tuning.settings.actuators.thrust_max = positive(value);
    ActThrustLagS = "ACT_THRUST_LAG_S", "s; 0: none", [0.0, 10.0], None, BEFORE,
        |tuning| limit(tuning, tuning.settings.actuators.thrust_lag),
        |tuning, value| tuning.settings.actuators.thrust_lag = positive(value);
    ActElevRange = "ACT_ELEV_RANGE", "either side of trim; 0: no limit", [0.0, 100.0], None, BEFORE,
        |tuning| {
            let limits = &tuning.settings.actuators;
            let sides = [limits.elevator_below, limits.elevator_above];
            limit(tuning, sides.into_iter().flatten().reduce(f64::min))
        },
        |tuning, value| {
            let limits = &mut tuning.settings.actuators;
            (limits.elevator_below, limits.elevator_above) = (positive(value), positive(value));
        };
    ActElevRate = "ACT_ELEV_RATE", "1/s; 0: no limit", [0.0, 1000.0], None, BEFORE,
        |tuning| limit(tuning, tuning.settings.actuators.elevator_rate),
        |tuning, value| tuning.settings.actuators.elevator_rate = positive(value);
    ThrSpeedGain = "THR_SPEED_GAIN", "N s/m", [0.0, 100.0], None, BEFORE,
        |tuning| Some(tuning.settings.airspeed_hold),
        |tuning, value| tuning.settings.airspeed_hold = value;
}
