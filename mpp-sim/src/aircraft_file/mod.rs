//! Aircraft files: one aircraft as TOML, from published derivatives to the numbers that core and plant use.
//! `docs/aircraft.md` describes every key with its unit.

mod choice;
mod lateral;
mod numbers;
mod pitch_loop;
mod ranges;
mod reading;
mod roll_loop;
mod similar;

use crate::file_error::ScenarioError;
pub use lateral::{Coefficient, Lateral, Surface};
use mpp_core::vehicle::Airframe;
pub use numbers::AircraftModel;
pub use pitch_loop::PitchLoop;
use pitch_loop::absent;
pub use roll_loop::RollLoop;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The content of an aircraft file.
// `remote`: reading ends with a pitch loop, which stands for three of the keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields)]
pub struct AircraftFile {
    /// Name in reports and in names of files: 1 to 64 bytes without slashes and control characters.
    pub name: String,
    /// Where the numbers come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// The angle to which the derivatives refer.
    pub derivatives: Angle,
    /// Mass \[kg\].
    pub mass: f64,
    /// Moment of inertia in pitch [kg m^2].
    #[serde(default = "absent")]
    pub pitch_inertia: f64,
    /// Wing area [m^2].
    pub wing_area: f64,
    /// Mean chord, the reference length of the pitching moment \[m\].
    pub chord: f64,
    /// Air density [kg/m^3]; by default that at sea level.
    #[serde(default = "sea_level")]
    pub air_density: f64,
    /// Airspeed of level flight [m/s].
    pub cruise: f64,
    /// Radius of the circle in the vertical plane that holds the aircraft \[m\]; by default 0.
    #[serde(default)]
    pub body_radius: f64,
    /// Lift.
    pub lift: Lift,
    /// Drag.
    pub drag: Drag,
    /// Pitching moment.
    #[serde(default = "Moment::absent")]
    pub moment: Moment,
    /// Elevator.
    #[serde(default = "Elevator::absent")]
    pub elevator: Elevator,
    /// An autopilot's pitch loop instead of inertia, moment and elevator. Reading replaces it by them.
    #[serde(default, skip_serializing)]
    pub pitch_loop: Option<PitchLoop>,
    /// Its roll loop besides, instead of the table `lateral`. Reading replaces it by that.
    #[serde(default, skip_serializing)]
    pub roll_loop: Option<RollLoop>,
    /// Motor.
    #[serde(default)]
    pub thrust: Thrust,
    /// What an aircraft has that turns; flights in the vertical plane do without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lateral: Option<Lateral>,
}

fn sea_level() -> f64 {
    1.225
}

/// The angle to which derivatives refer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Angle {
    /// Derivatives are per radian.
    Radian,
    /// Derivatives are per degree.
    Degree,
}

/// Lift coefficient `C_L = zero + alpha * angle of attack + elevator.lift * deflection`, and lift by rates.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lift {
    /// At zero angle of attack [-].
    pub zero: f64,
    /// Slope [1 per angle].
    pub alpha: f64,
    /// Lift by the rate of the angle of attack, `C_L,alpha-dot` [1 per angle], of `alpha' c / 2v`.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub alpha_rate: f64,
    /// Lift by the pitch rate, `C_Lq` [1 per angle], of `theta' c / 2v`.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub pitch_rate: f64,
    /// Angle of attack at which the wing stalls \[rad\]; by default it never does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stall: Option<f64>,
}

/// Drag coefficient `C_D = zero + induced * C_L^2`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// Without lift [-].
    pub zero: f64,
    /// Factor on the squared lift coefficient [-].
    pub induced: f64,
}

/// Pitching moment coefficient about the centre of gravity, nose-up positive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moment {
    /// At zero angle of attack and elevator [-].
    pub zero: f64,
    /// Slope with the angle of attack [1 per angle]; negative for a stable aircraft.
    pub alpha: f64,
    /// Damping by the pitch rate, of `theta' chord / 2v` [1 per angle].
    #[serde(default)]
    pub pitch_rate: f64,
    /// Damping by the rate of the angle of attack, of `alpha' chord / 2v` [1 per angle].
    #[serde(default)]
    pub alpha_rate: f64,
    /// The same damping as the paper prints it, of `alpha'` [s per angle]. It does not change with the airspeed.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub alpha_rate_time: f64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The elevator. Limits and the command of the link have its unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Elevator {
    /// Unit of the command.
    pub unit: ElevatorUnit,
    /// Moment coefficient of a deflection [1 per angle, or per unit of `command`].
    pub moment: f64,
    /// Lift coefficient of a deflection [1 per angle, or per unit of `command`].
    #[serde(default)]
    pub lift: f64,
    /// Least deflection \[unit\]; by default there is no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Greatest deflection \[unit\]; by default there is no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Greatest rate [unit/s]; by default there is no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f64>,
    /// Dead time from a command to its effect \[s\]; by default there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub delay: Option<f64>,
}

/// Unit of the elevator's command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ElevatorUnit {
    /// Degrees.
    Deg,
    /// Radians.
    Rad,
    /// A number of its own. Moment and lift are per unit of this number.
    Command,
}

/// The motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Thrust {
    /// Greatest thrust \[N\]; by default there is no limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Time constant of the thrust \[s\]; by default it follows at once.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lag: Option<f64>,
    /// Dead time from a command to its effect \[s\]; by default there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay: Option<f64>,
}

impl AircraftFile {
    /// The aircraft that come with the project, by name.
    pub const KNOWN: [(&'static str, &'static str); 11] = [
        ("reference", include_str!("../../aircraft/reference.toml")),
        ("paper", include_str!("../../aircraft/paper.toml")),
        ("example", include_str!("../../aircraft/example.toml")),
        ("aerosonde", include_str!("../../aircraft/aerosonde.toml")),
        ("zagi", include_str!("../../aircraft/zagi.toml")),
        ("cessna182", include_str!("../../aircraft/cessna182.toml")),
        ("aerosonde2", include_str!("../../aircraft/aerosonde2.toml")),
        ("x8", include_str!("../../aircraft/x8.toml")),
        ("ultrastick", include_str!("../../aircraft/ultrastick.toml")),
        ("rascal", include_str!("../../aircraft/rascal.toml")),
        ("delta", include_str!("../../aircraft/delta.toml")),
    ];

    /// Reads an aircraft file from text. An error shows `name` as the name of the text.
    ///
    /// # Errors
    /// [`ScenarioError::Toml`].
    pub fn parse(name: &str, text: &str) -> Result<Self, ScenarioError> {
        toml::from_str(text).map_err(|error| ScenarioError::Toml(name.to_owned(), Box::new(error)))
    }

    /// The airframe in the form that the core knows: derivatives per radian and per unit of the elevator's command,
    /// derivatives by rates per radian and second at cruise.
    #[must_use]
    pub fn airframe(&self) -> Airframe {
        let per_radian = |derivative: f64| match self.derivatives {
            Angle::Radian => derivative,
            Angle::Degree => derivative * 180.0 / PI,
        };
        let per_command = |derivative: f64| match self.elevator.unit {
            ElevatorUnit::Command => derivative,
            ElevatorUnit::Rad => per_radian(derivative),
            ElevatorUnit::Deg => per_radian(derivative) * PI / 180.0,
        };
        let time = self.chord / (2.0 * self.cruise);
        Airframe {
            mass: self.mass,
            pitch_inertia: self.pitch_inertia,
            wing_area: self.wing_area,
            moment_length: self.chord,
            air_density: self.air_density,
            lift_zero: self.lift.zero,
            lift_alpha: per_radian(self.lift.alpha),
            lift_alpha_rate: per_radian(self.lift.alpha_rate) * time,
            lift_pitch_rate: per_radian(self.lift.pitch_rate) * time,
            lift_elevator: per_command(self.elevator.lift),
            drag_zero: self.drag.zero,
            drag_induced: self.drag.induced,
            moment_zero: self.moment.zero,
            moment_alpha: per_radian(self.moment.alpha),
            moment_alpha_rate: per_radian(self.moment.alpha_rate) * time
                + per_radian(self.moment.alpha_rate_time),
            moment_pitch_rate: per_radian(self.moment.pitch_rate) * time,
            moment_elevator: per_command(self.elevator.moment),
        }
    }

    /// The aircraft with a name that comes with the project.
    #[must_use]
    pub fn known(name: &str) -> Option<Self> {
        let (_, text) = Self::KNOWN.iter().find(|(known, _)| *known == name)?;
        Self::parse(name, text).ok()
    }
}

#[cfg(test)]
mod tests;
