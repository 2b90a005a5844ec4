//! Reading and writing of aircraft files: a pitch loop stands for three of the keys.

use super::pitch_loop::{PitchLoop, absent};
use super::{AircraftFile, Angle, Elevator, ElevatorUnit, Moment};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::f64::consts::PI;

/// Square of the radius of gyration over the wing area [-]. The motion does not depend on it, because each moment is proportional to
/// the inertia.
const GYRATION: f64 = 0.16;

impl Moment {
    pub(super) fn absent() -> Self {
        Self {
            zero: 0.0,
            alpha: absent(),
            pitch_rate: 0.0,
            alpha_rate: 0.0,
            alpha_rate_time: 0.0,
        }
    }
}

impl Elevator {
    pub(super) fn absent() -> Self {
        Self {
            unit: ElevatorUnit::Rad,
            moment: absent(),
            lift: 0.0,
            min: None,
            max: None,
            rate: None,
            delay: None,
        }
    }
}

impl AircraftFile {
    /// Gives the aircraft the moments of the loop.
    fn close(&mut self, by: &PitchLoop) {
        self.pitch_inertia = GYRATION * self.mass * self.wing_area;
        let pressure = 0.5 * self.air_density * self.cruise * self.cruise;
        // Moment coefficient for a unit of angular acceleration, per angle of the file.
        let angle = match self.derivatives {
            Angle::Radian => 1.0,
            Angle::Degree => PI / 180.0,
        };
        let unit = angle * self.pitch_inertia / (pressure * self.wing_area * self.chord);
        let stiffness = unit * by.frequency * by.frequency;
        let rate = 2.0 * unit * by.damping * by.frequency;
        self.moment = Moment {
            alpha: -stiffness,
            pitch_rate: -rate * 2.0 * self.cruise / self.chord,
            ..self.moment
        };
        self.elevator = Elevator {
            moment: stiffness,
            min: by.min,
            max: by.max,
            delay: by.delay,
            ..self.elevator
        };
    }

    /// The keys that a pitch loop stands for, and whether the text has them.
    fn replaced(&self) -> [(&'static str, bool); 3] {
        [
            ("pitch_inertia", self.pitch_inertia),
            ("moment", self.moment.alpha),
            ("elevator", self.elevator.moment),
        ]
        .map(|(key, number)| (key, number.is_nan() || number > absent()))
    }
}

impl<'a> Deserialize<'a> for AircraftFile {
    fn deserialize<D: Deserializer<'a>>(input: D) -> Result<Self, D::Error> {
        // The derived function, of the same name.
        let mut file = Self::deserialize(input)?;
        let keys = file.replaced();
        match file.pitch_loop.take() {
            None => match keys.iter().find(|(_, given)| !given) {
                None => Ok(file),
                Some((key, _)) => Err(D::Error::missing_field(key)),
            },
            Some(_) if keys.iter().any(|(_, given)| *given) => Err(D::Error::custom(
                "`pitch_loop`: leave out `pitch_inertia`, `moment` and `elevator`, they follow from it",
            )),
            Some(pitch_loop) => match pitch_loop.doubt() {
                Some(doubt) => Err(D::Error::custom(doubt)),
                None => {
                    file.close(&pitch_loop);
                    Ok(file)
                }
            },
        }
    }
}

impl Serialize for AircraftFile {
    fn serialize<S: Serializer>(&self, output: S) -> Result<S::Ok, S::Error> {
        // The derived function, of the same name.
        Self::serialize(self, output)
    }
}
