//! The core's verdicts on a configuration and on the value of a parameter.

use core::fmt;
use mpp_data::{OutOfRange, Setting};
use serde::{Deserialize, Serialize};

/// The core's verdict on a [`Configure`](crate::Configure). Every verdict other than `Accepted` leaves the
/// state of the core as it was.
///
/// [`Display`](fmt::Display) says what is wrong and what to do. The order goes over the wire: append
/// only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ConfigureVerdict {
    /// The core flies with the configuration from the next tick on.
    Accepted,
    /// The core has no room for that many candidate paths.
    TooManyPaths {
        /// The greatest number that the core takes.
        max: u16,
    },
    /// The replanning period is zero.
    ReplanPeriod,
    /// The latency is zero or longer than the replanning period.
    Latency,
    /// The number of beams is zero or greater than the core can take.
    Beams {
        /// The greatest number that the core takes.
        max: u16,
    },
    /// The altitude is out of range, or is not finite.
    NonFinite,
    /// The core found no steady level flight at the cruise airspeed.
    NotTrimmable,
    /// The number of slices in a tick is zero.
    SlicesPerTick,
    /// The lidar's range is out of range, or is not finite.
    RangeMax,
    /// A session is already under way. It goes on unchanged.
    AlreadyConfigured,
    /// A limit of an actuator is not a positive, finite number.
    Actuators,
    /// The core was built without the method of the presets `reference` and `paper`.
    PresetNotBuilt,
    /// Preset `flight` refines every path, so it needs at least one path.
    PathsZero,
    /// The greatest thrust does not carry level flight.
    ThrustTooLow,
    /// The airspeed of level flight is out of range, or is not finite.
    CruiseAirspeed,
    /// A parameter of the airframe is infinite or not a number.
    AirframeNotFinite,
    /// The wing does not carry the aircraft at the cruise airspeed.
    NotCarried,
    /// The elevator has no effect, so nothing holds level flight.
    NoElevator,
    /// The regulator's equation has an entry that is infinite or not a number.
    RegulatorNotFinite,
    /// The regulator's equation has a matrix that cannot be inverted.
    RegulatorSingular,
    /// The solution of the regulator's equation did not settle.
    RegulatorNotConverged,
    /// The regulator's equation has no solution that stabilises the aircraft.
    RegulatorNotStabilising,
    /// The model of the plan has no steady state.
    PlanModel,
    /// The weights of the plan's cost leave it without a single optimum.
    PlanWeights,
    /// The linear price of the soft rows is out of range, or is not finite.
    Penalty,
    /// The margin of the flight planner is out of range, or is not finite.
    Margin,
    /// The altitude band of the flight planner is out of range, or is not finite.
    Band,
    /// The greatest thrust of a plan is out of range, or is not finite.
    PlanThrust,
    /// The change of the wind is out of range, or is not finite.
    WindChange,
    /// The limit of the angle of attack is out of range, or is not finite.
    AngleOfAttackLimit,
    /// The limit of the flight path angle is out of range, or is not finite.
    FlightPathLimit,
    /// The planner cannot change from one preset's method to another's in flight.
    OtherPreset,
    /// A number of the core's settings is outside of its range, or is not finite.
    OutOfRange(Setting),
    /// The regulator does not hold the aircraft, because it acts only once in a tick.
    Unstable,
    /// The program in the flight computer's memory is not as it was built.
    ImageDamaged,
}

impl ConfigureVerdict {
    /// The verdict on a number that is outside of its range. Some numbers have a verdict of their own.
    #[must_use]
    pub const fn out_of_range(setting: Setting) -> Self {
        match setting {
            Setting::Altitude => Self::NonFinite,
            Setting::Sight => Self::RangeMax,
            Setting::CruiseAirspeed => Self::CruiseAirspeed,
            Setting::PenaltyLinear => Self::Penalty,
            Setting::Margin => Self::Margin,
            Setting::Band => Self::Band,
            Setting::PlanThrust => Self::PlanThrust,
            Setting::WindChange => Self::WindChange,
            Setting::AngleOfAttackLimit => Self::AngleOfAttackLimit,
            Setting::FlightPathLimit => Self::FlightPathLimit,
            setting => Self::OutOfRange(setting),
        }
    }
}

impl fmt::Display for ConfigureVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Accepted => "the configuration is accepted",
            Self::TooManyPaths { max } => {
                return write!(
                    f,
                    "there is no room for that many candidate paths: ask for at most {max}"
                );
            }
            Self::ReplanPeriod => "the replanning period is zero: ask for at least one tick",
            Self::Latency => {
                "the latency is zero or longer than the replanning period: ask for at least one \
                 tick, and at most the period"
            }
            Self::Beams { max } => {
                return write!(
                    f,
                    "the core cannot take that number of beams: configure a lidar with 1 to {max}"
                );
            }
            Self::NotTrimmable => {
                "no level flight was found at the cruise airspeed: check cruise and airframe"
            }
            Self::SlicesPerTick => "a tick has no planning work: ask for at least one slice",
            Self::AlreadyConfigured => {
                "a flight is configured and goes on as it was: say hello to start another"
            }
            Self::Actuators => {
                "an actuator's limit is not a positive, finite number: correct it, or leave it out"
            }
            Self::PresetNotBuilt => {
                "this core was built without the paper's method: ask for preset flight, or build it \
                 with the feature `paper`"
            }
            Self::PathsZero => {
                "preset flight always refines its paths: ask for at least one, or fly preset \
                 reference or paper"
            }
            Self::ThrustTooLow => {
                "the greatest thrust does not carry level flight: raise it, or check cruise and \
                 airframe"
            }
            Self::AirframeNotFinite => {
                "a parameter of the airframe is not a finite number: check the airframe"
            }
            Self::NotCarried => {
                "the wing does not carry the aircraft in level flight: check cruise and airframe"
            }
            Self::NoElevator => {
                "the elevator has no effect on level flight: check the moments of the airframe"
            }
            Self::RegulatorNotFinite => {
                "the regulator's equation has a number that is not finite: check the airframe, and \
                 that the weight of the elevator is positive"
            }
            Self::RegulatorSingular => {
                "the regulator's equation has a matrix without an inverse: check airframe and \
                 weights of the regulator"
            }
            Self::RegulatorNotConverged => {
                "the regulator's equation was not solved within its bound: check airframe and \
                 weights of the regulator"
            }
            Self::RegulatorNotStabilising => {
                "no gain of the regulator stabilises the aircraft: check that the elevator turns it, \
                 and the weights of the regulator"
            }
            Self::PlanModel => {
                "the plan's model has no steady state: check the pitch stiffness of the airframe"
            }
            Self::PlanWeights => {
                "the plan's cost has no single optimum: give the controls positive weights, and the \
                 terminal state one that is not negative"
            }
            Self::OtherPreset => {
                "the planner cannot change its method in flight: say hello and configure it anew"
            }
            Self::Unstable => {
                "the regulator is too firm or too soft for a tick of 10 ms: bring its weights and gains \
                 nearer to those of the preset"
            }
            Self::ImageDamaged => {
                "the program in the flight computer's memory is not as it was built: load it again"
            }
            Self::NonFinite => return OutOfRange(Setting::Altitude).fmt(f),
            Self::RangeMax => return OutOfRange(Setting::Sight).fmt(f),
            Self::CruiseAirspeed => return OutOfRange(Setting::CruiseAirspeed).fmt(f),
            Self::Penalty => return OutOfRange(Setting::PenaltyLinear).fmt(f),
            Self::Margin => return OutOfRange(Setting::Margin).fmt(f),
            Self::Band => return OutOfRange(Setting::Band).fmt(f),
            Self::PlanThrust => return OutOfRange(Setting::PlanThrust).fmt(f),
            Self::WindChange => return OutOfRange(Setting::WindChange).fmt(f),
            Self::AngleOfAttackLimit => return OutOfRange(Setting::AngleOfAttackLimit).fmt(f),
            Self::FlightPathLimit => return OutOfRange(Setting::FlightPathLimit).fmt(f),
            Self::OutOfRange(setting) => return OutOfRange(*setting).fmt(f),
        })
    }
}

impl core::error::Error for ConfigureVerdict {}

/// The core's verdict on a [`SetParameter`](crate::SetParameter). After every verdict other than
/// `Accepted` the core keeps the previous value.
///
/// [`Display`](fmt::Display) says what is wrong and what to do. The order goes over the wire: append
/// only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ParameterVerdict {
    /// The value is in force: at once before the flight, and from the next planning cycle on in flight.
    Accepted,
    /// The core has no such parameter.
    Unknown,
    /// The value is not a number, or is outside the parameter's range.
    Range,
    /// The value is not a whole multiple of the parameter's step.
    NotWhole,
    /// The parameter can only change before the flight.
    InFlight,
    /// There is no configuration yet.
    NotConfigured,
    /// The core cannot be set up with this value.
    SetUp(ConfigureVerdict),
    /// The parameter belongs to another preset.
    NotInPreset,
    /// In flight the number of paths cannot change from zero or to zero.
    PathsInFlight,
    /// The cruise airspeed cannot change while the elevator's range is limited, because the range is relative
    /// to the trim of the cruise.
    CruiseFixed,
}

impl fmt::Display for ParameterVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Accepted => "the value is in force",
            Self::Unknown => "the core has no such parameter: ask it for its list",
            Self::Range => "the value is out of range: look the range up in the list of parameters",
            Self::NotWhole => "the value is not a whole number of the parameter's steps: round it",
            Self::InFlight => "the parameter cannot change in flight: set it before the flight",
            Self::NotConfigured => "the core is not configured: send a configuration first",
            Self::SetUp(verdict) => {
                return write!(f, "the core cannot fly with this value: {verdict}");
            }
            Self::NotInPreset => {
                "the parameter belongs to another preset's planner: fly that preset, or leave the \
                 parameter out"
            }
            Self::PathsInFlight => {
                "in flight the paths cannot change from zero or to zero: set them before the flight"
            }
            Self::CruiseFixed => {
                "the elevator's range is about the trim of the cruise: set the cruise before the \
                 range"
            }
        })
    }
}

impl core::error::Error for ParameterVerdict {}
