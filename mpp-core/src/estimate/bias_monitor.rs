//! The watches for slow errors of airspeed and pitch, which look alike.
//!
//! A wrong airspeed also tilts the estimated motion, because the known airframe needs another angle of attack at this
//! airspeed. So the watch of the pitch pauses while the airspeed may be wrong. Once the airspeed is found wrong, this watch
//! drops what it has collected.

use super::{AirspeedBias, Before, CalmFlight, PitchBias, Seen};
use crate::vehicle::Airframe;

/// The watches of both sensors.
#[derive(Clone, Copy, Debug)]
pub struct BiasMonitor {
    airspeed: AirspeedBias,
    pitch: PitchBias,
    calm: CalmFlight,
}

impl BiasMonitor {
    /// Watches without observations, for an aircraft with this known airframe and cruising airspeed [m/s].
    #[must_use]
    pub fn new(known: &Airframe, cruise: f64) -> Self {
        Self {
            airspeed: AirspeedBias::new(known.level_lift(cruise)),
            pitch: PitchBias::new(),
            calm: CalmFlight::new(known),
        }
    }

    /// Takes in the tilts by wind and by airspeed \[rad\] if they are known; see [`PitchBias::update`].
    pub fn see_tilt(&mut self, by_wind: f64, by_airspeed: f64, period: f64) {
        if !self.airspeed.suspected() {
            self.pitch.update(by_wind, by_airspeed, period);
        }
    }

    /// Takes in the estimated wind along the way and lift; see [`AirspeedBias::update`].
    pub fn see_wind(&mut self, wind: f64, lift: f64, airspeed: f64, period: f64) -> Option<Before> {
        let found = self.airspeed.update(wind, lift, airspeed, period);
        if found.is_some() {
            self.pitch = PitchBias::new();
        }
        found
    }

    /// Takes in the motion over ground; see [`CalmFlight::update`]. Tells whether both sensors have just been found wrong.
    pub fn see_ground(&mut self, seen: &Seen, period: f64) -> bool {
        if self.airspeed.found() && self.pitch.found() {
            return false;
        }
        let Some(angle) = self.calm.update(seen, period) else {
            return false;
        };
        self.airspeed.set_found();
        self.pitch.set_found(angle);
        true
    }

    /// Compares the airspeed sensor with the estimate; see [`AirspeedBias::compare`].
    pub fn compare_airspeed(&mut self, measured: f64, airspeed: f64, period: f64) {
        self.airspeed.compare(measured, airspeed, period);
    }

    /// The watch of the airspeed.
    #[must_use]
    pub fn airspeed(&self) -> &AirspeedBias {
        &self.airspeed
    }

    /// The watch of the pitch.
    #[must_use]
    pub fn pitch(&self) -> &PitchBias {
        &self.pitch
    }
}
