//! The planner's own units: those in which the aircraft cruises as fast as the reference aircraft and
//! has its mass.
//!
//! The planner's tuned lengths, times and forces are those of [`Airframe::REFERENCE`] at
//! [`REFERENCE_CRUISE`]. In its own units every aircraft has this speed and this mass, and gravity keeps its
//! value. The planner therefore sees two aircraft that are similar by Froude's law as the same aircraft.
//! Source: Buckingham's theorem and Froude scaling, for example Wolowicz, Bowman and Gilbert, "Similitude
//! requirements and scaling relationships as applied to model testing", NASA TP-1435, table I.

use crate::settings::PlaneSettings;
use crate::vehicle::{
    ActuatorLimits, AirState, Airframe, Conditions, Control, PathControl, PathState, Pose, Trim,
    VehicleState, Wind,
};
use mpp_data::Aircraft;

/// Airspeed of level flight for which the planner's numbers were tuned [m/s] (paper, section IV).
pub const REFERENCE_CRUISE: f64 = Aircraft::REFERENCE.cruise;

/// The sizes of the planner's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Unit of length \[m\].
    pub length: f64,
    /// Unit of time \[s\].
    pub time: f64,
    /// Unit of mass \[kg\].
    pub mass: f64,
}

impl Units {
    /// Metre, second and kilogram: the units of the reference aircraft.
    pub const SI: Self = Self {
        length: 1.0,
        time: 1.0,
        mass: 1.0,
    };

    /// The units of an aircraft that cruises at an airspeed [m/s] and has a mass \[kg\]. Gravity times a
    /// length over the squared speed is the same number in all of them.
    #[must_use]
    pub fn of(airspeed: f64, mass: f64) -> Self {
        let speed = airspeed / REFERENCE_CRUISE;
        Self {
            length: speed * speed,
            time: speed,
            mass: mass / Airframe::REFERENCE.mass,
        }
    }

    /// Unit of speed [m/s].
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.length / self.time
    }

    /// Unit of force \[N\].
    #[must_use]
    pub fn force(&self) -> f64 {
        self.mass * self.length / (self.time * self.time)
    }

    /// An airframe in own units.
    #[must_use]
    pub fn own_airframe(&self, airframe: &Airframe) -> Airframe {
        let area = self.length * self.length;
        Airframe {
            mass: airframe.mass / self.mass,
            pitch_inertia: airframe.pitch_inertia / (self.mass * area),
            wing_area: airframe.wing_area / area,
            moment_length: airframe.moment_length / self.length,
            air_density: airframe.air_density * (area * self.length / self.mass),
            lift_alpha_rate: airframe.lift_alpha_rate / self.time,
            lift_pitch_rate: airframe.lift_pitch_rate / self.time,
            moment_alpha_rate: airframe.moment_alpha_rate / self.time,
            moment_pitch_rate: airframe.moment_pitch_rate / self.time,
            ..*airframe
        }
    }

    /// Limits of the actuators in own units. The elevator keeps the unit of its command.
    #[must_use]
    pub fn own_actuators(&self, limits: &ActuatorLimits) -> ActuatorLimits {
        ActuatorLimits {
            thrust_max: limits.thrust_max.map(|most| most / self.force()),
            thrust_lag: limits.thrust_lag.map(|lag| lag / self.time),
            elevator_rate: limits.elevator_rate.map(|rate| rate * self.time),
            elevator_delay: limits.elevator_delay.map(|delay| delay / self.time),
            thrust_delay: limits.thrust_delay.map(|delay| delay / self.time),
            ..*limits
        }
    }

    /// A pose in own units.
    #[must_use]
    pub fn own_pose(&self, pose: &Pose) -> Pose {
        Pose {
            x: pose.x / self.length,
            z: pose.z / self.length,
            pitch: pose.pitch,
        }
    }

    /// A state in own units.
    #[must_use]
    pub fn own_state(&self, state: &VehicleState) -> VehicleState {
        VehicleState {
            x: state.x / self.length,
            z: state.z / self.length,
            air: self.own_air(&state.air),
        }
    }

    /// A motion through the air in own units.
    #[must_use]
    pub fn own_air(&self, air: &AirState) -> AirState {
        AirState {
            airspeed: air.airspeed / self.speed(),
            pitch_rate: air.pitch_rate * self.time,
            ..*air
        }
    }

    /// Controls in own units. The elevator keeps the unit of its command.
    #[must_use]
    pub fn own_control(&self, control: Control) -> Control {
        Control {
            thrust: control.thrust / self.force(),
            ..control
        }
    }

    /// Wind and lift in own units.
    #[must_use]
    pub fn own_conditions(&self, conditions: &Conditions) -> Conditions {
        Conditions {
            wind: Wind {
                x: conditions.wind.x / self.speed(),
                z: conditions.wind.z / self.speed(),
            },
            lift: conditions.lift,
        }
    }

    /// A trim in own units.
    #[must_use]
    pub fn own_trim(&self, trim: &Trim) -> Trim {
        Trim {
            state: self.own_air(&trim.state),
            control: self.own_control(trim.control),
        }
    }

    /// Settings of the plane planner in own units. Penalties and limits of angles are in own units already.
    #[must_use]
    pub fn own_settings(&self, settings: &PlaneSettings) -> PlaneSettings {
        PlaneSettings {
            sight: settings.sight / self.length,
            latency: settings.latency / self.time,
            margin: settings.margin / self.length,
            body_radius: settings.body_radius / self.length,
            band: settings.band / self.length,
            thrust_max: settings.thrust_max / self.force(),
            ..*settings
        }
    }

    /// A state of the point mass in SI units.
    #[must_use]
    pub fn si_path_state(&self, state: &PathState) -> PathState {
        PathState {
            x: state.x * self.length,
            z: state.z * self.length,
            airspeed: state.airspeed * self.speed(),
            ..*state
        }
    }

    /// A control of the point mass in SI units.
    #[must_use]
    pub fn si_path_control(&self, control: &PathControl) -> PathControl {
        PathControl {
            angle_of_attack_rate: control.angle_of_attack_rate / self.time,
            thrust: control.thrust * self.force(),
        }
    }
}
