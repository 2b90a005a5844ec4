//! The numbers of the core's settings, as the verdicts name them.

use core::fmt;
use serde::{Deserialize, Serialize};

/// A number of the core's settings that a verdict names. [`Display`](fmt::Display) gives its name in
/// words. The order goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Setting {
    /// The mass of the airframe.
    Mass,
    /// The pitch inertia of the airframe.
    PitchInertia,
    /// The wing area of the airframe.
    WingArea,
    /// The reference length of the airframe's moment.
    MomentLength,
    /// The density of the air.
    AirDensity,
    /// The airframe's lift coefficient at zero angle of attack.
    LiftZero,
    /// The lift slope of the airframe.
    LiftAlpha,
    /// The parasitic drag coefficient of the airframe.
    DragZero,
    /// The induced drag factor of the airframe.
    DragInduced,
    /// The airframe's moment coefficient at zero angle of attack.
    MomentZero,
    /// The pitch stiffness of the airframe.
    MomentAlpha,
    /// The pitch damping of the airframe.
    MomentAlphaRate,
    /// The effectiveness of the elevator.
    MomentElevator,
    /// The greatest thrust of the motor.
    MotorThrust,
    /// The time constant of the thrust.
    ThrustLag,
    /// The range of the elevator below its trim.
    ElevatorBelow,
    /// The rate of the elevator.
    ElevatorRate,
    /// The thrust of the regulator's design.
    DesignThrust,
    /// The estimator's process noise of the airspeed.
    SpeedNoise,
    /// The estimator's process noise of the pitch.
    PitchNoise,
    /// The estimator's process noise of the pitch rate.
    RateNoise,
    /// The estimator's process noise of the flight path angle.
    PathNoise,
    /// The variance of the airspeed sensor.
    AirspeedVariance,
    /// The variance of the pitch sensor.
    PitchVariance,
    /// The estimator's initial variance.
    InitialVariance,
    /// The gate of the estimator.
    Gate,
    /// The regulator's weight of the airspeed.
    SpeedWeight,
    /// The regulator's weight of the pitch.
    PitchWeight,
    /// The regulator's weight of the pitch rate.
    RateWeight,
    /// The regulator's weight of the flight path angle.
    PathWeight,
    /// The regulator's weight of the elevator.
    ElevatorWeight,
    /// The regulator's turn back to the path.
    CrossTrack,
    /// The gain of the thrust on the airspeed.
    AirspeedHold,
    /// The plan's weight of the elevator.
    PlanElevatorWeight,
    /// The plan's weight of the thrust.
    PlanThrustWeight,
    /// The plan's weight of the last state.
    PlanTerminalWeight,
    /// The latency of plans.
    Latency,
    /// The quadratic price of the soft rows.
    PenaltyQuadratic,
    /// The number of SQP iterations.
    SqpIterations,
    /// The number of candidates with all SQP iterations.
    RefinedCandidates,
    /// The corridor's padding at the start of the plan.
    PaddingNear,
    /// The corridor's padding at the end of the plan.
    PaddingFar,
    /// The range of the elevator above its trim.
    ElevatorAbove,
    /// The lift of the elevator.
    LiftElevator,
    /// The pitch damping of the airframe through the pitch rate.
    MomentPitchRate,
    /// The radius of the aircraft.
    BodyRadius,
    /// The distance of the stall from level flight.
    Stall,
    /// The planner's unit of length.
    LengthUnit,
    /// The planner's unit of time.
    TimeUnit,
    /// The planner's unit of mass.
    MassUnit,
    /// The lift of the airframe by the rate of the angle of attack.
    LiftAlphaRate,
    /// The lift of the airframe by the pitch rate.
    LiftPitchRate,
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Mass => "the mass of the airframe",
            Self::PitchInertia => "the pitch inertia of the airframe",
            Self::WingArea => "the wing area of the airframe",
            Self::MomentLength => "the reference length of the airframe's moment",
            Self::AirDensity => "the density of the air",
            Self::LiftZero => "the airframe's lift coefficient at zero angle of attack",
            Self::LiftAlpha => "the lift slope of the airframe",
            Self::DragZero => "the parasitic drag coefficient of the airframe",
            Self::DragInduced => "the induced drag factor of the airframe",
            Self::MomentZero => "the airframe's moment coefficient at zero angle of attack",
            Self::MomentAlpha => "the pitch stiffness of the airframe",
            Self::MomentAlphaRate => "the pitch damping of the airframe",
            Self::MomentElevator => "the effectiveness of the elevator",
            Self::MotorThrust => "the greatest thrust of the motor",
            Self::ThrustLag => "the time constant of the thrust",
            Self::ElevatorBelow => "the range of the elevator below its trim",
            Self::ElevatorRate => "the rate of the elevator",
            Self::DesignThrust => "the thrust of the regulator's design",
            Self::SpeedNoise => "the estimator's process noise of the airspeed",
            Self::PitchNoise => "the estimator's process noise of the pitch",
            Self::RateNoise => "the estimator's process noise of the pitch rate",
            Self::PathNoise => "the estimator's process noise of the flight path angle",
            Self::AirspeedVariance => "the variance of the airspeed sensor",
            Self::PitchVariance => "the variance of the pitch sensor",
            Self::InitialVariance => "the estimator's initial variance",
            Self::Gate => "the gate of the estimator",
            Self::SpeedWeight => "the regulator's weight of the airspeed",
            Self::PitchWeight => "the regulator's weight of the pitch",
            Self::RateWeight => "the regulator's weight of the pitch rate",
            Self::PathWeight => "the regulator's weight of the flight path angle",
            Self::ElevatorWeight => "the regulator's weight of the elevator",
            Self::CrossTrack => "the regulator's turn back to the path",
            Self::AirspeedHold => "the gain of the thrust on the airspeed",
            Self::PlanElevatorWeight => "the plan's weight of the elevator",
            Self::PlanThrustWeight => "the plan's weight of the thrust",
            Self::PlanTerminalWeight => "the plan's weight of the last state",
            Self::Latency => "the latency of plans",
            Self::PenaltyQuadratic => "the quadratic price of the soft rows",
            Self::SqpIterations => "the number of SQP iterations",
            Self::RefinedCandidates => "the number of candidates with all SQP iterations",
            Self::PaddingNear => "the corridor's padding at the start of the plan",
            Self::PaddingFar => "the corridor's padding at the end of the plan",
            Self::ElevatorAbove => "the range of the elevator above its trim",
            Self::LiftElevator => "the lift of the elevator",
            Self::MomentPitchRate => "the pitch damping of the airframe through the pitch rate",
            Self::BodyRadius => "the radius of the aircraft",
            Self::LengthUnit => "the planner's unit of length",
            Self::TimeUnit => "the planner's unit of time",
            Self::MassUnit => "the planner's unit of mass",
            Self::LiftAlphaRate => "the lift of the airframe by the rate of the angle of attack",
            Self::LiftPitchRate => "the lift of the airframe by the pitch rate",
            Self::Stall => "the distance of the stall from level flight",
        })
    }
}
