//! The watches for slow errors of airspeed and pitch, which look alike.
//!
//! A wrong airspeed also tilts the estimated motion, because the known airframe needs another angle of attack at this
//! airspeed. So the watch of the pitch pauses while the airspeed may be wrong. Once the airspeed is found wrong, this watch
//! drops what it has collected.

use super::{AirspeedBias, Before, PitchBias};

/// The watches of both sensors.
#[derive(Clone, Copy, Debug)]
pub struct BiasMonitor {
    airspeed: AirspeedBias,
    pitch: PitchBias,
}

impl BiasMonitor {
    /// Watches without observations, for an aircraft with this lift coefficient in level flight [-].
    #[must_use]
    pub const fn new(level_lift: f64) -> Self {
        Self {
            airspeed: AirspeedBias::new(level_lift),
            pitch: PitchBias::new(),
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
