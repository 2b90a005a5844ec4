//! An aircraft behind an autopilot that holds a commanded pitch. The elevator of such an aircraft is the commanded angle of attack,
//! and its moments are those of the closed pitch loop.
//!
//! The loop is `theta'' = -w^2 (theta - command) - 2 zeta w theta'`. With the command `delta + gamma` and the angle of attack
//! `alpha = theta - gamma` that is `theta'' = -w^2 (alpha - delta) - 2 zeta w theta'`, which are moments.

use super::{AircraftFile, Angle, Elevator, ElevatorUnit, Moment};
use crate::file_error::{ScenarioError, ensure};
use serde::Deserialize;
use std::f64::consts::PI;

/// The keys that follow from a pitch loop.
const DERIVED: [&str; 3] = ["pitch_inertia", "moment", "elevator"];

/// Square of the radius of gyration over the wing area [-]. The motion does not depend on it, because each moment is proportional to
/// the inertia.
const GYRATION: f64 = 0.16;

/// The closed pitch loop of the autopilot.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PitchLoop {
    /// Natural frequency [rad/s].
    frequency: f64,
    /// Damping ratio [-].
    damping: f64,
    /// Dead time \[s\].
    delay: Option<f64>,
    /// Least and greatest commanded angle of attack \[rad\].
    min: Option<f64>,
    max: Option<f64>,
}

impl PitchLoop {
    fn check(&self) -> Result<(), ScenarioError> {
        let (low, high) = ([0.5, 60.0], [0.05, 5.0]);
        let holds = |[least, most]: [f64; 2], value| (least..=most).contains(&value);
        ensure(
            holds(low, self.frequency),
            "aircraft.pitch_loop.frequency",
            "give 0.5 to 60 rad/s",
        )?;
        ensure(
            holds(high, self.damping),
            "aircraft.pitch_loop.damping",
            "give 0.05 to 5",
        )
    }

    /// Gives the aircraft the moments of the loop.
    fn close(&self, file: &mut AircraftFile) {
        file.pitch_inertia = GYRATION * file.mass * file.wing_area;
        let pressure = 0.5 * file.air_density * file.cruise * file.cruise;
        // Moment coefficient for a unit of angular acceleration, per angle of the file.
        let angle = match file.derivatives {
            Angle::Radian => 1.0,
            Angle::Degree => PI / 180.0,
        };
        let unit = angle * file.pitch_inertia / (pressure * file.wing_area * file.chord);
        let stiffness = unit * self.frequency * self.frequency;
        let rate = 2.0 * unit * self.damping * self.frequency;
        file.moment = Moment {
            alpha: -stiffness,
            pitch_rate: -rate * 2.0 * file.cruise / file.chord,
            zero: 0.0,
            alpha_rate: 0.0,
            alpha_rate_time: 0.0,
        };
        file.elevator = Elevator {
            unit: ElevatorUnit::Rad,
            moment: stiffness,
            lift: 0.0,
            min: self.min,
            max: self.max,
            rate: None,
            delay: self.delay,
        };
    }
}

impl AircraftFile {
    /// Reads an aircraft file from text. An error shows `name` as the name of the text.
    ///
    /// # Errors
    /// [`ScenarioError::Toml`], or [`ScenarioError::Value`] for a pitch loop that makes no sense.
    pub fn parse(name: &str, text: &str) -> Result<Self, ScenarioError> {
        let wrong = |error| ScenarioError::Toml(name.to_owned(), Box::new(error));
        let looped = toml::from_str::<toml::Table>(text)
            .ok()
            .and_then(|mut table| {
                let pitch_loop = table.remove("pitch_loop")?;
                Some((table, pitch_loop))
            });
        // The text itself, not its table, so that an error shows the line.
        let Some((mut table, pitch_loop)) = looped else {
            return toml::from_str(text).map_err(wrong);
        };
        let pitch_loop: PitchLoop = pitch_loop.try_into().map_err(wrong)?;
        pitch_loop.check()?;
        ensure(
            !DERIVED.iter().any(|key| table.contains_key(*key)),
            "aircraft.pitch_loop",
            "leave out `pitch_inertia`, `moment` and `elevator`: they follow from it",
        )?;
        // Stand for what follows until the other numbers are read.
        table.extend(toml::toml! {
            pitch_inertia = 1.0
            [moment]
            zero = 0.0
            alpha = -1.0
            [elevator]
            unit = "rad"
            moment = 1.0
        });
        let mut file: Self = table.try_into().map_err(wrong)?;
        pitch_loop.close(&mut file);
        Ok(file)
    }
}
