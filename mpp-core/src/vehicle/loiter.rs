//! The circle on which an aircraft waits: it stays over one place in any steady wind weaker than its airspeed.

use super::{GRAVITY, SpaceControl, SpaceModel, SpacePath};
use core::f64::consts::{FRAC_PI_2, PI, TAU};

/// Share of the curvature of the tightest level turn that a circle has in still air [-]. The rest brings a deviation back. More
/// fits between more trees and follows worse. Source: decision 76.
const SHARE: f64 = 0.8;
/// Greatest wind on a circle, in airspeeds [-]: in more the aircraft hardly comes forward against it.
const MOST_WIND: f64 = 0.6;

/// A level circle over ground, flown at the airspeed of level flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loiter {
    /// Centre `(x, y)` and height \[m\].
    pub centre: [f64; 3],
    /// Radius \[m\].
    pub radius: f64,
    /// 1 if it turns to the right, -1 to the left.
    pub side: f64,
}

/// An angle less whole turns \[rad\], from half a turn to the left to half a turn to the right. Angles within have no other bits.
#[must_use]
pub fn within_half_turn(angle: f64) -> f64 {
    if libm::fabs(angle) <= PI {
        angle
    } else {
        angle - TAU * libm::round(angle / TAU)
    }
}

impl Loiter {
    /// The circle that an aircraft joins from a state as it rolls to a side, at a height \[m\]; `None` in a strong wind.
    #[must_use]
    pub fn joined(model: &SpaceModel, from: &SpacePath, side: f64, height: f64) -> Option<Self> {
        let airspeed = model.trim.state.airspeed;
        let [ahead, right, _] = model.wind;
        let wind = libm::hypot(ahead, right) / airspeed;
        if wind > MOST_WIND {
            return None;
        }
        let radius = (1.0 + wind) * (1.0 + wind) / (SHARE * model.curvature());
        let [vx, vy, _] = from.ground_velocity(&model.wind);
        let speed = libm::hypot(vx, vy).max(1.0);
        let (along, across) = ([vx / speed, vy / speed], [-vy / speed, vx / speed]);
        // A ramp of the bank turns as a step in its middle does.
        let bank = libm::atan(speed * speed / (radius * GRAVITY));
        let half = 0.5 * (bank - side * from.bank).max(0.0) / model.bank_rate;
        let [x, y, _] = from.position;
        let at = |from: f64, axis: usize| {
            from + half * speed * along[axis] + side * radius * across[axis]
        };
        Some(Self {
            centre: [at(x, 0), at(y, 1), height],
            radius,
            side,
        })
    }

    /// Direction of a place from the centre \[rad\].
    #[must_use]
    pub fn angle(&self, [x, y, _]: &[f64; 3]) -> f64 {
        libm::atan2(y - self.centre[1], x - self.centre[0])
    }

    /// The place at an angle \[rad\] on the circle \[m\].
    #[must_use]
    pub fn place(&self, angle: f64) -> [f64; 3] {
        let (sin, cos) = libm::sincos(angle);
        let [x, y, z] = self.centre;
        [x + self.radius * cos, y + self.radius * sin, z]
    }

    /// A state near the circle, moved around the centre as far as a displacement `(x, y)` \[m\] is along the circle.
    #[must_use]
    pub fn moved(&self, state: &SpacePath, [by_x, by_y]: [f64; 2]) -> SpacePath {
        let ([centre_x, centre_y, _], [x, y, z]) = (self.centre, state.position);
        let (out_x, out_y) = (x - centre_x, y - centre_y);
        let square = (out_x * out_x + out_y * out_y).max(1.0);
        let turn = (out_x * by_y - out_y * by_x) / square;
        let (sin, cos) = libm::sincos(turn);
        let (x, y) = (out_x * cos - out_y * sin, out_x * sin + out_y * cos);
        SpacePath {
            position: [centre_x + x, centre_y + y, z],
            course: state.course + turn,
            ..*state
        }
    }

    /// Unit vector of the ground velocity at an angle \[rad\], and its length [m/s].
    fn ground(&self, model: &SpaceModel, angle: f64) -> ([f64; 2], f64) {
        let (sin, cos) = libm::sincos(angle + self.side * FRAC_PI_2);
        let [ahead, right, _] = model.wind;
        let (with, across) = (ahead * cos + right * sin, right * cos - ahead * sin);
        let airspeed = model.trim.state.airspeed;
        let left = airspeed * airspeed - across * across;
        ([cos, sin], with + libm::sqrt(left.max(0.0)))
    }

    /// The angle \[rad\] a time \[s\] later.
    #[must_use]
    pub fn later(&self, model: &SpaceModel, angle: f64, time: f64) -> f64 {
        let rate = |angle: f64| self.side * self.ground(model, angle).1 / self.radius;
        angle + time * rate(angle + 0.5 * time * rate(angle))
    }

    /// States on the circle abeam of a position \[m\], and a time \[s\] later.
    #[must_use]
    pub fn ahead(&self, model: &SpaceModel, position: &[f64; 3], time: f64) -> [SpacePath; 2] {
        let angle = self.angle(position);
        [angle, self.later(model, angle, time)].map(|angle| self.at(model, angle))
    }

    /// The thrust that holds the airspeed on the circle \[N\].
    #[must_use]
    pub fn control(&self, model: &SpaceModel, at: &SpacePath) -> SpaceControl {
        SpaceControl {
            thrust: model.thrust_for(at.airspeed, at.angle_of_attack, 0.0),
            ..SpaceControl::default()
        }
    }

    /// The state on the circle at an angle \[rad\].
    #[must_use]
    pub fn at(&self, model: &SpaceModel, angle: f64) -> SpacePath {
        let ([along_x, along_y], speed) = self.ground(model, angle);
        let airspeed = model.trim.state.airspeed;
        let [wind_x, wind_y, _] = model.wind;
        let (air_x, air_y) = (speed * along_x - wind_x, speed * along_y - wind_y);
        // The lift is across the flight path through the air, what bends the track is across the track.
        let straight = (air_x * along_x + air_y * along_y) / airspeed;
        let pull = speed * speed / (self.radius * straight.max(0.5));
        SpacePath {
            position: self.place(angle),
            airspeed,
            angle_of_attack: model.angle_for(airspeed, libm::hypot(GRAVITY, pull)),
            bank: self.side * libm::atan(pull / GRAVITY),
            flight_path: 0.0,
            course: libm::atan2(air_y, air_x),
        }
    }
}
