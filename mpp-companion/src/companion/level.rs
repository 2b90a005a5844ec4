//! What the companion flies of itself: level until the core is ready, and back to the line of hand-over.

use super::Companion;
use crate::autopilot::{Kind, px4};
use crate::frames::{CourseFrame, over_ground};
use crate::level::Level;
use crate::setpoint::Setpoint;

/// Distance over which the course leads back to the line \[m\].
const BACK: f64 = 60.0;
/// The share of the cruise speed below which an aircraft is not flying: on the ground the motor must not run.
const FLIES: f64 = 0.7;

impl Companion {
    /// Height and line to hold from here on, for an autopilot that holds nothing by itself.
    pub(super) fn line(&self) -> Option<(f64, CourseFrame)> {
        let position = self.heard.position.as_ref();
        let position = position.filter(|_| self.asked_kind().manners().flows)?;
        Some((-f64::from(position.z), CourseFrame::at(position)?))
    }

    /// The course that leads back to the line of hand-over \[rad\].
    pub(super) fn course(&self) -> Option<f64> {
        let flown = self.flown.as_ref()?;
        Some(flown.frame.course - libm::atan(flown.placed?.cross / BACK))
    }

    /// The bank that holds this course, for an autopilot that does not hold it by itself \[rad\].
    pub(super) fn roll(&self, kind: Kind) -> f64 {
        let here = self.heard.position.as_ref().map(over_ground);
        match (kind, self.course(), here) {
            (Kind::Px4, Some(wanted), Some((course, speed))) => px4::bank(wanted, course, speed),
            _ => 0.0,
        }
    }

    /// Level flight, at the height of hand-over once the pilot gave the aircraft; `None` unless it flies.
    pub(super) fn level(&self) -> Option<Setpoint> {
        let (model, thrust_max) = (&self.config.model, self.thrust_max);
        let level = Level {
            pitch: model.trim.state.pitch,
            thrust: model.trim.control.thrust,
            mass: model.known.airframe.mass,
            cruise: model.file.cruise,
        };
        let airspeed = self.airspeed();
        let airspeed = airspeed.filter(|speed| *speed >= FLIES * level.cruise)?;
        let held = self.held.as_ref().zip(self.heard.position.as_ref());
        let below = held.map_or(0.0, |((height, _), here)| height + f64::from(here.z));
        let climb = self.heard.position.as_ref().map_or(0.0, |it| -it.vz);
        let path = libm::asin((f64::from(climb) / airspeed).clamp(-1.0, 1.0));
        let (pitch, thrust) = level.hold(below, airspeed, path);
        Some(Setpoint {
            pitch,
            roll: 0.0,
            throttle: thrust / thrust_max,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::companion::Config;
    use mavlink::dialects::common::LOCAL_POSITION_NED_DATA;
    use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};

    #[test]
    fn level_setpoints_hold_the_height_of_hand_over_and_there_are_none_on_the_ground() {
        let file = AircraftFile::parse("it", crate::stand_in::AIRCRAFT).unwrap();
        let model = AircraftModel::new(file).unwrap().plane();
        let config = Config {
            kind: Some(Kind::Px4),
            ..Config::new(model, 70.0)
        };
        let mut companion = Companion::new(config).unwrap();
        for stands in [None, Some(0.0), Some(9.0), Some(f64::NAN)] {
            companion.heard.airspeed = stands;
            assert_eq!(companion.level(), None);
        }
        companion.heard.airspeed = Some(14.5);
        let trim = companion.level().unwrap().pitch;
        let at = |z| LOCAL_POSITION_NED_DATA {
            z,
            vx: 15.0,
            ..LOCAL_POSITION_NED_DATA::DEFAULT
        };
        companion.heard.position = Some(at(-50.0));
        companion.held = companion.line();
        for (z, sign) in [(-48.0, 1.0), (-52.0, -1.0)] {
            companion.heard.position = Some(at(z));
            assert!((companion.level().unwrap().pitch - trim) * sign > 0.01);
        }
    }
}
