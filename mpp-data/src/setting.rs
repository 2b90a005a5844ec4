//! The numbers of the settings, each with its range. A number outside of its range, also one that is not finite, is a
//! mistake: no aircraft that the core is made for has it.

use core::fmt;
use serde::{Deserialize, Serialize};

/// Defines the numbers with names, units, least and greatest values.
macro_rules! settings {
    ($($variant:ident, $name:literal, $unit:literal, $range:expr;)*) => {
        /// A number of the core's settings. [`Display`](fmt::Display) gives its name. The order goes over the wire:
        /// append only.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        pub enum Setting {
            $(
                #[doc = concat!("`", $name, "`, unit: ", $unit, ".")]
                $variant,
            )*
        }

        impl Setting {
            /// All numbers, in their order.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// Least and greatest value.
            #[must_use]
            pub const fn range(self) -> [f64; 2] {
                match self {
                    $(Self::$variant => $range,)*
                }
            }

            /// The unit of value and range.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                match self {
                    $(Self::$variant => $unit,)*
                }
            }

            /// The name: the field of the core's settings, after what is measured of it.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }
    };
}

settings! {
    // The heaviest aircraft that flew, with 640 t, 905 m^2 of wing and six engines, is in the ranges of size.
    Mass, "airframe.mass", "kg", [0.01, 1e6];
    PitchInertia, "airframe.pitch_inertia", "kg m^2", [1e-6, 1e9];
    WingArea, "airframe.wing_area", "m^2", [1e-3, 1e3];
    MomentLength, "airframe.moment_length", "m", [1e-3, 1e2];
    AirDensity, "airframe.air_density", "kg/m^3", [0.1, 2.0];
    LiftZero, "airframe.lift_zero", "1", [-5.0, 5.0];
    LiftAlpha, "airframe.lift_alpha", "1/rad", [0.1, 20.0];
    DragZero, "airframe.drag_zero", "1", [0.0, 5.0];
    DragInduced, "airframe.drag_induced", "1", [0.0, 5.0];
    MomentZero, "airframe.moment_zero", "1", [-10.0, 10.0];
    // Plans take the angle of attack that elevator and stiffness balance, so there must be a stiffness.
    MomentAlpha, "airframe.moment_alpha", "1/rad", [-100.0, -0.01];
    MomentAlphaRate, "airframe.moment_alpha_rate", "s/rad", [-100.0, 0.0];
    // The elevator may count in either direction, but it must have an effect.
    MomentElevator, "the magnitude of airframe.moment_elevator", "1", [1e-4, 100.0];
    MotorThrust, "actuators.thrust_max", "N", [1e-3, 1e7];
    // A shorter lag than a tenth of a tick is none.
    ThrustLag, "actuators.thrust_lag", "s", [1e-3, 60.0];
    ElevatorBelow, "actuators.elevator_below", "1", [1e-3, 1e4];
    ElevatorRate, "actuators.elevator_rate", "1/s", [1e-3, 1e6];
    DesignThrust, "design_thrust", "N", [0.0, 1e6];
    SpeedNoise, "estimator.process_noise[0]", "m^2/s^2", [0.0, 1e4];
    PitchNoise, "estimator.process_noise[1]", "rad^2", [0.0, 100.0];
    RateNoise, "estimator.process_noise[2]", "rad^2/s^2", [0.0, 1e4];
    PathNoise, "estimator.process_noise[3]", "rad^2", [0.0, 100.0];
    AirspeedVariance, "estimator.airspeed_variance", "m^2/s^2", [1e-12, 1e4];
    PitchVariance, "estimator.pitch_variance", "rad^2", [1e-12, 100.0];
    InitialVariance, "estimator.initial_variance", "1", [1e-12, 1e4];
    Gate, "estimator.gate", "standard deviations", [1.0, 1e4];
    SpeedWeight, "regulator.state[0]", "s^2/m^2", [0.0, 1e9];
    PitchWeight, "regulator.state[1]", "1/rad^2", [0.0, 1e9];
    RateWeight, "regulator.state[2]", "s^2/rad^2", [0.0, 1e9];
    PathWeight, "regulator.state[3]", "1/rad^2", [0.0, 1e9];
    ElevatorWeight, "regulator.elevator", "1", [1e-6, 1e9];
    CrossTrack, "cross_track", "rad/m", [0.0, 20.0];
    AirspeedHold, "airspeed_hold", "N s/m", [0.0, 1e8];
    PlanElevatorWeight, "planner.weights.control[0]", "1", [1e-6, 1e9];
    PlanThrustWeight, "planner.weights.control[1]", "1/N^2", [1e-6, 1e9];
    PlanTerminalWeight, "planner.weights.terminal", "1", [0.0, 1e9];
    // A plan ends at the horizon; it is of no use if the vehicle takes it over later.
    Latency, "latency", "s of the planner's units", [0.0, 4.5];
    PenaltyQuadratic, "penalty.quadratic", "1/m^2", [1e-6, 1e12];
    SqpIterations, "sqp_iterations", "iterations", [1.0, 100.0];
    RefinedCandidates, "refined_candidates", "candidates", [0.0, 50.0];
    PaddingNear, "padding.near", "m", [0.0, 20.0];
    PaddingFar, "padding.far", "m", [0.0, 20.0];
    ElevatorAbove, "actuators.elevator_above", "1", [1e-3, 1e4];
    LiftElevator, "airframe.lift_elevator", "1", [-100.0, 100.0];
    MomentPitchRate, "airframe.moment_pitch_rate", "s/rad", [-100.0, 0.0];
    // The clearance is known up to 3 of the planner's units of length; the rest is for the margin.
    BodyRadius, "body_radius", "m over the planner's unit of length", [0.0, 2.0];
    Stall, "stall", "rad", [1e-3, 1.5];
    LengthUnit, "units.length", "m", [1e-3, 1e3];
    TimeUnit, "units.time", "s", [1e-2, 1e2];
    MassUnit, "units.mass", "kg", [1e-4, 1e6];
    // Plans divide by the momentum without these shares, also at more than the airspeed of level flight.
    LiftAlphaRate, "the momentum's share by airframe.lift_alpha_rate", "1", [-0.4, 0.4];
    LiftPitchRate, "the momentum's share by airframe.lift_pitch_rate", "1", [-0.4, 0.4];
    // An airliner cruises at 265 m/s.
    CruiseAirspeed, "cruise", "m/s", [1.0, 300.0];
    WindChange, "wind_change", "m/s in 1 s", [1e-3, 100.0];
    Altitude, "planner.altitude", "m", [-1e3, 2e4];
    Sight, "the range of the lidar (sight)", "m", [1.0, 1e5];
    PenaltyLinear, "penalty.linear", "1/m", [1e-6, 1e12];
    AngleOfAttackLimit, "attitude.angle_of_attack", "rad", [1e-3, 1.5];
    FlightPathLimit, "attitude.flight_path", "rad", [1e-3, 1.5];
    Margin, "margin", "m", [1e-3, 1e3];
    Band, "band", "m", [0.01, 1e4];
    PlanThrust, "thrust_max", "N", [0.01, 1e7];
    // The core remembers the commands of 30 ticks. A shorter dead time than half a tick is none.
    ElevatorDelay, "actuators.elevator_delay", "s", [1e-3, 0.3];
    ThrustDelay, "actuators.thrust_delay", "s", [1e-3, 0.3];
}

impl Setting {
    /// Whether a number is in the range. A number that is not finite is in no range.
    #[must_use]
    pub fn holds(self, number: f64) -> bool {
        let [least, most] = self.range();
        (least..=most).contains(&number)
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The text of a number that is outside of its range: what is wrong and what to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfRange(pub Setting);

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (setting, [least, most]) = (self.0, self.0.range());
        write!(
            f,
            "{setting} is out of range or not a finite number: give {least} to {most}"
        )?;
        match setting.unit() {
            "1" => Ok(()),
            unit => write!(f, " {unit}"),
        }
    }
}

impl core::error::Error for OutOfRange {}
