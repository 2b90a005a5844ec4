//! Reading and writing of aircraft files: a pitch loop stands for three of the keys, a roll loop for the lateral table.

use super::pitch_loop::{PitchLoop, absent};
use super::{
    AircraftFile, Angle, Coefficient, Elevator, ElevatorUnit, Lateral, Moment, RollLoop, Surface,
};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::f64::consts::PI;

/// Square of the radius of gyration over the wing area [-]. The motion does not depend on it, because each moment is proportional to
/// the inertia.
const GYRATION: f64 = 0.16;

/// Side force by the sideslip [1/rad], of a usual fuselage. Source: chosen, amid those of the known aircraft.
const SIDE_FORCE: f64 = -0.5;
/// A surface that follows at once; a missing bank beyond 89 deg is beyond the greatest bank.
const AT_ONCE: Surface = Surface {
    range: 89.0,
    rate: 1e6,
    bandwidth: 200.0,
    damping: None,
};

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

    /// The lateral table of the loop, for an aircraft whose pitch inertia stands. Its three inertias are one, so that no turn makes
    /// another.
    fn bank(&self, by: &RollLoop) -> Lateral {
        let (inertia, w) = (self.pitch_inertia, by.frequency);
        let pressure = 0.5 * self.air_density * self.cruise * self.cruise;
        // Moment coefficient for a unit of angular acceleration, and for it by a rate.
        let unit = inertia / (pressure * self.wing_area * by.span);
        let by_rate = unit * 2.0 * self.cruise / by.span;
        let none = Coefficient {
            sideslip: 0.0,
            roll_rate: 0.0,
            yaw_rate: 0.0,
            aileron: 0.0,
            rudder: Some(0.0),
        };
        Lateral {
            source: "follows from roll_loop; side force and yaw loop are assumed".to_owned(),
            span: by.span,
            roll_inertia: inertia,
            yaw_inertia: inertia,
            product_inertia: 0.0,
            side: Coefficient {
                sideslip: SIDE_FORCE,
                ..none
            },
            roll: Coefficient {
                roll_rate: -by_rate * 2.0 * by.damping * w,
                aileron: unit * w * w,
                ..none
            },
            yaw: Coefficient {
                sideslip: unit * w * w,
                yaw_rate: -by_rate * 2.0 * w,
                rudder: Some(unit * 2.0 * w),
                ..none
            },
            aileron: Surface {
                range: by.most_missing().to_degrees().min(AT_ONCE.range),
                ..AT_ONCE
            },
            rudder: Some(AT_ONCE),
            roll_loop: Some(*by),
        }
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
        let roll_loop = file.roll_loop.take();
        match file.pitch_loop.take() {
            None if roll_loop.is_some() => Err(D::Error::custom(
                "`roll_loop`: give `pitch_loop`, too: the autopilot holds both angles",
            )),
            None => match keys.iter().find(|(_, given)| !given) {
                None => Ok(file),
                Some((key, _)) => Err(D::Error::missing_field(key)),
            },
            Some(_) if keys.iter().any(|(_, given)| *given) => Err(D::Error::custom(
                "`pitch_loop`: leave out `pitch_inertia`, `moment` and `elevator`, they follow from it",
            )),
            Some(pitch_loop) => match pitch_loop.doubt() {
                Some(doubt) => Err(D::Error::custom(doubt)),
                None if roll_loop.is_some() && file.lateral.is_some() => Err(D::Error::custom(
                    "`roll_loop`: leave out `lateral`, it follows from it",
                )),
                None => {
                    file.close(&pitch_loop);
                    file.lateral = roll_loop.map(|it| file.bank(&it)).or(file.lateral);
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
