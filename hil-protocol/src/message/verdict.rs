//! The core's verdicts on a configuration and on the value of a parameter.

use mpp_data::{OutOfRange, Setting};
use serde::{Deserialize, Serialize};

/// The core's verdict on a [`Configure`](crate::Configure). Every verdict other than `Accepted` leaves the
/// state of the core as it was.
///
/// [`Display`](core::fmt::Display) says what is wrong and what to do. The order goes over the wire: append
/// only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
pub enum ConfigureVerdict {
    /// The core flies with the configuration from the next tick on.
    #[error("the configuration is accepted")]
    Accepted,
    /// The core has no room for that many candidate paths.
    #[error("there is no room for that many candidate paths: ask for at most {max}")]
    TooManyPaths {
        /// The greatest number that the core takes.
        max: u16,
    },
    /// The replanning period is zero.
    #[error("the replanning period is zero: ask for at least one tick")]
    ReplanPeriod,
    /// The latency is zero or longer than the replanning period.
    #[error(
        "the latency is zero or longer than the replanning period: ask for at least one tick, and at most the \
         period"
    )]
    Latency,
    /// The number of beams is zero or greater than the core can take.
    #[error("the core cannot take that number of beams: configure a lidar with 1 to {max}")]
    Beams {
        /// The greatest number that the core takes.
        max: u16,
    },
    /// The altitude is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::Altitude))]
    NonFinite,
    /// The core found no steady level flight at the cruise airspeed.
    #[error("no level flight was found at the cruise airspeed: check cruise and airframe")]
    NotTrimmable,
    /// The number of slices in a tick is zero.
    #[error("a tick has no planning work: ask for at least one slice")]
    SlicesPerTick,
    /// The lidar's range is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::Sight))]
    RangeMax,
    /// A session is already under way. It goes on unchanged.
    #[error("a flight is configured and goes on as it was: say hello to start another")]
    AlreadyConfigured,
    /// A limit of an actuator is not a positive, finite number.
    #[error("an actuator's limit is not a positive, finite number: correct it, or leave it out")]
    Actuators,
    /// The core was built without the method of the presets `reference` and `paper`.
    #[error(
        "this core was built without the paper's method: ask for preset flight, or build it with the feature \
         `paper`"
    )]
    PresetNotBuilt,
    /// Preset `flight` refines every path, so it needs at least one path.
    #[error(
        "preset flight always refines its paths: ask for at least one, or fly preset reference or paper"
    )]
    PathsZero,
    /// The greatest thrust does not carry level flight.
    #[error(
        "the greatest thrust does not carry level flight: raise it, or check cruise and airframe"
    )]
    ThrustTooLow,
    /// The airspeed of level flight is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::CruiseAirspeed))]
    CruiseAirspeed,
    /// A parameter of the airframe is infinite or not a number.
    #[error("a parameter of the airframe is not a finite number: check the airframe")]
    AirframeNotFinite,
    /// The wing does not carry the aircraft at the cruise airspeed.
    #[error("the wing does not carry the aircraft in level flight: check cruise and airframe")]
    NotCarried,
    /// The elevator has no effect, so nothing holds level flight.
    #[error("the elevator has no effect on level flight: check the moments of the airframe")]
    NoElevator,
    /// The regulator's equation has an entry that is infinite or not a number.
    #[error(
        "the regulator's equation has a number that is not finite: check the airframe, and that the weight of the \
         elevator is positive"
    )]
    RegulatorNotFinite,
    /// The regulator's equation has a matrix that cannot be inverted.
    #[error(
        "the regulator's equation has a matrix without an inverse: check airframe and weights of the regulator"
    )]
    RegulatorSingular,
    /// The solution of the regulator's equation did not settle.
    #[error(
        "the regulator's equation was not solved within its bound: check airframe and weights of the regulator"
    )]
    RegulatorNotConverged,
    /// The regulator's equation has no solution that stabilises the aircraft.
    #[error(
        "no gain of the regulator stabilises the aircraft: check that the elevator turns it, and the weights of \
         the regulator"
    )]
    RegulatorNotStabilising,
    /// The model of the plan has no steady state.
    #[error("the plan's model has no steady state: check the pitch stiffness of the airframe")]
    PlanModel,
    /// The weights of the plan's cost leave it without a single optimum.
    #[error(
        "the plan's cost has no single optimum: give the controls positive weights, and the terminal state one \
         that is not negative"
    )]
    PlanWeights,
    /// The linear price of the soft rows is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::PenaltyLinear))]
    Penalty,
    /// The margin of the flight planner is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::Margin))]
    Margin,
    /// The altitude band of the flight planner is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::Band))]
    Band,
    /// The greatest thrust of a plan is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::PlanThrust))]
    PlanThrust,
    /// The change of the wind is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::WindChange))]
    WindChange,
    /// The limit of the angle of attack is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::AngleOfAttackLimit))]
    AngleOfAttackLimit,
    /// The limit of the flight path angle is out of range, or is not finite.
    #[error("{}", OutOfRange(Setting::FlightPathLimit))]
    FlightPathLimit,
    /// The planner cannot change from one preset's method to another's in flight.
    #[error("the planner cannot change its method in flight: say hello and configure it anew")]
    OtherPreset,
    /// A number of the core's settings is outside of its range, or is not finite.
    #[error("{}", OutOfRange(*.0))]
    OutOfRange(Setting),
    /// The regulator does not hold the aircraft, because it acts only once in a tick.
    #[error(
        "the regulator is too firm or too soft for a tick of 10 ms: bring its weights and gains nearer to those of \
         the preset"
    )]
    Unstable,
    /// The program in the flight computer's memory is not as it was built.
    #[error("the program in the flight computer's memory is not as it was built: load it again")]
    ImageDamaged,
    /// The core flies in the vertical plane only, or in space only.
    #[error(
        "this core flies no such preset: ask the core in the plane for preset flight, and that in space for space"
    )]
    NoSuchPlanner,
    /// The lateral part of the aircraft or the limits of plans in space were not sent before.
    #[error(
        "the core knows no lateral aircraft or no limits of plans in space: send both before the configuration"
    )]
    LateralMissing,
    /// A number of the lateral part is not finite, an inertia is not positive, or a limit of a surface is not.
    #[error(
        "a number of the lateral aircraft is not finite, or an inertia, the span or a limit is not positive: correct it"
    )]
    LateralAircraft,
    /// No gain of the lateral regulator holds a bank.
    #[error(
        "no gain of the lateral regulator holds a bank: check the lateral table of the aircraft"
    )]
    LateralGain,
    /// A limit of plans in space is not finite or negative, or leaves no room.
    #[error(
        "a limit of plans in space is not a number, is negative or leaves no room between floor, ceiling and sides: correct it"
    )]
    SpaceLimits,
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

/// The core's verdict on a [`SetParameter`](crate::SetParameter). After every verdict other than
/// `Accepted` the core keeps the previous value.
///
/// [`Display`](core::fmt::Display) says what is wrong and what to do. The order goes over the wire: append
/// only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
pub enum ParameterVerdict {
    /// The value is in force: at once before the flight, and from the next planning cycle on in flight.
    #[error("the value is in force")]
    Accepted,
    /// The core has no such parameter.
    #[error("the core has no such parameter: ask it for its list")]
    Unknown,
    /// The value is not a number, or is outside the parameter's range.
    #[error("the value is out of range: look the range up in the list of parameters")]
    Range,
    /// The value is not a whole multiple of the parameter's step.
    #[error("the value is not a whole number of the parameter's steps: round it")]
    NotWhole,
    /// The parameter can only change before the flight.
    #[error("the parameter cannot change in flight: set it before the flight")]
    InFlight,
    /// There is no configuration yet.
    #[error("the core is not configured: send a configuration first")]
    NotConfigured,
    /// The core cannot be set up with this value.
    #[error("the core cannot fly with this value: {0}")]
    SetUp(ConfigureVerdict),
    /// The parameter belongs to another preset.
    #[error(
        "the parameter belongs to another preset's planner: fly that preset, or leave the parameter out"
    )]
    NotInPreset,
    /// In flight the number of paths cannot change from zero or to zero.
    #[error("in flight the paths cannot change from zero or to zero: set them before the flight")]
    PathsInFlight,
    /// The cruise airspeed cannot change while the elevator's range is limited, because the range is relative
    /// to the trim of the cruise.
    #[error(
        "the elevator's range is about the trim of the cruise: set the cruise before the range"
    )]
    CruiseFixed,
}
